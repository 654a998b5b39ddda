// SPDX-License-Identifier: MIT
// Parts of a picture, made on the grid of the whole.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples_per_pixel;
using helpers::picture;
using helpers::settings_of;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// What is told of a sample that does not depend on the others.
struct Identity {
  double x, y;
  std::uint64_t seed, pixel;

  friend bool operator==(const Identity&, const Identity&) = default;
};

std::map<std::uint64_t, Identity> identities_of(const SynthesisSettings& settings, double samples) {
  std::map<std::uint64_t, Identity> all;
  Synthesizer engine(settings);
  engine.run(
      [&](const Request& r) {
        all[r.id] = {r.x, r.y, r.seed, r.pixel};
        return picture(r.x, r.y);
      },
      at_samples_per_pixel(samples));
  return all;
}

TEST(Window, CoversTheBlocksThatItHasPixelsOf) {
  struct Case {
    PixelWindow asked, shown;
  };
  // Of 100 x 60 pixels: the last column of blocks is 4 pixels wide, the last row 4 high.
  for (const Case& one : {Case{{0, 0, 1, 1}, {0, 0, 8, 8}}, Case{{8, 16, 8, 8}, {8, 16, 8, 8}},
                          Case{{7, 15, 2, 2}, {0, 8, 16, 16}}, Case{{97, 58, 2, 1}, {96, 56, 4, 4}},
                          Case{{40, 0, 60, 60}, {40, 0, 60, 60}}, Case{{}, {0, 0, 100, 60}},
                          Case{{1, 1, 98, 58}, {0, 0, 100, 60}}}) {
    SynthesisSettings settings = settings_of(100, 60);
    settings.window = one.asked;
    const Synthesizer engine(settings);
    const PixelWindow window = engine.window();
    EXPECT_EQ(window.x, one.shown.x);
    EXPECT_EQ(window.y, one.shown.y);
    EXPECT_EQ(window.width, one.shown.width);
    EXPECT_EQ(window.height, one.shown.height);
    EXPECT_EQ(engine.image().width(), one.shown.width);
    EXPECT_EQ(engine.finished_image().height(), one.shown.height);
  }
}

TEST(Window, IsRefusedWhereThereAreNoSuchPixels) {
  constexpr std::size_t most = static_cast<std::size_t>(-1);
  for (const PixelWindow& window :
       {PixelWindow{0, 0, 101, 1}, PixelWindow{0, 0, 1, 61}, PixelWindow{100, 0, 1, 1},
        PixelWindow{5, 5, 0, 3}, PixelWindow{5, 5, 3, 0}, PixelWindow{1, 0, 0, 0},
        PixelWindow{most, 0, 2, 1}, PixelWindow{2, 2, most, 1}}) {
    SynthesisSettings settings = settings_of(100, 60);
    settings.window = window;
    const std::string value = "window is " + std::to_string(window.width) + " x " +
                              std::to_string(window.height) + " pixels at (" +
                              std::to_string(window.x);
    EXPECT_THAT([&] { Synthesizer engine(settings); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(value)));
  }
}

TEST(Window, AsksForPointsOfTheWholePicture) {
  SynthesisSettings settings = settings_of(100, 60, 1, 13 * 8);
  settings.seed = 7;
  settings.max_samples_per_block = 81;
  const auto whole = identities_of(settings, 100);
  for (const PixelWindow& window :
       {PixelWindow{33, 20, 9, 7}, PixelWindow{90, 50, 10, 10}, PixelWindow{0, 0, 20, 60}}) {
    settings.window = window;
    const auto part = identities_of(settings, 100);
    ASSERT_FALSE(part.empty());
    std::size_t found = 0;
    for (const auto& [id, identity] : part) {
      if ((id >> 63) != 0) continue;  // asked again: of each picture other ones
      const auto same = whole.find(id);
      ASSERT_NE(same, whole.end()) << identity.x << ' ' << identity.y;
      EXPECT_EQ(identity, same->second);
      // The window, two blocks around it, and what it takes to make the blocks whole.
      EXPECT_GE(identity.x, static_cast<double>(window.x) - 24);
      EXPECT_LE(identity.x, static_cast<double>(window.x + window.width) + 24);
      ++found;
    }
    EXPECT_GT(found, 81u);
  }
}

TEST(Window, HoldsAsGoodAPictureAsTheWhole) {
  SynthesisSettings settings = settings_of(100, 60);
  settings.window = {40, 16, 32, 24};
  Synthesizer engine(settings);
  engine.run(picture, at_samples_per_pixel(2));
  const std::vector<float> pixels = reconstruct(engine.finished_image());
  const double error =
      helpers::rmse_of(pixels, 32, [](double x, double y) { return picture(x + 40, y + 16); });
  settings.window = {};
  Synthesizer whole(settings);
  whole.run(picture, at_samples_per_pixel(2));
  const std::vector<float> all = reconstruct(whole.finished_image());
  std::vector<float> cut;
  for (std::size_t y = 16; y < 40; ++y) {
    for (std::size_t x = 40; x < 72; ++x) cut.push_back(all[y * 100 + x]);
  }
  const double of_whole =
      helpers::rmse_of(cut, 32, [](double x, double y) { return picture(x + 40, y + 16); });
  EXPECT_LT(error, 1.25 * of_whole);
  EXPECT_GT(of_whole, 0);
}

/// Pixels of a part of a picture whose pixels are `all`.
std::vector<float> cut(const std::vector<float>& all, std::size_t width, const PixelWindow& part) {
  std::vector<float> pixels;
  for (std::size_t y = part.y; y < part.y + part.height; ++y) {
    for (std::size_t x = part.x; x < part.x + part.width; ++x) pixels.push_back(all[y * width + x]);
  }
  return pixels;
}

TEST(Window, HasThePixelsOfTheWholePictureToTheBitUnderUniformSampling) {
  for (const std::size_t samples : {25u, 81u, 100u}) {
    SynthesisSettings settings = settings_of(100, 60);
    settings.max_samples_per_block = samples;
    settings.least_samples_per_block = samples;
    Synthesizer whole(settings);
    EXPECT_EQ(whole.run(picture, {}).reason, StopReason::exhausted);
    const std::vector<float> fit = reconstruct(whole.image());
    const std::vector<float> finished = reconstruct(whole.finished_image());
    for (const PixelWindow& window : {PixelWindow{33, 20, 19, 7}, PixelWindow{80, 40, 20, 20},
                                      PixelWindow{0, 0, 8, 60}, PixelWindow{40, 24, 8, 8}}) {
      settings.window = window;
      Synthesizer part(settings);
      EXPECT_EQ(part.run(picture, {}).reason, StopReason::exhausted);
      EXPECT_EQ(reconstruct(part.image()), cut(fit, 100, part.window()));
      EXPECT_EQ(reconstruct(part.finished_image()), cut(finished, 100, part.window()));
      EXPECT_LT(part.stats().samples, whole.stats().samples);
    }
    settings.window = {};
  }
}

TEST(Window, HasTheOwnValuesOfItsPixels) {
  SynthesisSettings settings = settings_of(60, 44, 3);
  settings.channel_settings = {{}, {ChannelRole::nearest}, {ChannelRole::mean}};
  settings.window = {17, 9, 20, 35};
  Synthesizer engine(settings);
  engine.run(
      [](double x, double y) {
        return std::array<double, 3>{1, std::floor(x) + 100 * std::floor(y), x + 100 * y};
      },
      at_samples_per_pixel(8));
  const PixelWindow window = engine.window();
  const std::vector<float> ids = engine.channel_pixels(1);
  ASSERT_EQ(ids.size(), window.width * window.height);
  const std::vector<float> means = engine.channel_pixels(2);
  ASSERT_EQ(means.size(), window.width * window.height);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::size_t x = window.x + i % window.width, y = window.y + i / window.width;
    EXPECT_EQ(ids[i], static_cast<float>(x + 100 * y)) << x << ' ' << y;
    // Means of some samples within the pixel: no farther from its centre's.
    const double middle = static_cast<double>(x) + 0.5 + 100 * (static_cast<double>(y) + 0.5);
    EXPECT_NEAR(double{means[i]}, middle, 50.5) << x << ' ' << y;
  }
}

TEST(Window, IsThatPartOfAFrequencyImage) {
  Synthesizer engine(settings_of(37, 21));
  engine.run(picture, at_samples_per_pixel(1));
  const FrequencyImage image = engine.finished_image();
  const FrequencyImage part = image.part({9, 8, 28, 13});
  const std::vector<float> all = reconstruct(image), some = reconstruct(part);
  ASSERT_EQ(part.width(), 29u);
  ASSERT_EQ(part.height(), 13u);
  EXPECT_EQ(part.meaning(), image.meaning());
  for (std::size_t y = 0; y < 13; ++y) {
    for (std::size_t x = 0; x < 29; ++x) EXPECT_EQ(some[29 * y + x], all[37 * (y + 8) + x + 8]);
  }
  EXPECT_THAT(
      [&] {
        (void)image.part({30, 0, 8, 1});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("window is 8 x 1 pixels at (30, 0)")));
}

}  // namespace
}  // namespace freqsynth
