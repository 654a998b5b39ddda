// SPDX-License-Identifier: MIT
// What the smoothing of noise is made of, and that it does not depend on the executor.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/image/linear_blend.h"
#include "freqsynth/image/lone_peaks.h"
#include "freqsynth/image/smooth_noise.h"
#include "freqsynth/image/window_ranks.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

TEST(WindowRanks, FollowASortedSet) {
  oracle::Random random(2);
  for (const std::size_t limit : {1u, 64u, 65u, 1000u}) {
    detail::WindowRanks window(limit);
    std::set<std::size_t> expected;
    for (int step = 0; step < 5000; ++step) {
      const std::size_t number = random.below(limit);
      if (expected.erase(number) > 0) {
        window.remove(number);
      } else {
        expected.insert(number);
        window.add(number);
      }
      if (expected.empty()) continue;
      const std::size_t rank = random.below(expected.size());
      ASSERT_EQ(window.of_rank(rank),
                *std::next(expected.begin(), static_cast<std::ptrdiff_t>(rank)));
    }
  }
}

/// 32 x 32 pixels of 1, each with a sample.
NoisyPicture flat_picture() {
  NoisyPicture picture{32, 32, NoisyPicture::Plane(32 * 32, 1.0f), {}, {}, {}, {}};
  picture.sums = {picture.weights};
  picture.pixels = {picture.weights};
  picture.variances = {NoisyPicture::Plane(16)};
  return picture;
}

/// Gives a pixel some samples of a value, whose block's fit leaves out all of one of them.
void add_peak(NoisyPicture& picture, std::size_t pixel, float samples, float value) {
  picture.weights[pixel] = samples;
  picture.sums[0][pixel] = samples * value;
  picture.pixels[0][pixel] = value;
  picture.variances[0][pixel / 32 / 8 * 4 + pixel % 32 / 8] =
      (value - 1) * (value - 1) / (63 + samples);
}

TEST(LonePeaks, ThoseOfOneSampleGo) {
  NoisyPicture picture = flat_picture();
  const NoisyPicture::Plane flat = picture.pixels[0];
  for (const std::size_t pixel : {0u, 9u * 32 + 20, 31u * 32 + 31}) {
    add_peak(picture, pixel, 1, 100);
  }
  EXPECT_EQ(detail::LonePeaks(picture, 0).removed(), flat);
}

TEST(LonePeaks, ThoseThatSamplesAgreeOnStay) {
  NoisyPicture picture = flat_picture();
  add_peak(picture, 9 * 32 + 20, 2, 100);
  EXPECT_EQ(detail::LonePeaks(picture, 0).removed(), picture.pixels[0]);
}

TEST(LonePeaks, LinesAndSpotsAreNone) {
  NoisyPicture picture = flat_picture();
  for (std::size_t x = 0; x < 32; ++x) add_peak(picture, 9 * 32 + x, 1, 100);
  for (std::size_t y = 20; y < 25; ++y) {
    for (std::size_t x = 20; x < 25; ++x) add_peak(picture, y * 32 + x, 1, 100);
  }
  EXPECT_EQ(detail::LonePeaks(picture, 0).removed(), picture.pixels[0]);
}

TEST(LonePeaks, AreThoseOfTheDefinition) {
  // Few values, so that many pixels are as bright as each other; samples lie in pixels as bright.
  oracle::Random random(5);
  NoisyPicture picture = flat_picture();
  for (std::size_t pixel = 0; pixel < picture.weights.size(); ++pixel) {
    const auto value = static_cast<float>(random.below(30));
    picture.pixels[0][pixel] = picture.sums[0][pixel] = value;
  }
  picture.variances[0].assign(16, 1e6f);  // all can be of one sample
  NoisyPicture::Plane expected = picture.pixels[0];
  std::size_t peaks = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      std::vector<float> far;  // 2 or 3 away along one of the axes
      for (int v = std::max(0, y - 3); v <= std::min(31, y + 3); ++v) {
        for (int u = std::max(0, x - 3); u <= std::min(31, x + 3); ++u) {
          if (std::max(std::abs(u - x), std::abs(v - y)) < 2) continue;
          far.push_back(picture.pixels[0][static_cast<std::size_t>(v * 32 + u)]);
        }
      }
      std::sort(far.rbegin(), far.rend());
      float& own = expected[static_cast<std::size_t>(y * 32 + x)];
      if (own <= far[2]) continue;
      own = far[2];
      ++peaks;
    }
  }
  EXPECT_GT(peaks, 20u);
  EXPECT_EQ(detail::LonePeaks(picture, 0).removed(), expected);
}

TEST(LinearBlend, IsBetweenTheCentresOfCells) {
  constexpr std::size_t cell = 4, cells = 3;
  const auto held = detail::blends_along(12, cell, cells, 2.0);
  const auto beyond = detail::blends_along(12, cell, cells, 3.0);
  for (std::size_t pixel = 0; pixel < 12; ++pixel) {
    const double place = (static_cast<double>(pixel) + 0.5) / cell - 0.5;
    const auto value = [](const detail::LinearBlend<double>& blend) {
      return static_cast<double>(blend.first) * (1 - blend.share) +
             static_cast<double>(blend.second) * blend.share;
    };
    EXPECT_DOUBLE_EQ(value(held[pixel]), std::clamp(place, 0.0, 2.0));
    EXPECT_DOUBLE_EQ(value(beyond[pixel]), std::clamp(place, 0.0, 2.0));
    EXPECT_LT(held[pixel].second, cells);
    EXPECT_LT(beyond[pixel].second, cells);
  }
  EXPECT_EQ(held.back().share, 0);
  EXPECT_GT(beyond.back().share, 0) << "of the last cell and itself";
}

NoisyPicture random_picture(std::size_t width, std::size_t height, std::size_t channels) {
  NoisyPicture picture{width, height, {}, {}, {}, {}, {}};
  oracle::Random random(9);
  picture.weights.resize(width * height);
  picture.sums.assign(channels, picture.weights);
  picture.pixels.assign(channels, picture.weights);
  picture.variances.assign(channels, NoisyPicture::Plane(width * height / max_terms));
  for (std::size_t i = 0; i < picture.weights.size(); ++i) {
    // Some blocks have no samples.
    const bool none = i / 8 % 5 == 0 && i / width / 8 % 2 == 1;
    picture.weights[i] = none ? 0 : static_cast<float>(random.below(4)) * 0.5f;
    for (std::size_t c = 0; c < channels; ++c) {
      picture.pixels[c][i] = static_cast<float>(random.uniform(0, 1)) + (i % width > 60 ? 2 : 0);
      picture.sums[c][i] =
          picture.weights[i] * (picture.pixels[c][i] + static_cast<float>(random.uniform(-1, 1)));
    }
  }
  for (auto& plane : picture.variances) {
    for (float& variance : plane) variance = static_cast<float>(random.uniform(0, 1));
  }
  return picture;
}

/// The last task first.
struct Backwards {
  static void execute(std::size_t count, TaskRef task) {
    for (std::size_t i = count; i > 0; --i) task(i - 1);
  }
  static std::size_t concurrency() { return 4; }
};

TEST(SmoothNoise, DoesNotDependOnTheExecutor) {
  ThreadPool two(2), three(3), seven(7);
  struct Size {
    std::size_t width, height;
  };
  for (const Size size : {Size{104, 200}, Size{8, 88}, Size{160, 8}, Size{8, 8}}) {
    const NoisyPicture noisy = random_picture(size.width, size.height, 4);
    const std::vector<std::size_t> channels = {0, 3}, features = {1, 2};
    NoisyPicture expected = noisy;
    smooth_noise(expected, channels, features);
    EXPECT_NE(expected.pixels[0], noisy.pixels[0]);
    const auto expect_same = [&](auto&& executor) {
      NoisyPicture picture = noisy;
      smooth_noise(picture, channels, features, executor);
      EXPECT_EQ(picture.pixels, expected.pixels) << size.width << " x " << size.height;
    };
    expect_same(two);
    expect_same(three);
    expect_same(seven);
    expect_same(Backwards{});
  }
}

}  // namespace
}  // namespace freqsynth
