// SPDX-License-Identifier: MIT
// Pictures that are constant within pixels: exact where every pixel has a sample of its own.
#include "freqsynth/image/pixel_agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

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
  for (const double spp : {4.0, 16.0}) {
    double worst = 0;
    std::size_t wrong = 0, all = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const PixelArt art(64, 48, seed);
      Synthesizer engine(helpers::settings_of(64, 48));
      engine.run(art, {.samples_per_pixel = spp});
      const std::vector<float> pixels = reconstruct(engine.finished_image());
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double error = std::abs(double{pixels[i]} - double{art.values()[i]});
        worst = std::max(worst, error);
        wrong += error > 2e-6 ? 1 : 0;
        ++all;
      }
    }
    // A pixel without a sample of its own, in a block that looks flat, is within those around it.
    const std::size_t most = spp < 16 ? all / 100 : 0;
    EXPECT_LE(wrong, most) << "at " << spp;
    EXPECT_LT(worst, spp < 16 ? 0.1 : 2e-6) << "at " << spp;
  }
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
