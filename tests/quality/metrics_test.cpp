// The metrics against closed forms and against slow computations that follow the definitions.

#include "quality/metrics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using quality::PictureView;

struct Picture {
  std::size_t width, height;
  std::vector<float> pixels;

  Picture(std::size_t w, std::size_t h, float value = 0)
      : width(w), height(h), pixels(3 * w * h, value) {}
  operator PictureView() const { return {width, height, pixels}; }
  void set(std::size_t x, std::size_t y, float value) {
    for (std::size_t c = 0; c < 3; ++c) pixels[3 * (y * width + x) + c] = value;
  }
};

Picture noise(std::size_t width, std::size_t height, unsigned seed, float least = 0,
              float most = 1) {
  Picture picture(width, height);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(least, most);
  for (float& value : picture.pixels) value = uniform(random);
  return picture;
}

std::vector<std::uint32_t> counts(const Picture& picture, std::uint32_t count) {
  return std::vector<std::uint32_t>(picture.width * picture.height, count);
}

/// Linear value whose display-encoded value is `encoded` of 255, above the linear part of sRGB.
float linear_of(double encoded) {
  return static_cast<float>(std::pow((encoded / 255 + 0.055) / 1.055, 2.4));
}

TEST(Metrics, RmseOfAKnownError) {
  // A quarter of the pixels is off by 0.5 in all channels: MSE 1/16.
  const Picture reference = noise(16, 16, 1);
  Picture picture = reference;
  for (std::size_t i = 0; i < picture.pixels.size() / 4; ++i) picture.pixels[i] += 0.5f;
  EXPECT_NEAR(quality::rmse(picture, reference), 0.25, 1e-7);
  EXPECT_EQ(quality::rmse(reference, reference), 0);
}

TEST(Metrics, RmseDoesNotClamp) {
  EXPECT_NEAR(quality::rmse(Picture(4, 4, 10000), Picture(4, 4, 1)), 9999, 1e-6);
}

TEST(Metrics, PsnrOfAKnownError) {
  // 20 of 255 apart everywhere: 20 log10(255 / 20).
  const Picture reference(16, 16, linear_of(100));
  const Picture picture(16, 16, linear_of(120));
  EXPECT_NEAR(quality::psnr(picture, reference), 20 * std::log10(255.0 / 20), 1e-4);
}

TEST(Metrics, PsnrUsesTheLinearPartOfTheEncoding) {
  // 12.92 * 255 * 0.001 apart.
  EXPECT_NEAR(quality::psnr(Picture(4, 4, 0.002f), Picture(4, 4, 0.001f)),
              -20 * std::log10(12.92 * 0.001), 1e-4);
}

TEST(Metrics, PsnrClampsToTheDisplay) {
  EXPECT_EQ(quality::psnr(Picture(4, 4, 7), Picture(4, 4, 1)),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(quality::psnr(Picture(4, 4, -3), Picture(4, 4, 0)),
            std::numeric_limits<double>::infinity());
  EXPECT_NEAR(quality::psnr(Picture(4, 4, 2), Picture(4, 4, -1)), 0, 1e-12);
}

TEST(Metrics, RelativeMseOfAKnownError) {
  EXPECT_NEAR(quality::relative_mse(Picture(4, 4, 0.49f), Picture(4, 4, 0.19f)), 2.25, 1e-6);
  // In the dark the constant rules.
  EXPECT_NEAR(quality::relative_mse(Picture(4, 4, 0.02f), Picture(4, 4, 0)), 4, 1e-6);
}

TEST(Metrics, SsimOfEqualPicturesIsOne) {
  const Picture picture = noise(40, 23, 2);
  EXPECT_NEAR(quality::ssim(picture, picture), 1, 1e-9);
}

TEST(Metrics, SsimOfTwoConstants) {
  // No variance: only the term of the means is left.
  const double a = 90;
  const double b = 150;
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(quality::ssim(Picture(20, 20, linear_of(a)), Picture(20, 20, linear_of(b))),
              (2 * a * b + c1) / (a * a + b * b + c1), 1e-5);
}

TEST(Metrics, SsimOfACheckerboardAndItsNegativeIsNegative) {
  Picture picture(32, 32);
  Picture negative(32, 32);
  for (std::size_t y = 0; y < 32; ++y) {
    for (std::size_t x = 0; x < 32; ++x) {
      picture.set(x, y, linear_of((x + y) % 2 == 0 ? 60 : 190));
      negative.set(x, y, linear_of((x + y) % 2 == 0 ? 190 : 60));
    }
  }
  EXPECT_LT(quality::ssim(picture, negative), -0.9);
}

/// By the definition: all 121 weights for each window, the variance from differences to the mean.
double slow_ssim(const Picture& picture, const Picture& reference) {
  const auto encoded_luma = [](const Picture& from, std::size_t pixel) {
    std::array<double, 3> encoded{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = std::fmin(std::fmax(double{from.pixels[3 * pixel + c]}, 0), 1);
      encoded[c] = 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
    }
    return 0.299 * encoded[0] + 0.587 * encoded[1] + 0.114 * encoded[2];
  };
  std::array<double, 121> weights{};
  double total = 0;
  for (int i = 0; i < 121; ++i) {
    const int dx = i % 11 - 5;
    const int dy = i / 11 - 5;
    total += weights[static_cast<std::size_t>(i)] = std::exp(-(dx * dx + dy * dy) / 4.5);
  }
  double sum = 0;
  double windows = 0;
  for (std::size_t y = 0; y + 11 <= picture.height; ++y) {
    for (std::size_t x = 0; x + 11 <= picture.width; ++x) {
      std::array<double, 121> a{}, b{};
      double mean_a = 0;
      double mean_b = 0;
      for (std::size_t i = 0; i < 121; ++i) {
        const std::size_t pixel = (y + i / 11) * picture.width + x + i % 11;
        a[i] = encoded_luma(picture, pixel);
        b[i] = encoded_luma(reference, pixel);
        mean_a += weights[i] / total * a[i];
        mean_b += weights[i] / total * b[i];
      }
      double var_a = 0;
      double var_b = 0;
      double covariance = 0;
      for (std::size_t i = 0; i < 121; ++i) {
        var_a += weights[i] / total * (a[i] - mean_a) * (a[i] - mean_a);
        var_b += weights[i] / total * (b[i] - mean_b) * (b[i] - mean_b);
        covariance += weights[i] / total * (a[i] - mean_a) * (b[i] - mean_b);
      }
      const double c1 = 2.55 * 2.55;
      const double c2 = 7.65 * 7.65;
      sum += (2 * mean_a * mean_b + c1) * (2 * covariance + c2) /
             ((mean_a * mean_a + mean_b * mean_b + c1) * (var_a + var_b + c2));
      windows += 1;
    }
  }
  return sum / windows;
}

TEST(Metrics, SsimAgreesWithTheDefinition) {
  for (const auto& [width, height] : {std::pair{11, 11}, {12, 30}, {33, 17}}) {
    const auto w = static_cast<std::size_t>(width);
    const auto h = static_cast<std::size_t>(height);
    const Picture reference = noise(w, h, 3);
    Picture picture = reference;
    const Picture error = noise(w, h, 4, -0.3f, 0.3f);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] += error.pixels[i];
    const double expected = slow_ssim(picture, reference);
    EXPECT_GT(expected, 0.1);
    EXPECT_LT(expected, 0.95);
    EXPECT_NEAR(quality::ssim(picture, reference), expected, 1e-9);
  }
}

TEST(Metrics, SsimNeedsAWindow) {
  EXPECT_THROW((void)quality::ssim(Picture(10, 20), Picture(10, 20)), std::invalid_argument);
  EXPECT_THROW((void)quality::ssim(Picture(20, 10), Picture(20, 10)), std::invalid_argument);
}

TEST(Metrics, BlockRmseOfPartialBlocks) {
  // 11 x 9 pixels: blocks of 8 x 8, 3 x 8, 8 x 1 and 3 x 1 pixels.
  Picture picture(11, 9);
  picture.set(7, 7, 0.8f);   // 1 of 64
  picture.set(8, 0, 0.6f);   // 1 of 24
  picture.set(0, 8, 0.4f);   // 1 of 8
  picture.set(10, 8, 0.3f);  // 1 of 3
  const std::vector<double> blocks = quality::block_rmse(picture, Picture(11, 9));
  ASSERT_EQ(blocks.size(), 4u);
  EXPECT_NEAR(blocks[0], 0.8 / 8, 1e-7);
  EXPECT_NEAR(blocks[1], 0.6 / std::sqrt(24.0), 1e-7);
  EXPECT_NEAR(blocks[2], 0.4 / std::sqrt(8.0), 1e-7);
  EXPECT_NEAR(blocks[3], 0.3 / std::sqrt(3.0), 1e-7);
  EXPECT_NEAR(quality::measure(Picture(16, 16, 0.5f), Picture(16, 16), counts(Picture(16, 16), 1))
                  .worst_block_rmse,
              0.5, 1e-7);
}

TEST(Metrics, ABlockIsMissedWhenItsErrorIsGreatAndItsSamplesAreFew) {
  // One of 64 blocks is wrong: its error is 8 times that of the picture.
  const Picture reference(64, 64);
  Picture picture = reference;
  for (std::size_t y = 16; y < 24; ++y) {
    for (std::size_t x = 40; x < 48; ++x) picture.set(x, y, 1);
  }
  std::vector<std::uint32_t> samples = counts(picture, 2);
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u) << "it got its share";
  samples[16 * 64 + 40] = 1;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 1u);
  samples[16 * 64 + 41] = 9;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u) << "it got more";
}

TEST(Metrics, ABlockWithAModerateErrorIsNotMissed) {
  // 4 of 64 blocks are wrong: their error is 4 times that of the picture.
  const Picture reference(64, 64);
  Picture picture = reference;
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 32; ++x) picture.set(x, y, 1);
  }
  std::vector<std::uint32_t> samples = counts(picture, 2);
  samples[0] = 0;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u);
}

TEST(Metrics, PartialBlocksAreMissedByTheirDensity) {
  // The last block has 8 of the usual 64 pixels and 8 samples: the average density.
  const Picture reference(65, 64);
  Picture picture = reference;
  for (std::size_t y = 56; y < 64; ++y) picture.set(64, y, 1);
  std::vector<std::uint32_t> samples = counts(picture, 1);
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 0u);
  samples[64 * 65 - 1] = 0;
  EXPECT_EQ(quality::missed_blocks(picture, reference, samples), 1u);
}

TEST(Metrics, WhiteNoiseHasNoSeam) {
  EXPECT_NEAR(quality::seam_visibility(noise(256, 256, 5), noise(256, 256, 6)), 1, 0.02);
}

TEST(Metrics, SeamOfBlocksWithConstantErrors) {
  // Errors of +-1 that alternate from block to block on noise of uniform 0..1 within: the mean
  // difference of two such values is 1/3, and across a border |2 + d| has mean 2.
  Picture picture = noise(256, 256, 7);
  for (std::size_t y = 0; y < 256; ++y) {
    for (std::size_t x = 0; x < 256; ++x) {
      const float offset = (x / 8 + y / 8) % 2 == 0 ? 1.0f : -1.0f;
      for (std::size_t c = 0; c < 3; ++c) picture.pixels[3 * (y * 256 + x) + c] += offset;
    }
  }
  EXPECT_NEAR(quality::seam_visibility(picture, Picture(256, 256)), 6, 0.1);
}

TEST(Metrics, SeamsShiftedByHalfABlockAreNotSeams) {
  // The same errors, but they jump within blocks.
  Picture picture = noise(256, 256, 8);
  for (std::size_t y = 0; y < 256; ++y) {
    for (std::size_t x = 0; x < 256; ++x) {
      const float offset = ((x + 4) / 8 + (y + 4) / 8) % 2 == 0 ? 1.0f : -1.0f;
      for (std::size_t c = 0; c < 3; ++c) picture.pixels[3 * (y * 256 + x) + c] += offset;
    }
  }
  EXPECT_LT(quality::seam_visibility(picture, Picture(256, 256)), 0.8);
}

TEST(Metrics, SeamOfDegenerateErrors) {
  const Picture reference = noise(32, 32, 9);
  EXPECT_EQ(quality::seam_visibility(reference, reference), 1);
  EXPECT_EQ(quality::seam_visibility(noise(8, 8, 10), Picture(8, 8)), 1) << "one block";
  Picture steps(32, 8);
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 0; x < 32; ++x) steps.set(x, y, static_cast<float>(x / 8));
  }
  EXPECT_EQ(quality::seam_visibility(steps, Picture(32, 8)),
            std::numeric_limits<double>::infinity());
}

TEST(Metrics, MeasureGivesTheSameAsItsParts) {
  const Picture reference = noise(48, 32, 11);
  const Picture picture = noise(48, 32, 12);
  std::vector<std::uint32_t> samples = counts(picture, 1);
  const quality::Metrics metrics = quality::measure(picture, reference, samples);
  EXPECT_EQ(metrics.rmse, quality::rmse(picture, reference));
  EXPECT_EQ(metrics.psnr, quality::psnr(picture, reference));
  EXPECT_EQ(metrics.relative_mse, quality::relative_mse(picture, reference));
  EXPECT_EQ(metrics.ssim, quality::ssim(picture, reference));
  EXPECT_EQ(metrics.seam, quality::seam_visibility(picture, reference));
  EXPECT_EQ(metrics.bad_values, 0);
}

TEST(Metrics, ValuesThatAreNotFiniteAreCountedAndTakenForZero) {
  const Picture reference = noise(16, 16, 13);
  Picture picture = reference;
  Picture zeroed = reference;
  picture.pixels[5] = std::numeric_limits<float>::quiet_NaN();
  picture.pixels[700] = -std::numeric_limits<float>::infinity();
  zeroed.pixels[5] = zeroed.pixels[700] = 0;
  const quality::Metrics metrics = quality::measure(picture, reference, counts(picture, 1));
  EXPECT_EQ(metrics.bad_values, 2);
  EXPECT_EQ(metrics.rmse, quality::rmse(zeroed, reference));
  EXPECT_THROW((void)quality::measure(reference, picture, counts(picture, 1)),
               std::invalid_argument);
}

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Metrics, RefusesPicturesThatDoNotMatch) {
  const Picture picture(16, 24);
  const Picture other(24, 16);
  const std::string said = message_of([&] { (void)quality::rmse(picture, other); });
  EXPECT_NE(said.find("16 x 24"), std::string::npos) << said;
  EXPECT_NE(said.find("24 x 16"), std::string::npos) << said;
  EXPECT_THROW((void)quality::psnr(picture, other), std::invalid_argument);
  EXPECT_THROW((void)quality::relative_mse(picture, other), std::invalid_argument);
  EXPECT_THROW((void)quality::ssim(picture, other), std::invalid_argument);
  EXPECT_THROW((void)quality::block_rmse(picture, other), std::invalid_argument);
  EXPECT_THROW((void)quality::seam_visibility(picture, other), std::invalid_argument);
  EXPECT_THROW((void)quality::measure(picture, other, counts(picture, 1)), std::invalid_argument);
  EXPECT_THROW((void)quality::rmse(Picture(0, 0), Picture(0, 0)), std::invalid_argument);

  Picture incomplete = picture;
  incomplete.pixels.pop_back();
  EXPECT_THROW((void)quality::rmse(incomplete, picture), std::invalid_argument);
  EXPECT_THROW((void)quality::rmse(picture, incomplete), std::invalid_argument);
  const std::vector<std::uint32_t> few(5);
  EXPECT_NE(
      message_of([&] { (void)quality::missed_blocks(picture, picture, few); }).find("5 counts"),
      std::string::npos);
}

}  // namespace
