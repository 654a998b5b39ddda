// SPDX-License-Identifier: MIT
// The noise of the scenes that are integrals, and its random numbers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scene_helpers.h"
#include "scenes/random.h"
#include "scenes/scene.h"

namespace {

using scene_helpers::make;
using scene_helpers::noisy_names;
using scene_helpers::radiance;
using scene_helpers::Samples;

/// Mean and variance of the mean of a scene's green at one place, over the first samples of as many
/// sequences.
struct Estimate {
  double mean = 0, variance = 0;

  Estimate(const scenes::Scene& scene, double x, double y, std::uint64_t first, std::size_t count) {
    const auto n = static_cast<double>(count);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = radiance(scene, x, y, scenes::sample_id(first + i, 0))[1];
      sum += value;
      squares += value * value;
    }
    mean = sum / n;
    variance = std::max(0.0, squares / n - mean * mean) / n;
  }
};

// Counted sequences must do as well as random ones, as that is how a renderer names its pixels.
TEST(NoisyScenes, ConvergeToOneMeanForAllIdsAndSeeds) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t places = 40;
  const Samples at(places, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    const auto reseeded = make(name, 97, 61, 5);
    std::size_t noisy = 0;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < places; ++i) {
      const double x = at.x[i];
      const double y = at.y[i];
      const Estimate a(*scene, x, y, 0, count);
      const Estimate b(*scene, x, y, count, count);
      const Estimate c(*reseeded, x, y, 0, count);
      EXPECT_LE(std::abs(a.mean - b.mean), 5 * std::sqrt(a.variance + b.variance) + 1e-6) << name;
      EXPECT_LE(std::abs(a.mean - c.mean), 5 * std::sqrt(a.variance + c.variance) + 1e-6) << name;
      if (a.variance > 1e-12) ++noisy;
      if (a.mean != c.mean) ++changed;
    }
    EXPECT_GE(noisy, 22u) << name << ": 28 of 40 were measured where it is the fewest";
    EXPECT_GE(changed, noisy) << name;
  }
}

TEST(NoisyScenes, NeighbouringSequencesAreNotCorrelated) {
  constexpr std::size_t count = 4000;
  const Samples at(20, 97, 61);
  for (const std::string_view name : noisy_names) {
    const auto scene = make(name, 97, 61);
    std::size_t checked = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const Estimate whole(*scene, at.x[i], at.y[i], 0, count);
      const double variance = whole.variance * static_cast<double>(count);
      if (variance < 1e-6) continue;
      double covariance = 0;
      double before =
          radiance(*scene, at.x[i], at.y[i], scenes::sample_id(count, 0))[1] - whole.mean;
      for (std::uint64_t sequence = 0; sequence < count; ++sequence) {
        const std::uint64_t id = scenes::sample_id(sequence, 0);
        const double now = radiance(*scene, at.x[i], at.y[i], id)[1] - whole.mean;
        covariance += before * now / static_cast<double>(count);
        before = now;
      }
      EXPECT_LT(std::abs(covariance / variance), 5 / std::sqrt(count)) << name;
      ++checked;
    }
    EXPECT_GE(checked, 9u) << name << ": 12 of 20 were measured where it is the fewest";
  }
}

TEST(NoisyScenes, SamplesOfASequenceHaveLessNoiseTogether) {
  // By the mean over places of the squared deviation from the mean of many: of 16 samples of the
  // same sequence against 16 of different ones. 0.01 (softshadow), 0.21 (glossy) and 0.59 (dof, at
  // edges in the texture) were measured. Not of the path tracer, where a few values that are very
  // bright decide: its own tests compare medians.
  constexpr std::uint64_t samples = 16;
  constexpr std::uint64_t sequences = 200;
  const Samples at(20, 97, 61);
  for (const std::string_view name : {"softshadow", "dof", "glossy"}) {
    const auto scene = make(name, 97, 61);
    double together = 0, apart = 0;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const Estimate whole(*scene, at.x[i], at.y[i], 0, 20000);
      for (std::uint64_t sequence = 0; sequence < sequences; ++sequence) {
        double mean = 0;
        for (std::uint64_t k = 0; k < samples; ++k) {
          mean += radiance(*scene, at.x[i], at.y[i], scenes::sample_id(sequence, k))[1] / 16.0;
        }
        together += std::pow(mean - whole.mean, 2) / sequences;
      }
      apart += whole.variance * 20000 / samples;
    }
    EXPECT_LT(together, 0.75 * apart) << name;
  }
}

TEST(Random, IsUniform) {
  constexpr int count = 20000;
  std::array<int, 20> counts{};
  for (std::uint64_t id = 0; id < count; ++id) {
    scenes::Random random(1, id);
    const double first = random.uniform();
    const double second = random.uniform();
    ASSERT_TRUE(first >= 0 && first < 1 && second >= 0 && second < 1);
    ++counts[static_cast<std::size_t>(10 * first)];
    ++counts[10 + static_cast<std::size_t>(10 * second)];
  }
  // Each is binomial with 2000 expected and a standard deviation of 42.
  for (const int each : counts) EXPECT_NEAR(each, count / 10, 5 * 42.5);
}

}  // namespace
