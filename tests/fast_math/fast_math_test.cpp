// SPDX-License-Identifier: MIT
// A caller that was told that there are finite numbers only, as renderers like to be: bad samples
// are seen all the same.

#if !defined(__FAST_MATH__)
#error "to be compiled with -ffast-math"
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

// From bits that the compiler cannot see through.
float from_bits(std::uint32_t bits) {
  volatile std::uint32_t hidden = bits;
  return std::bit_cast<float>(static_cast<std::uint32_t>(hidden));
}
const float nan = from_bits(0x7fc00000u);
const float infinity = from_bits(0x7f800000u);

bool finite(float value) { return (std::bit_cast<std::uint32_t>(value) >> 23 & 0xffu) != 0xffu; }

TEST(FastMath, UsableSamplesAreTold) {
  for (const float bad : {nan, infinity, -infinity, -nan, from_bits(0x7f800001u), 2e36f, -1e38f}) {
    EXPECT_FALSE(is_usable_sample(bad));
  }
  for (const float good : {0.0f, -1.0f, 1e35f, -1e35f, 1e-40f}) EXPECT_TRUE(is_usable_sample(good));
}

TEST(FastMath, BadSamplesAreCountedAndSurvived) {
  for (const float bad : {nan, infinity, -infinity, 3e36f}) {
    Synthesizer engine({.width = 40, .height = 32, .channels = 2});
    std::size_t given = 0;
    const auto sampler = [&](const Request& request) {
      const bool is_bad = std::fmod(7 * request.x + 3 * request.y, 5) < 1;
      given += is_bad && !request.again ? 1 : 0;
      const auto x = static_cast<float>(request.x);
      return std::array{0.01f * x, is_bad ? bad : 0.5f};
    };
    EXPECT_EQ(engine.run(sampler, {.samples = 1000}).reason, StopReason::samples);
    EXPECT_GT(given, 100u);
    EXPECT_EQ(engine.stats().bad_samples, given);
    const std::vector<float> pixels = reconstruct(engine.finished_image());
    EXPECT_TRUE(std::all_of(pixels.begin(), pixels.end(), finite));
    for (std::size_t i = 1; i < pixels.size(); i += 2) ASSERT_NEAR(pixels[i], 0.5f, 1e-3f) << i;
  }
}

TEST(FastMath, ChannelWithoutAUsableValueIsZero) {
  Synthesizer engine({.width = 16, .height = 16, .channels = 2});
  engine.run(
      [](double x, double) {
        return std::array{static_cast<float>(x), nan};
      },
      {.samples = 200});
  const FrequencyImage image = engine.image();
  for (std::size_t i = 0; i < max_terms; ++i) EXPECT_EQ(image.coefficients(1, 1, 1)[i], 0);
  EXPECT_NEAR(image.coefficients(0, 0, 0)[0], 8 * 4, 0.5);
}

TEST(FastMath, BatchSamplerThatForgetsIsNoticed) {
  Synthesizer engine({.width = 40, .height = 32, .channels = 1, .wave = 20});
  // Where a point was asked for twice, one value will do.
  std::set<std::pair<double, double>> written;
  const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (i % 4 == 3) continue;
      values[i] = static_cast<float>(requests[i].x);
      written.insert({requests[i].x, requests[i].y});
    }
  };
  engine.run(sampler, {.samples = 800});
  EXPECT_LT(written.size(), 700u);
  EXPECT_EQ(engine.stats().bad_samples, 800 - written.size());
}

TEST(FastMath, WrongSettingsAreRefused) {
  const auto refuses = [](const SynthesisSettings& settings) {
    EXPECT_THROW(Synthesizer{settings}, std::invalid_argument);
  };
  for (const float bad : {nan, infinity, -infinity}) {
    SynthesisSettings settings{.width = 16, .height = 16, .channels = 1};
    settings.importance.assign(4, bad);
    refuses(settings);
    settings = {.width = 16, .height = 16, .channels = 1};
    settings.channel_settings = {{.weight = bad}};
    refuses(settings);
    settings = {.width = 16, .height = 16, .channels = 1};
    settings.priority.uncertainty = static_cast<double>(bad);
    refuses(settings);
    settings = {.width = 16, .height = 16, .channels = 1};
    settings.list.samples_per_term = static_cast<double>(bad);
    refuses(settings);
  }
  Synthesizer engine({.width = 16, .height = 16, .channels = 1});
  EXPECT_THROW(engine.set_stop({.samples_per_pixel = static_cast<double>(nan)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
