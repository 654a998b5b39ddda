// SPDX-License-Identifier: MIT
// Pictures that are constant within pixels: exact where every pixel has a sample of its own.
#include "freqsynth/image/pixel_agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

TEST(PixelAgreement, NeedsPairsThatAreEqual) {
  PixelAgreement agreement;
  EXPECT_FALSE(agreement.holds()) << "nothing is known";
  agreement.low = -1;
  agreement.high = 3;
  agreement.pairs = 15;
  EXPECT_FALSE(agreement.holds());
  agreement.pairs = 16;
  EXPECT_TRUE(agreement.holds());
  agreement.spread = 0.1f;
  EXPECT_FALSE(agreement.holds());
}

TEST(PixelAgreement, OfTwoBlocksIsThatOfAllTheirPixels) {
  PixelAgreement one, other;
  one.spread = 0.5f;
  one.low = 1;
  one.high = 2;
  one.pairs = 3;
  other.spread = 0.25f;
  other.low = -4;
  other.high = 1.5f;
  other.pairs = 40;
  one.join(other);
  EXPECT_EQ(one.spread, 0.5f);
  EXPECT_EQ(one.low, -4);
  EXPECT_EQ(one.high, 2);
  EXPECT_EQ(one.pairs, 43u);
  one.join(PixelAgreement::none());
  EXPECT_FALSE(one.holds());
}

// Of a random picture that is constant in each of its pixels.
class PixelArt {
 public:
  PixelArt(std::size_t width, std::size_t height, std::uint32_t seed) : width_(width) {
    std::mt19937 random(seed);
    // Large rectangles of the same value, as drawn pictures have; each rectangle hides others.
    values_.assign(width * height, 0.25f);
    for (int k = 0; k < 12; ++k) {
      const std::size_t left = random() % width, top = random() % height;
      const std::size_t right = std::min(width, left + 1 + random() % 20);
      const std::size_t bottom = std::min(height, top + 1 + random() % 20);
      const float value = static_cast<float>(random() % 1000) / 1000;
      for (std::size_t y = top; y < bottom; ++y) {
        std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(y * width + left), right - left,
                    value);
      }
    }
  }
  float operator()(double x, double y) const {
    const auto column = std::min(static_cast<std::size_t>(x), width_ - 1);
    const auto row = std::min(static_cast<std::size_t>(y), values_.size() / width_ - 1);
    return values_[row * width_ + column];
  }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }

 private:
  std::size_t width_;
  std::vector<float> values_;
};

TEST(PixelAgreement, MakesPicturesThatAreConstantInPixelsExact) {
  const SharedInverseList list(helpers::settings_of(64, 48).list);
  for (const double spp : {4.0, 16.0}) {
    double worst = 0;
    std::size_t wrong = 0, all = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const PixelArt art(64, 48, seed);
      Synthesizer engine(helpers::settings_of(64, 48));
      engine.run(art, {.samples_per_pixel = spp});
      const FrequencyImage image = engine.finished_image();
      const std::vector<float> pixels = reconstruct(image);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double error = std::abs(double{pixels[i]} - double{art.values()[i]});
        worst = std::max(worst, error);
        ++all;
        if (error <= 2e-6) continue;
        ++wrong;
        // Such a pixel has no sample of its own; it is held within those around it.
        const std::size_t x = i % 64, y = i / 64;
        OwnedSamples owned;
        for (std::size_t n = 0; n < image.samples(x / 8, y / 8); ++n) owned.add(list->row(n));
        ASSERT_FALSE(owned.any(y % 8 * 8 + x % 8)) << x << ", " << y << " at " << spp;
      }
    }
    const std::size_t most = spp < 16 ? all / 100 : 0;
    EXPECT_LE(wrong, most) << "at " << spp;
    EXPECT_LT(worst, spp < 16 ? 0.1 : 2e-6) << "at " << spp;
  }
}

TEST(PixelAgreement, IsThatOfTheMeansOfOwnedSamples) {
  const SharedInverseList list(InverseListSettings{});
  OwnedSamples owned;
  std::array<float, max_terms> sums = {};
  std::array<std::uint32_t, max_terms> counts = {};
  for (std::size_t n = 0; n < 100; ++n) {
    owned.add(list->row(n));
    const SequencePosition position = list->position(n);
    const double x = 8 * position.s, y = 8 * position.t;
    if (x == std::floor(x) || y == std::floor(y)) continue;
    const auto pixel = static_cast<std::size_t>(8 * std::floor(y) + std::floor(x));
    sums[pixel] += static_cast<float>(pixel);  // each pixel's samples are its number
    ++counts[pixel];
  }
  BlockFit fit{.coefficients = {}, .pixel_sums = sums, .residual = 0, .gaps = {}};
  std::array<float, max_terms> means;
  EXPECT_FALSE(owned.agreement(fit, means).holds()) << "own sums are not known";
  for (const float mean : means) EXPECT_EQ(mean, OwnMeans::unknown);
  fit.own_sums = sums;
  fit.spread = 0.25f;
  const PixelAgreement agreement = owned.agreement(fit, means);
  std::uint32_t pairs = 0, first = max_terms, last = 0;
  for (std::uint32_t pixel = 0; pixel < max_terms; ++pixel) {
    ASSERT_EQ(owned.any(pixel), counts[pixel] > 0) << pixel;
    ASSERT_EQ(means[pixel], counts[pixel] > 0 ? static_cast<float>(pixel) : OwnMeans::unknown);
    if (counts[pixel] == 0) continue;
    ASSERT_EQ(owned.mean(sums, pixel), static_cast<float>(pixel));
    first = std::min(first, pixel);
    last = pixel;
    pairs += counts[pixel] > 1 ? 1 : 0;
  }
  EXPECT_EQ(agreement.low, static_cast<float>(first));
  EXPECT_EQ(agreement.high, static_cast<float>(last));
  EXPECT_EQ(agreement.pairs, pairs);
  EXPECT_EQ(agreement.spread, 0.25f);
}

TEST(PixelAgreement, IsNotSeenWhereSlantedEdgesCrossPixels) {
  // Then the mean of a pixel's own samples is worse than the fit and its residuals.
  const auto edge = [](double x, double y) { return y + 0.31 * x > 40 ? 1.0f : 0.0f; };
  Synthesizer engine(helpers::settings_of(64, 64));
  engine.run(edge, {.samples_per_pixel = 4});
  const std::vector<float> pixels = reconstruct(engine.finished_image());
  const double error = helpers::rmse_of(pixels, 64, edge);
  // Of 2 x 2 samples in each pixel: what own samples would give, and more of them.
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto x = static_cast<double>(i % 64), y = static_cast<double>(i / 64);
    double own = 0, mean = 0;
    for (const double u : {0.25, 0.75}) {
      for (const double v : {0.25, 0.75}) own += double{edge(x + u, y + v)} / 4;
    }
    for (int k = 0; k < 256; ++k) {
      mean += double{edge(x + (k % 16 + 0.5) / 16, y + (k / 16 + 0.5) / 16)} / 256;
    }
    sum += std::pow(own - mean, 2);
  }
  EXPECT_LT(error, 0.7 * std::sqrt(sum / static_cast<double>(pixels.size())));
}

}  // namespace
}  // namespace freqsynth
