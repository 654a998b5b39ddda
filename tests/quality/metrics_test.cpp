// SPDX-License-Identifier: MIT
// The metrics of whole pictures against closed forms.

#include "quality/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "metric_helpers.h"

namespace {

using metric_helpers::counts;
using metric_helpers::linear_of;
using metric_helpers::noise;
using metric_helpers::Picture;

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

TEST(Metrics, RelmseOfAKnownError) {
  // 0.09 over 0.04 + 0.01; in the dark 0.0001 over 0.01.
  EXPECT_NEAR(quality::relmse(Picture(4, 4, 0.5f), Picture(4, 4, 0.2f)), 1.8, 1e-6);
  EXPECT_NEAR(quality::relmse(Picture(4, 4, 0.01f), Picture(4, 4, 0)), 0.01, 1e-8);
}

TEST(Metrics, MeanRatioTellsLightThatIsLost) {
  Picture reference(4, 4, 0.5f), picture(4, 4, 0.4f);
  picture.set(1, 1, 1.2f);  // a mean of 0.45
  EXPECT_NEAR(quality::mean_ratio(picture, reference), 0.9, 1e-7);
  EXPECT_EQ(quality::mean_ratio(reference, reference), 1);
  EXPECT_EQ(quality::mean_ratio(Picture(4, 4, 0), Picture(4, 4, 0)), 1);
}

TEST(Metrics, BorderStepOfAGradientIsOne) {
  Picture gradient(64, 48), squares(64, 48);
  for (std::size_t y = 0; y < 48; ++y) {
    for (std::size_t x = 0; x < 64; ++x) {
      // Even steps of display values; the same, with steps at borders three times as great.
      gradient.set(x, y, linear_of(static_cast<double>(20 + x + y)));
      squares.set(x, y, linear_of(static_cast<double>(20 + x + y + 2 * (x / 8) + 2 * (y / 8))));
    }
  }
  EXPECT_NEAR(quality::border_step(gradient), 1, 1e-4);
  EXPECT_NEAR(quality::border_step(squares), 3, 1e-3);
  EXPECT_EQ(quality::border_step(Picture(64, 48, 0.3f)), 1) << "no step at all";
  EXPECT_EQ(quality::border_step(noise(8, 8, 1)), 1) << "one block";
}

TEST(Metrics, NegativeShareCounts) {
  Picture picture(4, 4, 0);
  EXPECT_EQ(quality::negative_share(picture), 0) << "0 is not negative";
  picture.set(2, 1, -0.5f);
  picture.pixels[0] = -1e-9f;
  EXPECT_EQ(quality::negative_share(picture), 4.0 / 48);
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
  EXPECT_EQ(metrics.relmse, quality::relmse(picture, reference));
  EXPECT_EQ(metrics.mean_ratio, quality::mean_ratio(picture, reference));
  EXPECT_EQ(metrics.border_step, quality::border_step(picture));
  EXPECT_EQ(metrics.negative_share, quality::negative_share(picture));
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
