// SPDX-License-Identifier: MIT
// Waves that several threads take in: each result is that of one thread, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <thread>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"
#include "support/random_synthesis.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::RandomSynthesis;
using helpers::settings_of;

/// Waves of 6 x 6 times as many blocks as usual: most are large enough to be shared.
constexpr std::size_t larger = 6;

/// Counts what it hands on to another executor.
template <class E>
struct Counting {
  E& inner;
  std::size_t calls = 0;
  void execute(std::size_t count, TaskRef task) {
    ++calls;
    inner.execute(count, task);
  }
  [[nodiscard]] std::size_t concurrency() const { return inner.concurrency(); }
};

struct Outcome {
  std::size_t batches = 0, calls = 0;  // of the executor
  std::vector<std::byte> saved;
  std::vector<BadSample> bad;
};

template <class E>
Outcome run_on(const RandomSynthesis& synthesis, E& executor) {
  Synthesizer engine(synthesis.settings);
  const std::size_t channels = engine.channels();
  Counting<E> counting{executor};
  Outcome outcome;
  engine.run(
      [&](std::span<const Request> requests, std::span<float> out) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          synthesis.sample(requests[i], out.subspan(i * channels, channels));
        }
      },
      synthesis.stop, counting,
      [&](double) {
        ++outcome.batches;
        return true;
      });
  outcome.calls = counting.calls;
  outcome.saved = engine.save();
  outcome.bad = engine.bad_samples();
  return outcome;
}

TEST(SharedWavesOfThreads, AreThoseOfOneThread) {
  std::size_t shared = 0;
  for (unsigned number = 0; number < 60; ++number) {
    RandomSynthesis synthesis(number, larger);
    synthesis.stop.samples = std::min<std::uint64_t>(synthesis.stop.samples, 15000);
    SerialExecutor serial;
    const Outcome expected = run_on(synthesis, serial);
    for (const std::size_t threads : {2u, 3u, 7u}) {
      ThreadPool pool(threads);
      const Outcome outcome = run_on(synthesis, pool);
      ASSERT_EQ(outcome.saved, expected.saved) << number << ", " << threads << " threads";
      ASSERT_EQ(outcome.bad.size(), expected.bad.size());
      for (std::size_t i = 0; i < expected.bad.size(); ++i) {
        ASSERT_EQ(outcome.bad[i].id, expected.bad[i].id);
      }
      shared += outcome.calls > outcome.batches + 2 ? 1 : 0;
    }
  }
  EXPECT_GT(shared, 30u) << "of 180 syntheses; 45 were measured";
}

SynthesisSettings usual(Steer steer = Steer::linear) {
  SynthesisSettings settings = settings_of(200, 152, 2, 300);
  settings.priority.steer = steer;
  return settings;
}

constexpr std::uint64_t samples = 20000;

/// Some have no usable value.
void sample(const Request& request, std::span<float> out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = helpers::picture(request.x + static_cast<double>(c), request.y) - 0.3f;
  }
  if (request.id % 50 == 7) out[request.id % out.size()] = 2e36f;
}

void sample_all(std::span<const Request> requests, std::span<float> out) {
  for (std::size_t i = 0; i < requests.size(); ++i) sample(requests[i], out.subspan(2 * i, 2));
}

void deliver(Synthesizer& engine, std::span<const Request> requests) {
  std::vector<float> values(2 * requests.size());
  sample_all(requests, values);
  engine.deliver(requests, values);
}

/// What an image and an engine are after each wave, by one thread.
class Course {
 public:
  explicit Course(const SynthesisSettings& settings) : engine_(settings) {
    engine_.set_stop(at_samples(samples));
    note();
    std::vector<Request> wave(engine_.wave_size());
    while (const std::size_t count = engine_.request(wave)) {
      deliver(engine_, std::span<const Request>(wave).first(count));
      note();
    }
  }
  [[nodiscard]] bool has(const FrequencyImage& image) const {
    const std::vector<std::byte> bytes = image.save();
    return std::find(images_.begin(), images_.end(), bytes) != images_.end();
  }
  /// Whether an engine has come to the same end.
  [[nodiscard]] bool ends_like(const Synthesizer& other) const {
    const SynthesisStats stats = engine_.stats(), others = other.stats();
    return other.image().save() == images_.back() &&
           other.finished_image().save() == engine_.finished_image().save() &&
           stats.samples == others.samples && stats.waves == others.waves &&
           stats.absorbed == others.absorbed && stats.bad_samples == others.bad_samples;
  }
  [[nodiscard]] std::size_t size() const { return images_.size(); }

 private:
  void note() { images_.push_back(engine_.image().save()); }

  Synthesizer engine_;
  std::vector<std::vector<std::byte>> images_;
};

class SharedWavesOfHostThreads : public testing::TestWithParam<Steer> {};
INSTANTIATE_TEST_SUITE_P(Steers, SharedWavesOfHostThreads,
                         testing::Values(Steer::linear, Steer::relative, Steer::display));

TEST_P(SharedWavesOfHostThreads, MayBeLookedAtSavedAndCancelled) {
  const Course course(usual(GetParam()));
  Synthesizer engine(usual(GetParam()));
  engine.set_stop(at_samples(samples));
  std::atomic<bool> over = false;
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 3; ++seed) {
    threads.emplace_back([&, seed] {
      oracle::Random random(seed);
      std::vector<Request> requests(90);
      while (true) {
        const std::size_t count = engine.request(requests, Wait::until_available);
        if (count == 0) {
          // Somebody has cancelled it: it goes on.
          if (engine.stopped() == StopReason::samples) return;
          engine.set_stop(at_samples(samples));
          continue;
        }
        const auto mine = std::span<const Request>(requests).first(count);
        const std::size_t back = random.below(20) == 0 ? count / 2 : 0;
        engine.give_back(mine.first(back));
        deliver(engine, mine.subspan(back));
        if (random.below(60) == 0) engine.cancel();
      }
    });
  }
  std::size_t looks = 0;
  std::vector<std::byte> saved;
  std::thread onlooker([&] {
    while (!over) {
      EXPECT_TRUE(course.has(engine.image())) << "the image after a complete wave";
      saved = engine.save();
      EXPECT_LE(engine.progress().samples, samples);
      const SynthesisStats stats = engine.stats();
      EXPECT_LE(stats.waves + 1, course.size());
      ++looks;
    }
  });
  for (std::thread& thread : threads) thread.join();
  over = true;
  onlooker.join();
  EXPECT_TRUE(course.ends_like(engine));
  EXPECT_GT(looks, 0u);
  // What was saved on the way goes on alone.
  Synthesizer loaded(usual(GetParam()), saved);
  loaded.run(sample_all, at_samples(samples));
  EXPECT_TRUE(course.ends_like(loaded));
}

/// Executors that do what the concept allows, or what it does not.
struct Backwards {
  static void execute(std::size_t count, TaskRef task) {
    while (count > 0) task(--count);
  }
  static std::size_t concurrency() { return 1000; }
};

/// Leaves out half of the tasks where they are more than those that sampling needs.
struct Lazy {
  static void execute(std::size_t count, TaskRef task) {
    const std::size_t done = count > 4 * concurrency() ? count / 2 : count;
    for (std::size_t i = 0; i < done; ++i) task(i);
  }
  static std::size_t concurrency() { return 2; }
};

TEST(SharedWavesOfExecutors, MayBeInAnyOrderAndLeftToTheCaller) {
  const Course course(usual());
  Synthesizer backwards(usual()), lazy(usual());
  backwards.run(sample_all, at_samples(samples), Backwards{});
  EXPECT_TRUE(course.ends_like(backwards));
  lazy.run(sample_all, at_samples(samples), Lazy{});
  EXPECT_TRUE(course.ends_like(lazy));
}

/// Fails at some calls, after some of the tasks.
struct Failing {
  ThreadPool& pool;
  std::size_t calls = 0;
  void execute(std::size_t count, TaskRef task) {
    if (++calls % 5 != 0) return pool.execute(count, task);
    pool.execute(count / 3, task);
    throw std::runtime_error("no more threads");
  }
  [[nodiscard]] std::size_t concurrency() const { return pool.concurrency(); }
};

TEST(SharedWavesOfExecutors, GoOnAfterOneThatFailed) {
  const Course course(usual());
  ThreadPool pool(3);
  Failing failing{pool};
  Synthesizer engine(usual());
  std::size_t failures = 0;
  RunReport report;
  for (bool over = false; !over;) {
    try {
      report = engine.run(sample_all, at_samples(samples), failing);
      over = true;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "no more threads");
      EXPECT_TRUE(course.has(engine.image()));
      ++failures;
    }
  }
  EXPECT_EQ(report.reason, StopReason::samples);
  EXPECT_GT(failures, 10u);
  EXPECT_TRUE(course.ends_like(engine));
}

TEST(SharedWavesOfExecutors, AreThoseOfASamplerThatThrows) {
  const Course course(usual());
  ThreadPool pool(3);
  Synthesizer engine(usual());
  std::atomic<unsigned> calls = 0;
  const auto throwing = [&](const Request& request) {
    if (++calls % 3001 == 0) throw std::runtime_error("a bad ray");
    std::array<float, 2> values;
    sample(request, values);
    return values;
  };
  std::size_t failures = 0;
  for (bool over = false; !over;) {
    try {
      engine.run(throwing, at_samples(samples), pool);
      over = true;
    } catch (const std::runtime_error&) {
      ++failures;
    }
  }
  EXPECT_GT(failures, 3u);
  EXPECT_TRUE(course.ends_like(engine));
}

}  // namespace
}  // namespace freqsynth
