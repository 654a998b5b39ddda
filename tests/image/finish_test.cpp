// SPDX-License-Identifier: MIT
// Finished pictures in the caller's memory and on any executor: always the same bits.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::picture;

/// The last task first; as many threads as it says at once never are.
struct Backwards {
  std::size_t threads = 5;

  void execute(std::size_t count, TaskRef task) const {
    for (std::size_t i = count; i > 0; --i) task(i - 1);
  }
  [[nodiscard]] std::size_t concurrency() const { return threads; }
};

/// Runs every other task only.
struct Lazy {
  static void execute(std::size_t count, TaskRef task) {
    for (std::size_t i = 1; i < count; i += 2) task(i);
  }
  static std::size_t concurrency() { return 4; }
};

/// Fails after its first task.
struct Failing {
  static void execute(std::size_t, TaskRef task) {
    task(0);
    throw std::runtime_error("no more threads");
  }
  static std::size_t concurrency() { return 3; }
};

double random_of(const Request& request) {
  return static_cast<double>(detail::mix_bits(request.id + 7) >> 11) * 0x1p-53;
}

/// Engines of every kind that is finished in another way.
struct Case {
  const char* name;
  SynthesisSettings settings;
  double samples_per_pixel;
  std::array<float, 4> (*sampler)(const Request&);

  friend void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }
};

std::array<float, 4> smooth_and_edges(const Request& request) {
  const float p = picture(request.x, request.y);
  return {p, 1 - p, p * p, 3 * p};
}
std::array<float, 4> with_noise(const Request& request) {
  const float p = picture(request.x, request.y);
  const auto noise = static_cast<float>(2 * random_of(request));
  return {p * noise, (2 - p) * noise, p, 1 - p};
}
std::array<float, 4> with_gaps(const Request& request) {
  auto values = smooth_and_edges(request);
  if (random_of(request) < 0.05) values[1] = std::numeric_limits<float>::quiet_NaN();
  values[0] -= 1;  // below zero
  return values;
}
std::array<float, 4> flat_in_pixels(const Request& request) {
  const auto x = static_cast<unsigned>(request.pixel % 130 * 7 + request.pixel / 130 * 3);
  return {static_cast<float>(x % 5), static_cast<float>(x % 3), 1, 0};
}

std::vector<Case> cases() {
  const auto settings = [](std::size_t width, std::size_t height) {
    SynthesisSettings one = helpers::settings_of(width, height, 4);
    one.noise = Noise::none;
    return one;
  };
  std::vector<Case> all = {{"smooth", settings(213, 205), 1.5, smooth_and_edges},
                           {"few", settings(400, 200), 0.1, smooth_and_edges},
                           {"many", settings(48, 40), 20, smooth_and_edges},
                           {"gaps", settings(130, 77), 2, with_gaps},
                           {"flat", settings(130, 64), 6, flat_in_pixels},
                           {"noise", settings(217, 203), 2, with_noise},
                           {"narrow", settings(3, 500), 2, smooth_and_edges},
                           {"part", settings(300, 200), 2, smooth_and_edges}};
  all.back().settings.window = {.x = 37, .y = 22, .width = 210, .height = 100};
  all[5].settings.noise = Noise::present;
  using Role = ChannelRole;
  all[5].settings.channel_settings = {{}, {}, {.role = Role::feature}, {.role = Role::passive}};
  return all;
}

std::vector<float> pixels_of(const Synthesizer& engine, const FinishSettings& settings,
                             std::size_t width, std::size_t height) {
  std::vector<float> pixels(width * height * engine.channels());
  reconstruct(engine.finished_image(settings), {}, {pixels.data(), width, height});
  return pixels;
}

class FinishOf : public testing::TestWithParam<Case> {};

TEST_P(FinishOf, WritesWhatReconstructionMakesAndNoExecutorMatters) {
  ThreadPool two(2), three(3), seven(7);
  const Case& one = GetParam();
  Synthesizer engine(one.settings);
  engine.run(one.sampler, helpers::at_samples_per_pixel(one.samples_per_pixel));
  const std::size_t width = engine.window().width, height = engine.window().height;
  for (const bool residuals : {true, false}) {
    FinishSettings settings;
    settings.residuals = residuals;
    const FrequencyImage expected_image = engine.finished_image(settings);
    const FrequencyImage fit = engine.image();
    const auto expect_images = [&](auto&& executor, const char* name) {
      EXPECT_TRUE(helpers::same_image(engine.finished_image(settings, executor), expected_image))
          << "on " << name;
      EXPECT_TRUE(helpers::same_image(engine.image(executor), fit)) << "on " << name;
    };
    expect_images(two, "two");
    expect_images(three, "three");
    expect_images(seven, "seven");
    expect_images(Backwards{}, "backwards");
    expect_images(Lazy{}, "lazy");

    struct Size {
      std::size_t width, height;
    };
    // Among them those of which a pixel lies in several blocks.
    for (const Size size : {Size{width, height}, Size{2 * width, 2 * height},
                            Size{(width + 1) / 2, (height + 1) / 2}, Size{71, 3}}) {
      const std::size_t w = size.width, h = size.height;
      const std::vector<float> expected = pixels_of(engine, settings, w, h);
      const auto expect_pixels = [&](auto&& write, const char* name) {
        std::vector<float> pixels(expected.size(), -7);
        write(PixelView{pixels.data(), w, h});
        EXPECT_EQ(pixels, expected) << "at " << w << " x " << h << ": " << name;
      };
      const auto finish = [&](const PixelView& view) { engine.finish(view, settings); };
      expect_pixels(finish, "no executor");
      const auto finish_on = [&](auto& executor, const char* name) {
        const auto both = [&](const PixelView& view) { engine.finish(view, settings, executor); };
        expect_pixels(both, name);
        expect_pixels(
            [&](const PixelView& view) { reconstruct(expected_image, {}, view, executor); }, name);
      };
      Backwards backwards;
      Lazy lazy;
      finish_on(three, "three");
      finish_on(backwards, "backwards");
      finish_on(lazy, "lazy");
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Pictures, FinishOf, testing::ValuesIn(cases()),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Finish, KeepsToTheStridesOfTheView) {
  Synthesizer engine(helpers::settings_of(50, 43, 3));
  engine.run(
      [](double x, double y) {
        return std::array{picture(x, y), 1.0f, picture(y, x)};
      },
      helpers::at_samples_per_pixel(2));
  const std::vector<float> packed = pixels_of(engine, {}, 50, 43);
  // Four floats a pixel, rows upside down.
  std::vector<float> pixels(50 * 43 * 4, -1);
  engine.finish({pixels.data() + 42 * 200, 50, 43, 4, -200, 1});
  for (std::size_t y = 0; y < 43; ++y) {
    for (std::size_t x = 0; x < 50; ++x) {
      const float* pixel = &pixels[((42 - y) * 50 + x) * 4];
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(pixel[c], packed[(y * 50 + x) * 3 + c]);
      ASSERT_EQ(pixel[3], -1);
    }
  }
}

TEST(Finish, RefusesWhatReconstructionRefuses) {
  Synthesizer engine(helpers::settings_of(16, 16));
  std::vector<float> pixels(256, 5);
  EXPECT_THROW(engine.finish({nullptr, 16, 16}), std::invalid_argument);
  EXPECT_THROW(engine.finish({pixels.data(), 16, 16, 3, 3, 1}), std::invalid_argument);
  EXPECT_THROW(engine.finish({pixels.data(), 16, 16}, {.doubt = -1}), std::invalid_argument);
  EXPECT_THROW(engine.finish({pixels.data(), 0, 0}, {.doubt = -1}), std::invalid_argument);
  EXPECT_EQ(pixels, std::vector<float>(256, 5));
  engine.finish({nullptr, 0, 0});
  // Before the first sample all is zero.
  engine.finish({pixels.data(), 16, 16});
  EXPECT_EQ(pixels, std::vector<float>(256));
  Synthesizer empty(helpers::settings_of(0, 16));
  empty.finish({pixels.data(), 4, 4});
}

TEST(Finish, ThrowsWhatTheExecutorThrowsAndCanBeCalledAgain) {
  Synthesizer engine(helpers::settings_of(300, 300, 1));
  engine.run([](double x, double y) { return picture(x, y); }, helpers::at_samples(40000));
  std::vector<float> pixels(300 * 300);
  EXPECT_THROW(engine.finish({pixels.data(), 300, 300}, {}, Failing{}), std::runtime_error);
  EXPECT_THROW(static_cast<void>(engine.finished_image({}, Failing{})), std::runtime_error);
  EXPECT_THROW(static_cast<void>(engine.image(Failing{})), std::runtime_error);
  engine.run([](double x, double y) { return picture(x, y); }, helpers::at_samples(50000));
  engine.finish({pixels.data(), 300, 300});
  EXPECT_EQ(pixels, pixels_of(engine, {}, 300, 300));
}

/// Pixels of a preview that another thread's samples overtake are those of one moment.
TEST(Finish, WhileAnotherThreadDelivers) {
  const SynthesisSettings settings = helpers::settings_of(250, 250, 1);
  const auto scene = [](double x, double y) { return picture(x, y); };
  Synthesizer engine(settings);
  engine.run(scene, helpers::at_samples(20000));
  std::vector<float> pixels(250 * 250);
  struct Interrupting {
    Synthesizer& engine;
    const decltype(scene)& sampler;
    void execute(std::size_t count, TaskRef task) const {
      // In the middle of the preview many waves come.
      std::atomic<bool> first = true;
      const auto run = [&](std::size_t i) {
        if (first.exchange(false)) engine.run(sampler, helpers::at_samples(60000));
        task(i);
      };
      for (std::size_t i = 0; i < count; ++i) run(i);
    }
    static std::size_t concurrency() { return 2; }
  };
  const std::vector<float> before = pixels_of(engine, {}, 250, 250);
  engine.finish({pixels.data(), 250, 250}, {}, Interrupting{engine, scene});
  EXPECT_EQ(pixels, before);
  EXPECT_EQ(engine.stats().samples, 60000u);
  engine.finish({pixels.data(), 250, 250});
  EXPECT_NE(pixels, before);
}

}  // namespace
}  // namespace freqsynth
