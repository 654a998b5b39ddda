// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/image/reconstructor.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::size_t width = 20, height = 13, channels = 3;
constexpr float untouched = -12345;

FrequencyImage usual_image() {
  oracle::Random random(5);
  FrequencyImage image(width, height, channels);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      image.samples(x, y) = 100;
      for (std::size_t c = 0; c < channels; ++c) {
        for (float& value : image.coefficients(x, y, c)) value = random.value();
      }
    }
  }
  return image;
}

struct Layout {
  const char* name;
  std::size_t memory;  // floats
  std::size_t first;   // of the pixel in the top left corner
  std::ptrdiff_t pixel_stride, row_stride, channel_stride;
};

class MemoryLayout : public testing::TestWithParam<Layout> {};
INSTANTIATE_TEST_SUITE_P(Layouts, MemoryLayout,
                         testing::Values(Layout{"interleaved", 780, 0, 3, 60, 1},
                                         Layout{"planar", 780, 0, 1, 20, 260},
                                         Layout{"paddedRows", 70 * 13, 0, 3, 70, 1},
                                         Layout{"paddedPixels", 80 * 13, 0, 4, 80, 1},
                                         Layout{"upsideDown", 780, 12 * 60, 3, -60, 1},
                                         Layout{"mirrored", 780, 19 * 3, -3, 60, 1},
                                         Layout{"reversedChannels", 780, 2, 3, 60, -1},
                                         Layout{"columnMajor", 780, 0, 39, 3, 1}),
                         [](const auto& layout) { return std::string(layout.param.name); });

TEST_P(MemoryLayout, HoldsTheSamePixelsAndNothingElseIsTouched) {
  const Layout& layout = GetParam();
  const FrequencyImage image = usual_image();
  for (const PixelFilter filter : {PixelFilter::none, PixelFilter::box}) {
    ReconstructionSettings settings;
    settings.pixel_filter = filter;
    const auto expected = reconstruct(image, settings);
    // A margin on both sides catches writes beyond the ends.
    constexpr std::size_t margin = 100;
    std::vector<float> memory(layout.memory + 2 * margin, untouched);
    reconstruct(image, settings,
                {memory.data() + margin + layout.first, width, height, layout.pixel_stride,
                 layout.row_stride, layout.channel_stride});
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        for (std::size_t c = 0; c < channels; ++c) {
          const std::ptrdiff_t place = static_cast<std::ptrdiff_t>(margin + layout.first) +
                                       static_cast<std::ptrdiff_t>(x) * layout.pixel_stride +
                                       static_cast<std::ptrdiff_t>(y) * layout.row_stride +
                                       static_cast<std::ptrdiff_t>(c) * layout.channel_stride;
          float& value = memory.at(static_cast<std::size_t>(place));
          ASSERT_EQ(value, expected[(y * width + x) * channels + c]);
          value = untouched;
        }
      }
    }
    EXPECT_EQ(std::count(memory.begin(), memory.end(), untouched),
              static_cast<std::ptrdiff_t>(memory.size()));
  }
}

TEST(ReconstructorMemory, OldContentsDoNotMatter) {
  const FrequencyImage image = usual_image();
  for (const auto& [out_width, out_height] : {std::pair{20, 13}, {7, 5}, {2, 1}, {61, 30}}) {
    const auto w = static_cast<std::size_t>(out_width), h = static_cast<std::size_t>(out_height);
    std::vector<float> clean(w * h * channels), dirty(w * h * channels, 1e30f);
    const auto pixel_stride = static_cast<std::ptrdiff_t>(channels);
    const auto row_stride = static_cast<std::ptrdiff_t>(w * channels);
    reconstruct(image, {}, {clean.data(), w, h, pixel_stride, row_stride});
    reconstruct(image, {}, {dirty.data(), w, h, pixel_stride, row_stride});
    EXPECT_EQ(clean, dirty);
  }
}

TEST(ReconstructorMemory, WidthAndHeightMayScaleDifferently) {
  // Columns halved, rows doubled: means of pairs, values shared with the twofold image.
  const FrequencyImage image = usual_image();
  const auto fine = reconstruct(image, {}, 2);  // 40 x 26
  std::vector<float> out(10 * 26 * channels);
  reconstruct(image, {}, {out.data(), 10, 26, channels, 10 * channels});
  for (std::size_t y = 0; y < 26; ++y) {
    for (std::size_t x = 0; x < 10; ++x) {
      for (std::size_t c = 0; c < channels; ++c) {
        float mean = 0;
        for (std::size_t k = 0; k < 4; ++k) {
          mean += fine[(y * 40 + 4 * x + k) * channels + c] / 4;
        }
        // Of numbers about 1. Measured: 3.5 roundings.
        ASSERT_NEAR(out[(y * 10 + x) * channels + c], mean, 4.2 * oracle::float_rounding);
      }
    }
  }
}

TEST(ReconstructorMemory, ClampReplacesNegativeValuesOnly) {
  const FrequencyImage image = usual_image();
  ReconstructionSettings settings;
  auto expected = reconstruct(image, settings);
  EXPECT_LT(*std::min_element(expected.begin(), expected.end()), -0.1f);
  for (float& value : expected) value = std::max(value, 0.0f);
  settings.clamp_negative = true;
  EXPECT_EQ(reconstruct(image, settings), expected);
}

TEST(ReconstructorMemory, ChannelsWithoutNegativeValuesAreClampedAlone) {
  FrequencyImage image = usual_image();
  auto expected = reconstruct(image);
  image.set_non_negative(1, true);
  std::size_t changed = 0;
  for (std::size_t i = 1; i < expected.size(); i += channels) {
    changed += expected[i] < 0 ? 1 : 0;
    expected[i] = std::max(expected[i], 0.0f);
  }
  EXPECT_GT(changed, 10u);
  EXPECT_EQ(reconstruct(image), expected);
  // And of values at points.
  std::array<float, channels> values, signed_values;
  float least = 0;
  for (double y = 0.5; y < height; ++y) {
    for (double x = 0.5; x < width; ++x) {
      evaluate(image, {}, x, y, values);
      evaluate(usual_image(), {}, x, y, signed_values);
      least = std::min(least, signed_values[1]);
      for (std::size_t c = 0; c < channels; ++c) {
        ASSERT_EQ(values[c], c == 1 ? std::max(signed_values[c], 0.0f) : signed_values[c]);
      }
    }
  }
  EXPECT_LT(least, -0.01f);
}

TEST(ReconstructorMemory, EmptyImagesAndOutputsAreLeftAlone) {
  const FrequencyImage empty(0, 5, channels);
  EXPECT_TRUE(reconstruct(empty).empty());
  EXPECT_TRUE(reconstruct(FrequencyImage()).empty());
  EXPECT_NO_THROW(reconstruct(usual_image(), {}, PixelView{}));
}

TEST(ReconstructorMemory, ScaledSizeIsRoundedUp) {
  EXPECT_EQ(scaled_size(20, 1), 20u);
  EXPECT_EQ(scaled_size(20, 0.5), 10u);
  EXPECT_EQ(scaled_size(21, 0.5), 11u);
  EXPECT_EQ(scaled_size(257, 1.0 / 16), 17u);
  EXPECT_EQ(scaled_size(10, 0.001), 1u);
  EXPECT_EQ(scaled_size(0, 7), 0u);
}

TEST(ReconstructorMemory, WrongArgumentsAreNamed) {
  const FrequencyImage image = usual_image();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double scale : {0.0, -1.5, nan, infinity}) {
    const std::string value = "is " + detail::to_text(scale) + ", not a finite number > 0";
    EXPECT_THAT([&] { static_cast<void>(reconstruct(image, {}, scale)); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("scale"), HasSubstr(value))));
  }
  EXPECT_THAT([&] { static_cast<void>(reconstruct(image, {}, 1e300)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("scale")));
  EXPECT_THROW(static_cast<void>(scaled_size(20, 1e18)), std::invalid_argument);

  ReconstructionSettings settings;
  settings.butterworth.cutoff = -2;
  EXPECT_THAT([&] { static_cast<void>(reconstruct(image, settings)); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("cutoff"), HasSubstr("-2"))));
  EXPECT_THAT(
      [&] {
        reconstruct(image, {}, {nullptr, 20, 13, 3, 60, 1});
      },
      ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("20"), HasSubstr("13"))));
}

TEST(ReconstructorMemory, EvaluateRefusesPointsOutside) {
  const FrequencyImage image = usual_image();
  std::array<float, channels> values;
  const auto refuses = [&](double x, double y) {
    EXPECT_THAT([&] { evaluate(image, {}, x, y, values); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr("(" + detail::to_text(x) + ", " + detail::to_text(y) + ")")));
  };
  refuses(-0.1, 1);
  refuses(20.1, 1);
  refuses(1, -0.1);
  refuses(1, 13.1);
  refuses(std::numeric_limits<double>::quiet_NaN(), 1);
  EXPECT_THROW(evaluate(FrequencyImage(0, 0, 3), {}, 0, 0, values), std::invalid_argument);
  EXPECT_THAT([&] { evaluate(image, {}, 1, 1, std::span(values).first(2)); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("2"), HasSubstr("3"))));
  ButterworthSettings wrong;
  wrong.order = 0;
  EXPECT_THROW(evaluate(image, wrong, 1, 1, values), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
