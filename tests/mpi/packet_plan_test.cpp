// SPDX-License-Identifier: MIT
#include "mpi/packet_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace farm {
namespace {

TEST(PacketPlan, IsHalfOfWhatFallsToARankByItsSpeed) {
  // 10,000 samples among ranks of 1,000, 3,000 and 6,000 samples in a second; packets of any time.
  const PacketSettings settings{.least_seconds = 0, .most_seconds = 1e9};
  EXPECT_EQ(packet_size(settings, 10000, 1000, 10000), 500u);
  EXPECT_EQ(packet_size(settings, 10000, 3000, 10000), 1500u);
  EXPECT_EQ(packet_size(settings, 10000, 6000, 10000), 3000u);
}

TEST(PacketPlan, KeepsToTheTimesAndSizesOfItsSettings) {
  std::mt19937 random(3);
  for (int round = 0; round < 1000; ++round) {
    const PacketSettings settings{
        .least_seconds = 1e-4, .most_seconds = 1e-2, .most_samples = 1 + random() % 5000};
    const auto speed = static_cast<double>(1 + random() % 10000000);
    const double all = speed * static_cast<double>(1 + random() % 100);
    const std::size_t left = 1 + random() % 100000;
    const std::size_t size = packet_size(settings, left, speed, all);
    ASSERT_GE(size, 1u);
    ASSERT_LE(size, std::min(left, settings.most_samples));
    // A sample more or less is for whole numbers' sake.
    EXPECT_LE(static_cast<double>(size), settings.most_seconds * speed + 1);
    if (size < left && size < settings.most_samples) {
      EXPECT_GE(static_cast<double>(size), settings.least_seconds * speed - 1);
    }
  }
}

/// Traces a wave by what is told of ranks' speeds: who is idle first gets the next packet.
/// \return when each rank is done
std::vector<double> trace(const PacketSettings& settings, std::size_t wave,
                          const std::vector<double>& speeds) {
  const double all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  std::vector<double> done(speeds.size());
  for (std::size_t left = wave; left > 0;) {
    const auto rank =
        static_cast<std::size_t>(std::min_element(done.begin(), done.end()) - done.begin());
    const std::size_t size = packet_size(settings, left, speeds[rank], all);
    left -= size;
    done[rank] += static_cast<double>(size) / speeds[rank];
  }
  return done;
}

TEST(PacketPlan, BringsRanksOfAllSpeedsToTheEndOfAWaveTogether) {
  const PacketSettings settings;
  const std::vector<double> speeds{1e4, 2e4, 5e4, 3e5};
  const double best = 20000 / std::accumulate(speeds.begin(), speeds.end(), 0.0);
  const std::vector<double> done = trace(settings, 20000, speeds);
  const auto [first, last] = std::minmax_element(done.begin(), done.end());
  // What the last packets take, which are the smallest: two of the slowest rank.
  EXPECT_LE(*last, best + 2 * settings.least_seconds);
  EXPECT_GE(*first, best - 2 * settings.least_seconds);

  // With packets of one size instead the slowest rank would be late.
  const PacketSettings equal{.least_seconds = 1, .most_samples = 500};
  const std::vector<double> late = trace(equal, 20000, speeds);
  EXPECT_GT(*std::max_element(late.begin(), late.end()), best + 10 * settings.least_seconds);
}

}  // namespace
}  // namespace farm
