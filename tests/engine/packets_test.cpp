// SPDX-License-Identifier: MIT
// Requests in multiples of a packet.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;

constexpr std::uint64_t samples = 6000;

SynthesisSettings in_packets(std::size_t packet, std::size_t wave = 70) {
  SynthesisSettings settings = helpers::settings_of(100, 84, 1, wave);
  settings.packet = packet;
  return settings;
}

/// A batch sampler that notes how many requests it got each time.
struct Noting {
  std::mutex mutex;
  std::vector<std::size_t> sizes;

  void operator()(std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      values[i] = helpers::picture(requests[i].x, requests[i].y);
    }
    const std::lock_guard lock(mutex);
    sizes.push_back(requests.size());
  }
};

TEST(PacketsOfThreads, AreHandedToBatchSamplersWhole) {
  Synthesizer expected(in_packets(1));
  expected.run(Noting{}, at_samples(samples));
  for (const std::size_t threads : {1u, 3u}) {
    for (const std::size_t batch : {16u, 100u, 1024u}) {
      ThreadPool pool(threads);
      Noting sampler;
      Synthesizer engine(in_packets(16));
      engine.run(sampler, at_samples(samples), pool, KeepGoing{}, batch);
      std::size_t broken = 0, whole = 0;
      for (const std::size_t size : sampler.sizes) ++(size % 16 == 0 ? whole : broken);
      // The rest of each wave.
      EXPECT_LE(broken, engine.stats().waves) << threads << ", " << batch;
      EXPECT_GE(whole, broken);
      EXPECT_TRUE(helpers::same_image(engine.image(), expected.image()));
    }
  }
}

TEST(Packets, LargerThanABatchAreNoReasonToWait) {
  Noting sampler;
  Synthesizer engine(in_packets(64));
  const RunReport report =
      engine.run(sampler, at_samples(samples), SerialExecutor{}, KeepGoing{}, 10);
  EXPECT_EQ(report.reason, StopReason::samples);
  EXPECT_EQ(engine.stats().samples, samples);
  for (const std::size_t size : sampler.sizes) EXPECT_LE(size, 10u);
}

TEST(Packets, AreHandedOutByRequestWhileTheWaveHasSoMany) {
  Synthesizer engine(in_packets(16, 100));
  engine.set_stop(at_samples(samples));
  std::vector<Request> out(50);
  std::vector<std::size_t> counts;
  std::vector<Request> owed;
  while (const std::size_t count = engine.request(out)) {
    counts.push_back(count);
    owed.insert(owed.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count));
  }
  ASSERT_EQ(owed.size(), 109u) << "100 and 9 of them once more";
  EXPECT_EQ(counts, (std::vector<std::size_t>{48, 48, 13}));
  // What came back is handed out with the rest, and counts.
  engine.give_back(std::span<const Request>(owed).first(40));
  EXPECT_EQ(engine.request(std::span(out).first(35)), 32u);
  EXPECT_EQ(engine.request(std::span(out).first(5)), 5u) << "smaller than a packet";
  EXPECT_EQ(engine.request(out), 3u);
}

}  // namespace
}  // namespace freqsynth
