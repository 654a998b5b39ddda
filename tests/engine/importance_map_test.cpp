// SPDX-License-Identifier: MIT
// Importance of blocks: made of functions and images, and changed on the way.

#include "freqsynth/engine/importance_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples_per_pixel;
using helpers::counts_of;
using helpers::picture;
using helpers::settings_of;
using testing::Each;
using testing::ElementsAre;
using testing::FloatEq;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ImportanceMap, IsTheMeanOfAFunctionOverEachBlock) {
  // Blocks of 8 x 8, 3 x 8, 8 x 2 and 3 x 2 pixels: means of x and y are their centres.
  EXPECT_THAT(importance_map(11, 10, [](double x, double) { return x; }),
              ElementsAre(FloatEq(4), FloatEq(9.5), FloatEq(4), FloatEq(9.5)));
  EXPECT_THAT(importance_map(11, 10, [](double, double y) { return static_cast<float>(y); }),
              ElementsAre(FloatEq(4), FloatEq(4), FloatEq(9), FloatEq(9)));
  EXPECT_TRUE(importance_map(0, 10, [](double, double) { return 1; }).empty());
}

TEST(ImportanceMap, IsTheMeanOfAnImageOverEachBlock) {
  // A value per pixel, which a function can say as well.
  std::vector<float> pixels;
  for (std::size_t y = 0; y < 10; ++y) {
    for (std::size_t x = 0; x < 11; ++x) pixels.push_back(static_cast<float>((x * x + 3 * y) % 7));
  }
  const auto by_function = importance_map(11, 10, [&](double x, double y) {
    return pixels[static_cast<std::size_t>(y) * 11 + static_cast<std::size_t>(x)];
  });
  const auto by_image = importance_map(11, 10, pixels, 11, 10);
  ASSERT_EQ(by_image.size(), 4u);
  for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(by_image[b], by_function[b], 1e-5f);

  // Three cells over two blocks of 8 pixels: one and a half for each.
  const std::vector<float> three{1, 4, 10};
  EXPECT_THAT(importance_map(16, 8, three, 3, 1), ElementsAre(FloatEq(2), FloatEq(8)));
  EXPECT_THAT(importance_map(8, 16, three, 1, 3), ElementsAre(FloatEq(2), FloatEq(8)));
  // One cell over everything.
  EXPECT_THAT(importance_map(100, 30, std::vector<float>{5}, 1, 1), Each(FloatEq(5)));

  EXPECT_THAT([&] { (void)importance_map(8, 8, three, 2, 2); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 2 x 2 has 3 pixels")));
  EXPECT_THAT([&] { (void)importance_map(8, 8, {}, 0, 4); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 0 x 4 has 0 pixels")));
}

/// Samples that the left and the right half of the picture get from here to there.
struct Halves {
  std::uint64_t left = 0, right = 0;
};
Halves run_to(Synthesizer& engine, double samples) {
  Halves halves;
  engine.run(
      [&](double x, double y) {
        ++(x < 64 ? halves.left : halves.right);
        return picture(x, y) + (static_cast<int>(x * 13 + y * 7) % 5 > 2 ? 0.5 : 0.0);
      },
      at_samples_per_pixel(samples));
  return halves;
}

TEST(Importance, MovesSamplesFromTheNextWaveOn) {
  Synthesizer engine(settings_of(128, 64));
  run_to(engine, 1);
  const auto half = [](double in_left, double in_right) {
    return importance_map(128, 64, [=](double x, double) { return x < 64 ? in_left : in_right; });
  };
  engine.set_importance(half(100, 1));
  const Halves left = run_to(engine, 2);
  EXPECT_GT(left.left, 3 * left.right);
  engine.set_importance(half(1, 100));
  const Halves right = run_to(engine, 4);
  EXPECT_GT(right.right, 3 * right.left);
  // Nobody's: those blocks get what is shared across borders and no more.
  engine.set_importance(half(1, 0));
  const Halves only = run_to(engine, 5);
  EXPECT_LT(only.right, only.left / 20);
  // Empty: all alike again, so that the half that is behind catches up.
  engine.set_importance({});
  const Halves alike = run_to(engine, 6);
  EXPECT_GT(alike.left, 0u);
  EXPECT_GT(alike.right, 0u);
}

TEST(Importance, ThatIsSetAtOnceIsThatOfTheSettings) {
  SynthesisSettings settings = settings_of(50, 30);
  const auto map = importance_map(50, 30, [](double x, double y) { return 1 + x * y / 100; });
  Synthesizer later(settings);
  later.set_importance(map);
  settings.importance = map;
  Synthesizer first(settings);
  later.run(picture, at_samples_per_pixel(3));
  first.run(picture, at_samples_per_pixel(3));
  EXPECT_TRUE(helpers::same_image(later.image(), first.image()));
}

TEST(Importance, DoesNotTouchAWaveThatIsUnderWay) {
  const auto map = importance_map(50, 30, [](double x, double) { return x < 20 ? 1e5 : 1e-5; });
  // Set in the middle of a wave or before the next one is chosen: the same.
  const auto image_when = [&](bool in_the_middle) {
    Synthesizer engine(settings_of(50, 30, 1, 5));
    engine.run(picture, at_samples_per_pixel(1));
    engine.set_stop(at_samples_per_pixel(2));
    std::vector<Request> requests(64);
    requests.resize(engine.request(requests));
    if (in_the_middle) engine.set_importance(map);
    std::vector<float> values;
    for (const Request& r : requests) values.push_back(picture(r.x, r.y));
    engine.deliver(requests, values);
    if (!in_the_middle) engine.set_importance(map);
    engine.run(picture, at_samples_per_pixel(2));
    return engine.image();
  };
  EXPECT_TRUE(helpers::same_image(image_when(true), image_when(false)));
}

TEST(Importance, IsRefusedAsThatOfTheSettings) {
  Synthesizer engine(settings_of(16, 8));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT([&] { engine.set_importance(std::vector<float>{1}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("1 entries for 2 blocks")));
  EXPECT_THAT(
      [&] {
        engine.set_importance(std::vector<float>{1, -2});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one of importance is -2")));
  EXPECT_THAT(
      [&] {
        engine.set_importance(std::vector<float>{1e-7f, 1});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one of importance is 1.00000001e-07")));
  EXPECT_THAT(
      [&] {
        engine.set_importance(std::vector<float>{nan, 1});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("one of importance is nan")));
  EXPECT_THAT(counts_of(engine.image()), Each(0u));
}

}  // namespace
}  // namespace freqsynth
