// SPDX-License-Identifier: MIT
#include "quality/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

namespace {

using quality::Reference;
using quality::ReferenceSettings;

/// Red: an edge at x = 2.3. Green: a plane. Blue: noise around 0.5.
void card(double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
  std::mt19937_64 random(id);
  rgb[0] = x < 2.3 ? 0.0f : 1.0f;
  rgb[1] = static_cast<float>(0.1 * x + 0.02 * y);
  rgb[2] = static_cast<float>(random() >> 11) * 0x1p-53f;
}

Reference render(std::size_t samples, std::uint64_t seed = 1, std::size_t threads = 2) {
  freqsynth::ThreadPool pool(threads);
  return quality::render_reference(card, nullptr, {5, 4, samples, seed}, pool);
}

TEST(Reference, HoldsTheAveragesOfPixels) {
  const Reference reference = render(1024);
  const std::vector<float> pixels = reference.pixels();
  ASSERT_EQ(pixels.size(), 3u * 5 * 4);
  for (std::size_t i = 0; i < 20; ++i) {
    const double x = static_cast<double>(i % 5);
    const double y = static_cast<double>(i / 5);
    // 512 jittered samples in 32 columns: the edge is known to a few hundredths of a column.
    EXPECT_NEAR(pixels[3 * i], x < 2 ? 0 : x > 2 ? 1 : 0.7, 0.01);
    EXPECT_NEAR(pixels[3 * i + 1], 0.1 * (x + 0.5) + 0.02 * (y + 0.5), 1e-3);
    // Five standard deviations of the mean of 1024 numbers in 0..1.
    EXPECT_NEAR(pixels[3 * i + 2], 0.5, 5 * std::sqrt(1.0 / 12 / 1024));
  }
}

TEST(Reference, ToldErrorIsThatOfNoise) {
  const auto noise = [](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    card(x, y, id, rgb);
    rgb[0] = rgb[1] = rgb[2];
  };
  freqsynth::ThreadPool pool(2);
  const Reference reference = quality::render_reference(noise, nullptr, {32, 32, 64, 1}, pool);
  const double expected = std::sqrt(1.0 / 12 / 64);
  EXPECT_NEAR(reference.standard_error(), expected, 0.1 * expected);
}

TEST(Reference, DoesNotDependOnTheNumberOfThreads) {
  const Reference one = render(32, 1, 1);
  EXPECT_EQ(one.half, render(32, 1, 3).half);
  EXPECT_NE(one.half, render(32, 2, 1).half);
  EXPECT_NE(one.half[0], one.half[1]);
}

TEST(Reference, EverySampleHasAnIdOfItsOwnThatNoMethodUses) {
  std::mutex mutex;
  std::set<std::uint64_t> ids;
  freqsynth::ThreadPool pool(2);
  (void)quality::render_reference(
      [&](double, double, std::uint64_t id, std::span<float, 3> rgb) {
        const std::scoped_lock lock(mutex);
        ids.insert(id);
        rgb[0] = rgb[1] = rgb[2] = 0;
      },
      nullptr, {5, 4, 18, 1}, pool);
  EXPECT_EQ(ids.size(), 5u * 4 * 18);
  EXPECT_GE(*ids.begin(), std::uint64_t{1} << 63);
}

/// Knows the pixels of the first column.
bool first_column(std::size_t x, std::size_t y, std::span<float, 3> rgb) {
  if (x != 0) return false;
  rgb[0] = rgb[1] = rgb[2] = 10.0f + static_cast<float>(y);
  return true;
}

TEST(Reference, TakesExactPixelsWhereTheyAreKnown) {
  freqsynth::ThreadPool pool(2);
  const Reference sampled = render(8);
  const Reference reference = quality::render_reference(card, first_column, {5, 4, 8, 1}, pool);
  for (std::size_t pixel = 0; pixel < 20; ++pixel) {
    for (const auto& half : reference.half) {
      if (pixel % 5 == 0) {
        EXPECT_EQ(half[3 * pixel], 10.0f + static_cast<float>(pixel / 5));
      } else {
        EXPECT_GE(half[3 * pixel], 0);
        EXPECT_LE(half[3 * pixel], 1);
      }
    }
  }
  EXPECT_GT(reference.standard_error(), 0);
  EXPECT_LT(reference.standard_error(), sampled.standard_error());
}

TEST(Reference, RefusesAnOddNumberOfSamples) {
  EXPECT_THROW((void)render(0), std::invalid_argument);
  EXPECT_THROW((void)render(7), std::invalid_argument);
  EXPECT_NO_THROW((void)render(2));
}

TEST(Reference, PassesOnWhatTheFunctionThrows) {
  freqsynth::ThreadPool pool(2);
  const auto faulty = [](double, double, std::uint64_t, std::span<float, 3>) {
    throw std::domain_error("faulty");
  };
  EXPECT_THROW((void)quality::render_reference(faulty, nullptr, {5, 4, 2, 1}, pool),
               std::domain_error);
}

TEST(Fingerprint, ChangesWithTheFunction) {
  const std::uint64_t first = quality::fingerprint(card, nullptr, 5, 4);
  EXPECT_EQ(first, quality::fingerprint(card, nullptr, 5, 4));
  EXPECT_NE(first, quality::fingerprint(card, nullptr, 5, 5));
  const auto other = [](double x, double y, std::uint64_t id, std::span<float, 3> rgb) {
    card(x + 1e-3, y, id, rgb);
  };
  EXPECT_NE(first, quality::fingerprint(other, nullptr, 5, 4));
  EXPECT_NE(first, quality::fingerprint(card, first_column, 5, 4));
}

}  // namespace
