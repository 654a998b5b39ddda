// SPDX-License-Identifier: MIT
// The methods as entries of the laboratory, and the laboratory's own accounts.

#include "quality/methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using baselines::Job;
using baselines::Radiance;
using baselines::Rendering;

/// A smooth slope with an edge.
void slope(double x, double y, std::uint64_t, std::span<float, 3> rgb) {
  const bool bright = x + 0.3 * y > 30;
  rgb[0] = static_cast<float>(0.01 * x);
  rgb[1] = static_cast<float>(0.3 + 0.005 * y);
  rgb[2] = bright ? 0.9f : 0.1f;
}

TEST(Methods, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const quality::Method& method : quality::methods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_FALSE(method.description.empty()) << method.name;
    EXPECT_EQ(&quality::find_method(method.name), &method);
  }
  EXPECT_EQ(names.count("freqsynth"), 1u);
  EXPECT_EQ(names.count("freqsynth-paper"), 1u);
  EXPECT_EQ(names.count("jittered-box"), 1u);
}

TEST(Methods, AnUnknownNameIsToldWithTheValidOnes) {
  try {
    (void)quality::find_method("crystal-ball");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("'crystal-ball'"), std::string::npos) << said;
    for (const quality::Method& method : quality::methods()) {
      EXPECT_NE(said.find(method.name), std::string::npos) << said;
    }
  }
}

TEST(Methods, EachMakesAPictureWithTheSamplesThatItIsAllowed) {
  for (const quality::Method& method : quality::methods()) {
    for (const double rate : {0.25, 1.0, 4.0}) {
      if (rate < method.least_rate) continue;
      const Job job{48, 40, quality::samples_of(rate, 48, 40), 3};
      const quality::Run run = quality::run_method(method, slope, job);
      ASSERT_EQ(run.pixels.size(), 3 * job.width * job.height) << method.name;
      EXPECT_LE(run.calls, job.samples) << method.name;
      EXPECT_GT(run.calls, 0u) << method.name;
      EXPECT_EQ(std::accumulate(run.samples.begin(), run.samples.end(), std::uint64_t{0}),
                run.calls)
          << method.name;
      for (const float value : run.pixels) ASSERT_TRUE(std::isfinite(value)) << method.name;
    }
  }
}

TEST(Methods, TheirOwnCountsAddUpToTheCalls) {
  for (const quality::Method& method : quality::methods()) {
    std::uint64_t calls = 0;
    const Job job{40, 48, 40 * 48, 5};
    const Rendering rendering = method.render(
        [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
          ++calls;
          slope(x, y, id, rgb);
        },
        job);
    EXPECT_EQ(std::accumulate(rendering.samples.begin(), rendering.samples.end(), std::uint64_t{0}),
              calls)
        << method.name;
  }
}

TEST(Methods, TheSameSeedGivesTheSamePicture) {
  for (const quality::Method& method : quality::methods()) {
    const Job job{32, 32, 2 * 32 * 32, 11};
    const auto pixels = quality::run_method(method, slope, job).pixels;
    EXPECT_EQ(pixels, quality::run_method(method, slope, job).pixels) << method.name;
  }
}

TEST(Methods, EverySampleHasAnIdOfItsOwn) {
  for (const quality::Method& method : quality::methods()) {
    std::vector<std::uint64_t> ids;
    const Job job{40, 40, 2 * 40 * 40, 2};
    (void)method.render(
        [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
          ids.push_back(id);
          slope(x, y, id, rgb);
        },
        job);
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end()) << method.name;
  }
}

/// Calls the function `calls` times at the same position.
quality::Method stubborn(std::uint64_t calls, double x, double y) {
  return {"stubborn", "a method for tests", "",
          [=](const Radiance& radiance, const Job& job) {
            Rendering result{job.width, job.height, {}, {}};
            result.pixels.resize(3 * job.width * job.height);
            for (std::uint64_t i = 0; i < calls; ++i) {
              radiance(x, y, i, std::span(result.pixels).first<3>());
            }
            return result;
          },
          0};
}

TEST(RunMethod, CountsWhatIsTakenWhereItIsTaken) {
  const quality::Run run = quality::run_method(stubborn(7, 3.5, 2.0), slope, {6, 5, 30, 0});
  EXPECT_EQ(run.calls, 7u);
  for (std::size_t pixel = 0; pixel < 30; ++pixel) {
    EXPECT_EQ(run.samples[pixel], pixel == 2 * 6 + 3 ? 7u : 0u) << pixel;
  }
  // The far corner belongs to the last pixel.
  EXPECT_EQ(quality::run_method(stubborn(2, 6, 5), slope, {6, 5, 30, 0}).samples[29], 2u);
}

TEST(RunMethod, RefusesMoreSamplesThanAllowed) {
  EXPECT_NO_THROW((void)quality::run_method(stubborn(30, 1, 1), slope, {6, 5, 30, 0}));
  try {
    (void)quality::run_method(stubborn(31, 1, 1), slope, {6, 5, 30, 0});
    FAIL() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "stubborn: 31 samples taken, 30 allowed");
  }
}

TEST(RunMethod, RefusesSamplesOutside) {
  for (const auto& [x, y] : {std::pair{-0.1, 1.0}, {6.1, 1.0}, {1.0, -0.1}, {1.0, 5.1}}) {
    EXPECT_THROW((void)quality::run_method(stubborn(1, x, y), slope, {6, 5, 30, 0}),
                 std::runtime_error);
  }
}

TEST(RunMethod, RefusesAPictureOfAnotherSize) {
  quality::Method method = stubborn(1, 1, 1);
  method.render = [](const Radiance&, const Job& job) {
    return Rendering{job.width, job.height + 1, {}, {}};
  };
  EXPECT_THROW((void)quality::run_method(method, slope, {6, 5, 30, 0}), std::runtime_error);
}

TEST(RunMethod, TheTimeOfTheSamplerIsTakenAtTheMethodsOwnPositions) {
  // What is called again to take the time is what was called before, or an even part of it.
  for (const std::uint64_t calls : {100u, 65536u, 100000u, 500000u}) {
    std::uint64_t seen = 0;
    std::uint64_t elsewhere = 0;
    const Radiance radiance = [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
      ++seen;
      elsewhere += x != 3.25 || y != 1.5 || id >= calls;
      rgb[0] = rgb[1] = rgb[2] = 0;
    };
    (void)quality::run_method(stubborn(calls, 3.25, 1.5), radiance, {16, 16, calls, 0});
    const std::uint64_t again = seen - calls;
    EXPECT_LE(again, 2 * 131072u);
    EXPECT_GE(again, 2 * std::min<std::uint64_t>(calls, 65536));
    EXPECT_EQ(elsewhere, 0u);
  }
}

TEST(RunMethod, SamplesWithFeaturesCountAsTheOthersDo) {
  for (const quality::Method& method : quality::methods()) {
    std::uint64_t plain = 0, featured = 0;
    Job job{32, 24, 4 * 32 * 24, 7, true, 7, {}};
    job.radiance_and_features = [&](double x, double y, std::uint64_t id, std::span<float> values) {
      ASSERT_EQ(values.size(), 10u);
      ++featured;
      slope(x, y, id, values.first<3>());
      std::fill(values.begin() + 3, values.end(), 0.5f);
    };
    const quality::Run run = quality::run_method(
        method,
        [&](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
          ++plain;
          slope(x, y, id, rgb);
        },
        job);
    const bool uses_features =
        method.name == "freqsynth" || method.name == "freqsynth-means" || method.name == "nfor";
    // All are called twice more to take the time.
    EXPECT_EQ(featured, uses_features ? 3 * run.calls : 0) << method.name;
    EXPECT_EQ(plain, uses_features ? 0 : 3 * run.calls) << method.name;
    ASSERT_EQ(run.pixels.size(), 3 * job.width * job.height) << method.name;
  }
}

TEST(SamplesOf, RoundsAndIsNeverZero) {
  EXPECT_EQ(quality::samples_of(1.0 / 16, 256, 256), 4096u);
  EXPECT_EQ(quality::samples_of(4, 10, 10), 400u);
  EXPECT_EQ(quality::samples_of(0.333, 10, 10), 33u);
  EXPECT_EQ(quality::samples_of(1e-6, 10, 10), 1u);
}

}  // namespace
