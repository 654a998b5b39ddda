// SPDX-License-Identifier: MIT
// Loops of the host's own on many threads, which wait for positions, cancel, die and leave things
// undone: each picture is that of one thread that did it all in order.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <set>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

void deliver_values(Synthesizer& engine, std::span<const Request> requests) {
  std::vector<float> values;
  for (const Request& request : requests) {
    for (std::size_t c = 0; c < engine.channels(); ++c) {
      values.push_back(picture(request.x + static_cast<double>(c), request.y));
    }
  }
  engine.deliver(requests, values);
}

/// What a host does to one of many requests, told by its name so that it is the same in every run.
enum class Fate { answered, bad, abandoned };
Fate fate_of(const Request& request, std::uint64_t faults) {
  if (faults == 0) return Fate::answered;
  const std::uint64_t dice = detail::mix_bits(request.id + faults) % 100;
  return dice < 80 ? Fate::answered : dice < 85 ? Fate::bad : Fate::abandoned;
}

struct Host {
  SynthesisSettings settings;
  StopRule stop;
  std::uint64_t faults = 0;

  [[nodiscard]] std::vector<float> values_of(const Request& request) const {
    std::vector<float> values(settings.channels, nan);
    if (fate_of(request, faults) != Fate::answered) return values;
    for (std::size_t c = 0; c < settings.channels; ++c) {
      values[c] = picture(request.x + static_cast<double>(c), request.y);
    }
    return values;
  }

  void answer(Synthesizer& engine, const Request& request) const {
    const std::span<const Request> one(&request, 1);
    if (fate_of(request, faults) == Fate::abandoned) {
      engine.abandon(one);
    } else {
      engine.deliver(one, values_of(request));
    }
  }

  /// The same by one thread, for which what others abandon has no value.
  void run_alone(Synthesizer& engine) const {
    engine.run(
        [&](std::span<const Request> requests, std::span<float> out) {
          for (std::size_t i = 0; i < requests.size(); ++i) {
            const std::vector<float> values = values_of(requests[i]);
            std::copy(values.begin(), values.end(), out.data() + i * settings.channels);
          }
        },
        stop);
  }
};

/// Requests of threads that are gone.
class Estate {
 public:
  void leave(std::span<const Request> requests) {
    const std::lock_guard lock(mutex_);
    requests_.insert(requests_.end(), requests.begin(), requests.end());
  }
  std::vector<Request> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(requests_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Request> requests_;
};

/// Works until there is no more, or the thread dies and leaves what it holds.
/// \param mortal   whether it may die
/// \param cancels  whether it may end it all
void work(Synthesizer& engine, const Host& host, Estate& estate, unsigned seed, bool mortal,
          bool cancels) {
  oracle::Random random(seed);
  const std::size_t portion = 1 + random.below(12);
  std::vector<Request> requests;
  while (true) {
    requests.resize(portion);
    requests.resize(engine.request(requests, Wait::until_available));
    if (requests.empty()) return;
    std::shuffle(requests.begin(), requests.end(), random.engine());
    if (cancels && random.below(10) == 0) engine.cancel();
    if (mortal && random.below(20) == 0) return estate.leave(requests);
    while (!requests.empty()) {
      if (random.below(30) == 0) {
        engine.give_back(requests);
        break;
      }
      host.answer(engine, requests.back());
      requests.pop_back();
    }
  }
}

/// Threads at work until they come back. The first of them lives.
void work_together(Synthesizer& engine, const Host& host, std::size_t count, oracle::Random& random,
                   bool cancels) {
  Estate estate;
  std::atomic<std::size_t> left = count;
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < count; ++i) {
    const auto seed = static_cast<unsigned>(random.below(1000000));
    threads.emplace_back([&, i, seed] {
      work(engine, host, estate, seed, i > 0, cancels);
      --left;
    });
  }
  while (left > 0) {
    // Somebody notices what the dead have left. Half of it is done by hand.
    const std::vector<Request> found = estate.take();
    const std::span<const Request> all = found;
    for (const Request& request : all.first(found.size() / 2)) host.answer(engine, request);
    engine.give_back(all.subspan(found.size() / 2));
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  engine.give_back(estate.take());
}

TEST(HostThreads, AreEqualToOneThreadWhateverHappens) {
  // With --gtest_shuffle --gtest_repeat=N others each time.
  oracle::Random random(11 +
                        static_cast<unsigned>(testing::UnitTest::GetInstance()->random_seed()));
  std::size_t abandoned = 0, cancelled = 0;
  const SharedInverseList list;
  for (int round = 0; round < 300; ++round) {
    Host host;
    host.settings = settings_of(1 + random.below(40), 1 + random.below(40), 1 + random.below(3),
                                random.below(3) == 0 ? 0 : 1 + random.below(30));
    host.settings.max_samples_per_block = 1 + random.below(60);
    host.settings.shared_list = list;
    host.stop = random.below(3) == 0 ? StopRule{} : at_samples(random.below(400));
    host.faults = random.below(2) == 0 ? 0 : 1 + random.below(1000);
    Synthesizer alone(host.settings), engine(host.settings);
    host.run_alone(alone);

    bool over = false;
    while (!over) {
      engine.set_stop(host.stop);
      work_together(engine, host, 1 + random.below(4), random, random.below(2) == 0);
      const auto why = engine.stopped();
      over = why && why != StopReason::cancelled;
      cancelled += over ? 0 : 1;
      ASSERT_NE(why, StopReason::waiting) << "nothing is owed";
    }
    ASSERT_TRUE(helpers::same_image(engine.image(), alone.image())) << "round " << round;
    ASSERT_EQ(engine.stopped(), alone.stopped());
    const SynthesisStats stats = engine.stats(), expected = alone.stats();
    EXPECT_EQ(stats.samples, expected.samples);
    EXPECT_EQ(stats.probes, expected.probes);
    EXPECT_EQ(stats.waves, expected.waves);
    EXPECT_EQ(expected.abandoned, 0u);
    EXPECT_LE(stats.bad_samples, expected.bad_samples);
    EXPECT_LE(expected.bad_samples, stats.bad_samples + stats.abandoned);
    abandoned += stats.abandoned;
  }
  EXPECT_GT(abandoned, 1000u);
  EXPECT_GT(cancelled, 50u);
}

TEST(HostThreads, AllComeBackAtTheEndAndNoneBefore) {
  for (const std::size_t threads_wanted : {1u, 2u, 7u}) {
    Synthesizer engine(settings_of(48, 40, 1, 10));
    engine.set_stop(at_samples(500));
    std::vector<std::thread> threads;
    std::atomic<std::uint64_t> answered = 0;
    for (std::size_t i = 0; i < threads_wanted; ++i) {
      threads.emplace_back([&] {
        std::vector<Request> requests(3);
        while (const std::size_t count = engine.request(requests, Wait::until_available)) {
          answered += count;
          deliver_values(engine, std::span<const Request>(requests).first(count));
        }
        // 0 is the end and nothing else.
        EXPECT_EQ(engine.stopped(), StopReason::samples);
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(answered, helpers::calls_of(engine));
    EXPECT_EQ(engine.stats().samples, 500u);
  }
}

/// An engine all of whose wave is owed, and a thread that waits for more.
class Waiting : public testing::Test {
 protected:
  Waiting() : engine_(settings_of(40, 32, 1, 20)), owed_(engine_.wave_size()) {
    engine_.set_stop(at_samples(500));
    owed_.resize(engine_.request(owed_));
    waiter_ = std::thread([this] {
      got_.resize(engine_.wave_size());
      got_.resize(engine_.request(got_, Wait::until_available));
    });
  }
  ~Waiting() override {
    if (waiter_.joinable()) waiter_.join();
  }

  Synthesizer engine_;
  std::vector<Request> owed_, got_;
  std::thread waiter_;
};

TEST_F(Waiting, EndsWithADelivery) {
  deliver_values(engine_, owed_);
  waiter_.join();
  EXPECT_GE(got_.size(), 20u);
  EXPECT_EQ(engine_.stopped(), StopReason::waiting) << "all of the next wave is the waiter's";
}

TEST_F(Waiting, EndsWithWhatIsGivenBack) {
  engine_.give_back(std::span<const Request>(owed_).first(3));
  waiter_.join();
  ASSERT_EQ(got_.size(), 3u);
  std::set<std::uint64_t> given, got;
  for (std::size_t i = 0; i < 3; ++i) {
    given.insert(owed_[i].id);
    got.insert(got_[i].id);
  }
  EXPECT_EQ(given, got);
}

TEST_F(Waiting, EndsWithWhatIsAbandoned) {
  engine_.abandon(owed_);
  waiter_.join();
  EXPECT_GE(got_.size(), 20u);
  EXPECT_EQ(engine_.stats().abandoned, owed_.size());
}

TEST_F(Waiting, EndsWithCancelAndGoesOn) {
  engine_.cancel();
  waiter_.join();
  EXPECT_TRUE(got_.empty());
  EXPECT_EQ(engine_.stopped(), StopReason::cancelled);
  deliver_values(engine_, owed_);
  EXPECT_EQ(engine_.stopped(), StopReason::cancelled) << "until rules are set";
  EXPECT_EQ(engine_.run(picture, at_samples(500)).reason, StopReason::samples);
  Synthesizer straight(settings_of(40, 32, 1, 20));
  straight.run(picture, at_samples(500));
  EXPECT_TRUE(helpers::same_image(engine_.image(), straight.image()));
}

TEST_F(Waiting, EndsWhenTheTimeIsTakenAway) {
  engine_.set_stop({.seconds = 0});
  waiter_.join();
  EXPECT_TRUE(got_.empty());
  EXPECT_EQ(engine_.stopped(), StopReason::seconds);
}

TEST(Cancel, EndsARunAfterTheBatch) {
  Synthesizer engine(settings_of(64, 64, 1, 50));
  std::size_t calls = 0;
  const auto sampler = [&](double x, double y) {
    if (++calls == 100) engine.cancel();
    return picture(x, y);
  };
  const RunReport report = engine.run(sampler, at_samples(1000), SerialExecutor{}, KeepGoing{}, 16);
  EXPECT_EQ(report.reason, StopReason::cancelled);
  EXPECT_GE(calls, 100u);
  EXPECT_LT(calls, 116u);
  EXPECT_EQ(helpers::calls_of(engine), calls);
}

TEST(Abandon, LeavesTheOtherRequestsAlone) {
  Synthesizer engine(settings_of(40, 32, 1, 20));
  std::vector<Request> requests(engine.wave_size());
  requests.resize(engine.request(requests));
  const std::span<const Request> all = requests;
  engine.abandon(all.first(2));
  EXPECT_EQ(engine.stats().abandoned, 2u);
  EXPECT_EQ(engine.stats().samples, 2u) << "rules count them";
  EXPECT_EQ(engine.stopped(), StopReason::waiting) << "they are not handed out again";
  // A machine that comes back after all.
  EXPECT_THROW(deliver_values(engine, all.first(1)), std::invalid_argument);
  EXPECT_THROW(engine.give_back(all.first(1)), std::invalid_argument);
  EXPECT_THROW(engine.abandon(all.first(3)), std::invalid_argument);
  deliver_values(engine, all.subspan(2));
  EXPECT_EQ(engine.stats().waves, 1u);
  EXPECT_EQ(engine.stats().bad_samples, 0u);
  EXPECT_TRUE(engine.bad_samples().empty());
}

TEST(Abandon, KeepsOrdinalsOfPixelsInOrder) {
  Synthesizer engine(settings_of(24, 16, 1, 6));
  engine.set_stop({.samples_per_pixel = 6});
  std::vector<Request> requests(4);
  std::vector<std::uint32_t> next(24 * 16, 0);
  std::size_t turn = 0;
  while (const std::size_t count = engine.request(requests)) {
    for (const Request& request : std::span<const Request>(requests).first(count)) {
      EXPECT_EQ(request.ordinal, next[request.pixel]++);
      const std::span<const Request> one(&request, 1);
      if (++turn % 3 == 0) {
        engine.abandon(one);
      } else {
        deliver_values(engine, one);
      }
    }
  }
  EXPECT_EQ(engine.stopped(), StopReason::samples);
  EXPECT_EQ(engine.stats().abandoned, turn / 3);
}

TEST(Abandon, OfEverythingIsNoPicture) {
  Synthesizer engine(settings_of(24, 16));
  std::vector<Request> requests(10);
  while (const std::size_t count = engine.request(requests)) {
    engine.abandon(std::span<const Request>(requests).first(count));
  }
  EXPECT_EQ(engine.stopped(), StopReason::unusable);
  EXPECT_EQ(engine.stats().bad_samples, 0u);
}

TEST(Abandon, OfChannelsOfAllRolesIsNoBadSample) {
  SynthesisSettings settings = settings_of(40, 32, 3, 20);
  settings.channel_settings = {{}, {ChannelRole::passive}, {ChannelRole::nearest}};
  Synthesizer engine(settings);
  engine.set_stop(at_samples(400));
  std::vector<Request> requests(7);
  while (const std::size_t count = engine.request(requests)) {
    const std::span<const Request> some(requests.data(), count);
    engine.abandon(some.first(1));
    deliver_values(engine, some.subspan(1));
  }
  EXPECT_GT(engine.stats().abandoned, 50u);
  EXPECT_EQ(engine.stats().bad_samples, 0u);
  EXPECT_EQ(engine.stats().ignored_bad_samples, 0u);
  for (const float value : engine.channel_pixels(2)) EXPECT_FALSE(value != value);
}

TEST(WaveSize, IsTheMostThatIsHandedOut) {
  for (const std::size_t wave : {0u, 1u, 7u, 100000u}) {
    Synthesizer engine(settings_of(60, 52, 1, wave));
    engine.set_stop(at_samples(10000));
    std::size_t largest = 0;
    std::vector<Request> requests(1000000);
    while (const std::size_t count = engine.request(requests)) {
      EXPECT_LE(count, engine.wave_size());
      largest = std::max(largest, count);
      deliver_values(engine, std::span<const Request>(requests).first(count));
    }
    EXPECT_GE(2 * largest, engine.wave_size());
  }
}

}  // namespace
}  // namespace freqsynth
