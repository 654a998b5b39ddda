// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "support/image_helpers.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Size {
  std::size_t width, height, channels;
};

constexpr Size sizes[] = {{16, 16, 1}, {16, 16, 3}, {20, 13, 3}, {1, 1, 3}, {1, 9, 3},
                          {9, 1, 3},   {1, 9, 1},   {2, 5, 2},   {3, 2, 5}};

/// Where channel c of pixel (x, y) lies.
std::ptrdiff_t place_of(const PixelView& view, std::size_t x, std::size_t y, std::size_t c) {
  return static_cast<std::ptrdiff_t>(x) * view.pixel_stride +
         static_cast<std::ptrdiff_t>(y) * view.row_stride +
         static_cast<std::ptrdiff_t>(c) * view.channel_stride;
}

TEST(PixelView, WithoutStridesFillsMemoryWithoutGaps) {
  for (const auto& [width, height, channels] : sizes) {
    const auto row = static_cast<std::ptrdiff_t>(width);
    const auto plane = static_cast<std::ptrdiff_t>(width * height);
    for (const std::ptrdiff_t channel_stride : {std::ptrdiff_t{1}, row, plane, -row, -plane}) {
      float memory = 0;
      const PixelView view =
          PixelView{&memory, width, height, 0, 0, channel_stride}.resolved(channels);
      EXPECT_EQ(view.channel_stride, channel_stride);
      EXPECT_GT(view.pixel_stride, 0);
      EXPECT_GT(view.row_stride, 0);
      std::set<std::ptrdiff_t> places;
      for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
          for (std::size_t c = 0; c < channels; ++c) places.insert(place_of(view, x, y, c));
        }
      }
      // All apart, and nothing between them.
      const std::size_t count = width * height * channels;
      ASSERT_EQ(places.size(), count) << width << height << channels << channel_stride;
      EXPECT_EQ(*places.rbegin() - *places.begin() + 1, static_cast<std::ptrdiff_t>(count))
          << width << " x " << height << " x " << channels << ", " << channel_stride;
    }
  }
}

TEST(PixelView, WithoutStridesIsRowByRowAndInterleaved) {
  for (const auto& [width, height, channels] : sizes) {
    const FrequencyImage image =
        helpers::random_image(width, height, channels, CoefficientMeaning::pixel_average, 8, 0.2f);
    std::vector<float> pixels(width * height * channels, -1000.0f);
    reconstruct(image, {}, {pixels.data(), width, height});
    EXPECT_EQ(pixels, reconstruct(image)) << width << " x " << height << " x " << channels;
  }
}

TEST(PixelView, WithoutStridesMayBePlanar) {
  for (const auto& [width, height, channels] : sizes) {
    const FrequencyImage image =
        helpers::random_image(width, height, channels, CoefficientMeaning::pixel_average, 8, 0.2f);
    const std::vector<float> expected = reconstruct(image);
    std::vector<float> planes(expected.size(), -1000.0f);
    reconstruct(image, {},
                {planes.data(), width, height, 0, 0, static_cast<std::ptrdiff_t>(width * height)});
    for (std::size_t i = 0; i < width * height; ++i) {
      for (std::size_t c = 0; c < channels; ++c) {
        ASSERT_EQ(planes[c * width * height + i], expected[i * channels + c]);
      }
    }
  }
}

TEST(PixelView, KeepsTheStridesThatAreGiven) {
  float memory = 0;
  const auto strides = [&](const PixelView& view, std::size_t channels) {
    const PixelView full = view.resolved(channels);
    return std::tuple(full.pixel_stride, full.row_stride, full.channel_stride);
  };
  // Rows with a margin; pixels with a margin, which rows then have too; bottom up; mirrored.
  EXPECT_EQ(strides({&memory, 20, 13, 0, 100, 1}, 3), std::tuple(3, 100, 1));
  EXPECT_EQ(strides({&memory, 20, 13, 4, 0, 1}, 3), std::tuple(4, 80, 1));
  EXPECT_EQ(strides({&memory, 20, 13, 0, -60, 1}, 3), std::tuple(3, -60, 1));
  EXPECT_EQ(strides({&memory, 20, 13, -3, 0, 1}, 3), std::tuple(-3, 60, 1));
  // Channels in opposite order, and one channel, whose stride says nothing.
  EXPECT_EQ(strides({&memory, 20, 13, 0, 0, -1}, 3), std::tuple(3, 60, -1));
  EXPECT_EQ(strides({&memory, 20, 13, 0, 0, 0}, 1), std::tuple(1, 20, 0));
}

TEST(PixelView, RefusesStridesThatShareMemory) {
  const FrequencyImage image(20, 13, 3);
  std::vector<float> memory(5000, 7.0f);
  const auto refuses = [&](std::ptrdiff_t pixel, std::ptrdiff_t row, std::ptrdiff_t channel,
                           const char* a, const char* b) {
    const PixelView view{memory.data() + 2000, 20, 13, pixel, row, channel};
    EXPECT_THAT([&] { reconstruct(image, {}, view); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(a), HasSubstr(b))));
  };
  refuses(3, 60, 0, "channel_stride is 0", "");
  refuses(1, 60, 1, "channel_stride is 1", "pixel_stride 1");
  refuses(1, 60, -1, "channel_stride is -1", "pixel_stride 1");
  refuses(3, 3, 1, "pixel_stride is 3", "row_stride 3");
  refuses(1, 20, 20, "channel_stride is 20", "row_stride 20");
  EXPECT_THAT(memory, Each(7.0f));
  // Where there is but one of a kind, its stride does not matter.
  const FrequencyImage line(20, 1, 1);
  EXPECT_NO_THROW(reconstruct(line, {}, {memory.data(), 20, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace freqsynth
