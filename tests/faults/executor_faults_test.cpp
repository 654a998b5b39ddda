// SPDX-License-Identifier: MIT
// Executors that do not keep their promise: the engine goes on or says why not, and nothing that
// was sampled is lost.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint64_t budget = 900;

struct PoolError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An executor of four tasks or more whose `call`-th execution goes wrong in one of many ways.
class Faulty {
 public:
  enum class Fault {
    throws_before,
    throws_within,
    throws_after,
    leaves_out_all,
    leaves_out_first,
    leaves_out_every_other,
    repeats,
    goes_beyond,
    concurrency_throws
  };
  Faulty(Fault fault, int call) : fault_(fault), call_(call) {}

  void execute(std::size_t count, TaskRef task) {
    const bool now = --call_ == 0;
    if (now && fault_ == Fault::throws_before) throw PoolError("the pool is shut");
    for (std::size_t i = 0; i < count; ++i) {
      if (now && fault_ == Fault::throws_within && i == count / 2) throw PoolError("shut");
      if (now && fault_ == Fault::leaves_out_all) continue;
      if (now && fault_ == Fault::leaves_out_first && i == 0) continue;
      if (now && fault_ == Fault::leaves_out_every_other && i % 2 == 1) continue;
      task(i);
      if (fault_ == Fault::repeats) task(i);
    }
    if (fault_ == Fault::goes_beyond) {
      task(count);
      task(std::numeric_limits<std::size_t>::max());
    }
    if (now && fault_ == Fault::throws_after) throw PoolError("shut");
  }
  std::size_t concurrency() {
    if (fault_ == Fault::concurrency_throws && --call_ == 0) throw PoolError("shut");
    return 2;
  }

 private:
  Fault fault_;
  int call_;
};

class ExecutorFault : public testing::TestWithParam<std::tuple<Faulty::Fault, int>> {};
INSTANTIATE_TEST_SUITE_P(
    AllAndWhen, ExecutorFault,
    testing::Combine(testing::Values(Faulty::Fault::throws_before, Faulty::Fault::throws_within,
                                     Faulty::Fault::throws_after, Faulty::Fault::leaves_out_all,
                                     Faulty::Fault::leaves_out_first,
                                     Faulty::Fault::leaves_out_every_other, Faulty::Fault::repeats,
                                     Faulty::Fault::goes_beyond, Faulty::Fault::concurrency_throws),
                     testing::Values(1, 2, 7)));

TEST_P(ExecutorFault, LosesNothingAndTheEngineGoesOn) {
  const auto [fault, call] = GetParam();
  const SynthesisSettings settings = settings_of(44, 40, 1, 20);  // several parts in each wave
  Synthesizer straight(settings), engine(settings);
  straight.run(picture, at_samples(budget));
  std::size_t calls = 0;
  const auto sampler = [&](double x, double y) {
    ++calls;
    return picture(x, y);
  };
  Faulty executor(fault, call);
  std::string message;
  for (int run = 0; run < 2 && engine.stopped() != StopReason::samples; ++run) {
    try {
      const RunReport report = engine.run(sampler, at_samples(budget), executor, KeepGoing{}, 40);
      EXPECT_EQ(report.reason, StopReason::samples);
    } catch (const std::runtime_error& error) {
      message = error.what();
      EXPECT_EQ(helpers::calls_of(engine), calls) << "what the sampler returned is delivered";
      EXPECT_NE(engine.stopped(), StopReason::waiting) << "no request is lost";
    }
  }
  EXPECT_EQ(calls, helpers::calls_of(straight)) << "no request is answered twice";
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
  switch (fault) {
    case Faulty::Fault::repeats:
    case Faulty::Fault::goes_beyond:
      EXPECT_EQ(message, "") << "does no harm";
      break;
    case Faulty::Fault::concurrency_throws:
      // It is asked once a run.
      EXPECT_EQ(message, call == 1 ? "shut" : "");
      break;
    case Faulty::Fault::leaves_out_all:
    case Faulty::Fault::leaves_out_first:
    case Faulty::Fault::leaves_out_every_other:
      EXPECT_THAT(message, HasSubstr("the executor left out"));
      EXPECT_THAT(message, HasSubstr("tasks"));
      break;
    default:
      EXPECT_THAT(message, HasSubstr("shut"));
  }
}

TEST(ExecutorFaults, AnExecutorThatNeverDoesAnythingIsNoEndlessLoop) {
  struct Idle {
    static void execute(std::size_t, TaskRef) {}
    static std::size_t concurrency() { return 4; }
  };
  Synthesizer engine(settings_of(24, 24));
  EXPECT_THAT([&] { engine.run(picture, at_samples(100), Idle{}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("left out 1 of 1 tasks")));
  EXPECT_EQ(engine.stats().samples, 0u);
}

TEST(ExecutorFaults, AThreadThatIsCancelledInTheSamplerLosesOneCallOnly) {
#if !defined(__GLIBCXX__)
  GTEST_SKIP() << "only libstdc++ tells a cancelled thread from an exception";
#endif
  Synthesizer straight(settings_of(32, 32)), engine(settings_of(32, 32));
  straight.run(picture, at_samples(300));
  std::size_t calls = 0;
  std::thread worker([&] {
    const auto sampler = [&](double x, double y) {
      if (++calls == 100) {
        pthread_cancel(pthread_self());
        pthread_testcancel();
      }
      return picture(x, y);
    };
    engine.run(sampler, at_samples(300));
    ADD_FAILURE() << "the thread was cancelled";
  });
  worker.join();
  EXPECT_EQ(helpers::calls_of(engine), 99u);
  EXPECT_EQ(engine.run(picture, at_samples(300)).reason, StopReason::samples);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(ExecutorFaults, AThreadThatIsCancelledWhileItWaitsLeavesAnEngineThatGoesOn) {
  Synthesizer straight(settings_of(32, 32)), engine(settings_of(32, 32));
  straight.run(picture, at_samples(300));
  for (const double seconds : {1e300, 1e5}) {
    engine.set_stop({.seconds = seconds});
    std::vector<Request> owed(engine.wave_size());
    owed.resize(engine.request(owed));
    std::thread worker([&] {
      std::vector<Request> more(1);
      static_cast<void>(engine.request(more, Wait::until_available));
      ADD_FAILURE() << "the thread was cancelled";
    });
    pthread_cancel(worker.native_handle());
    worker.join();
    engine.give_back(owed);
  }
  EXPECT_EQ(engine.run(picture, at_samples(300)).reason, StopReason::samples);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(ExecutorFaults, ABatchIsNeverLargerThanAWave) {
  Synthesizer engine(settings_of(32, 32)), straight(settings_of(32, 32));
  const auto run = [](Synthesizer& one, std::size_t batch) {
    return one.run(picture, at_samples(300), SerialExecutor{}, KeepGoing{}, batch).reason;
  };
  EXPECT_EQ(run(engine, std::numeric_limits<std::size_t>::max()), StopReason::samples);
  run(straight, 1);
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

}  // namespace
}  // namespace freqsynth
