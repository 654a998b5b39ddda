// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "baseline_helpers.h"
#include "baselines/alpha_trimmed.h"
#include "baselines/dippe_wold.h"
#include "baselines/energy_preserving.h"
#include "baselines/supersampling.h"

namespace baselines {
namespace {

std::vector<Sample> jittered(const Radiance& radiance, const Job& job) {
  Sampler sampler(radiance, job);
  return supersamples(sampler, job, true);
}

/// White noise of mean 0.5, told by the id of a sample.
void noise(double, double, std::uint64_t id, std::span<float, 3> rgb) {
  Random random(id);
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(random.uniform()));
}

TEST(DippeWold, NoiseWidensTheFilterAndSignalDoesNot) {
  // The narrowest box is the pixel, in which the signal below does not vary.
  const DippeWoldSettings settings{.filter = PixelFilter::box, .widths = {1, 2, 4}, .threshold = 1};
  const auto mean_width = [&](const Radiance& radiance) {
    const std::vector<float> widths =
        dippe_wold_widths(jittered(radiance, job_at(48, 48, 4)), 48, 48, settings);
    return std::accumulate(widths.begin(), widths.end(), 0.0) / static_cast<double>(widths.size());
  };
  const double in_noise = mean_width(noise);
  // Each pixel its own value, without noise: all of it is signal.
  const double in_signal = mean_width(grey([](double x, double y) {
    return std::fmod(std::floor(x) * 0.37 + std::floor(y) * 0.71, 1.0);
  }));
  // 2.71 was measured, with a fifth less allowed.
  EXPECT_GT(in_noise, 2.17);
  EXPECT_EQ(in_signal, 1);
}

TEST(DippeWold, AThresholdOf0NeverWidens) {
  const DippeWoldSettings settings{.widths = {1.5, 3}, .threshold = 0};
  const std::vector<Sample> samples = jittered(noise, job_at(24, 24, 16));
  for (const float width : dippe_wold_widths(samples, 24, 24, settings)) EXPECT_EQ(width, 1.5f);
}

TEST(DippeWold, AVastThresholdAlwaysTakesTheWidest) {
  const DippeWoldSettings settings{.widths = {1, 2, 3}, .threshold = 1e30};
  const std::vector<Sample> samples = jittered(noise, job_at(24, 24, 4));
  for (const float width : dippe_wold_widths(samples, 24, 24, settings)) EXPECT_EQ(width, 3.0f);
}

TEST(DippeWold, ReducesNoise) {
  const std::vector<double> expected(48 * 48, 0.5);
  const Job job = job_at(48, 48, 4);
  const double narrow = rms_error(dippe_wold(noise, job, {.threshold = 0}), expected);
  const double tolerant = rms_error(dippe_wold(noise, job, {.threshold = 2}), expected);
  // In pure noise the difference of two averages has at most the sum of their variances, so that
  // this threshold is mostly not reached. 0.54 was measured.
  EXPECT_LT(tolerant, 0.6 * narrow);
}

TEST(DippeWold, NeedsAWidth) {
  EXPECT_THROW((void)dippe_wold(noise, {4, 4, 16, 0}, {.widths = {}}), std::invalid_argument);
}

TEST(AlphaTrimmed, RemovesASpike) {
  Rendering spiky = grey_picture(9, 9, 0.25f);
  spiky.pixels[(4 * 9 + 4) * 3] = 100;
  // Corners that are a whole pixel away along an axis see nothing of the pixel
  // itself, so that the spike is one of seven values, and the largest.
  const Rendering filtered = alpha_trimmed(spiky, {.alpha = 0.2, .distance = 1.2});
  EXPECT_NEAR(filtered.pixels[(4 * 9 + 4) * 3], 0.25, 1e-6);
  // What is left is in the pixels beside it: 0.30 of the energy was measured.
  EXPECT_LT(energy(filtered), 0.38 * energy(spiky));
}

TEST(AlphaTrimmed, WithoutTrimmingItIsTheMeanOfTheHexagon) {
  // On a plane the bilinear values are exact, and a hexagon is centred on its pixel.
  Rendering plane = grey_picture(9, 9, 0);
  for (std::size_t i = 0; i < plane.pixels.size(); ++i) {
    plane.pixels[i] = static_cast<float>(i / 3 % 9) + 3 * static_cast<float>(i / 27);
  }
  const Rendering filtered = alpha_trimmed(plane, {.alpha = 0, .distance = 1.5});
  for (std::size_t y = 2; y < 7; ++y) {
    for (std::size_t x = 2; x < 7; ++x) {
      EXPECT_NEAR(filtered.pixels[(y * 9 + x) * 3], plane.pixels[(y * 9 + x) * 3], 1e-5);
    }
  }
}

TEST(AlphaTrimmed, AverageOfARowOfOneWhitePixelIsThatOfItsHexagon) {
  // With corners at distance 1, two of them on the row: the white pixel sees itself and, through
  // the four corners at (+-1/2, +-sqrt(3)/2), (1 - 1/2) (1 - sqrt(3)/2) of itself each.
  Rendering dot = grey_picture(9, 9, 0);
  for (std::size_t c = 0; c < 3; ++c) dot.pixels[(4 * 9 + 4) * 3 + c] = 7;
  const Rendering filtered = alpha_trimmed(dot, {.alpha = 0, .distance = 1});
  const double corner = 0.5 * (1 - std::numbers::sqrt3 / 2);
  EXPECT_NEAR(filtered.pixels[(4 * 9 + 4) * 3], 1 + 4 * corner, 1e-5);
}

TEST(AlphaTrimmed, RefusesToTrimEverything) {
  EXPECT_THROW((void)alpha_trimmed(grey_picture(2, 2, 1), {.alpha = 0.5}), std::invalid_argument);
  EXPECT_THROW((void)alpha_trimmed(grey_picture(2, 2, 1), {.alpha = -0.1}), std::invalid_argument);
}

Rendering noisy_picture(std::uint64_t seed) {
  Random random(seed);
  Rendering rendering = grey_picture(31, 23, 0);
  for (float& value : rendering.pixels) {
    value = static_cast<float>(random.below(25) == 0 ? 50 * random.uniform() : random.uniform());
  }
  return rendering;
}

TEST(EnergyPreserving, PreservesTheEnergyOfEachComponent) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Rendering noisy = noisy_picture(seed);
    const Rendering filtered = energy_preserving(noisy);
    EXPECT_NE(filtered.pixels, noisy.pixels);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(energy(filtered, c), energy(noisy, c), 1e-5 * energy(noisy, c));
    }
  }
}

TEST(EnergyPreserving, NoPixelReceivesMoreThanIsVisibleOfASpike) {
  Rendering spiky = grey_picture(41, 41, 1);
  const std::size_t at = 20 * 41 + 3;  // near the border, where windows are clipped
  for (std::size_t c = 0; c < 3; ++c) spiky.pixels[at * 3 + c] = 3;
  const double visible = energy(spiky) / (41 * 41) / 128;
  const Rendering filtered = energy_preserving(spiky);
  EXPECT_NEAR(energy(filtered), energy(spiky), 1e-3);
  for (std::size_t i = 0; i < 41 * 41; ++i) {
    ASSERT_GE(filtered.pixels[i * 3], 1 - 1e-6);
    ASSERT_LE(filtered.pixels[i * 3], 1 + visible + 1e-6) << i;
  }
}

TEST(EnergyPreserving, WhatTheWidestWindowCannotTakeStays) {
  Rendering spiky = grey_picture(41, 41, 1);
  const std::size_t at = 20 * 41 + 20;
  for (std::size_t c = 0; c < 3; ++c) spiky.pixels[at * 3 + c] = 1000;
  const double visible = energy(spiky) / (41 * 41) / 128;
  const Rendering filtered = energy_preserving(spiky, {.reach = 2});
  EXPECT_NEAR(filtered.pixels[at * 3], 1000 - 24 * visible, 1e-2);
  EXPECT_NEAR(energy(filtered), energy(spiky), 1e-2);
  EXPECT_NEAR(filtered.pixels[(at + 2) * 3], 1 + visible, 1e-5);
  EXPECT_NEAR(filtered.pixels[(at + 3) * 3], 1, 1e-6);
}

TEST(EnergyPreserving, LeavesAnEdgeAlone) {
  Rendering edge = grey_picture(20, 20, 0.25f);
  for (std::size_t i = 0; i < edge.pixels.size(); ++i) {
    if (i / 3 % 20 >= 10) edge.pixels[i] = 1;
  }
  EXPECT_EQ(energy_preserving(edge, {.deviations = 3}).pixels, edge.pixels);
}

TEST(EnergyPreserving, BlackAndSinglePixelsStay) {
  EXPECT_EQ(energy_preserving(grey_picture(5, 4, 0)).pixels, grey_picture(5, 4, 0).pixels);
  EXPECT_EQ(energy_preserving(grey_picture(1, 1, 2)).pixels, grey_picture(1, 1, 2).pixels);
}

}  // namespace
}  // namespace baselines
