// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/quantization_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth {
namespace {

using Block = std::array<float, max_terms>;

Block filled(float value) {
  Block block;
  block.fill(value);
  return block;
}

TEST(QuantizationTarget, CountsOnlyErrorsThatMayChangeAQuantizedValue) {
  Block coefficients = filled(0);
  const Block steps = filled(10);
  const Block variances = filled(1);
  // Standard deviation 1: all but the constant term stay within half a step of 0.
  EXPECT_FLOAT_EQ(quantized_error(steps, coefficients, variances, 1), 0.01f);
  // A term that is kept counts in full.
  coefficients[5] = -12;
  EXPECT_FLOAT_EQ(quantized_error(steps, coefficients, variances, 1), 0.02f);
  // So does one that is two standard deviations from being kept, not one that is further away.
  coefficients[6] = 3.1f;
  coefficients[7] = 2.9f;
  EXPECT_FLOAT_EQ(quantized_error(steps, coefficients, variances, 1), 0.03f);
  // With a standard deviation of 3 all may change.
  EXPECT_NEAR(quantized_error(steps, coefficients, variances, 9), 64 * 0.09f, 1e-4f);
  // A dropped term never counts.
  Block dropped = filled(std::numeric_limits<float>::infinity());
  EXPECT_EQ(quantized_error(dropped, coefficients, variances, 9), 0);
}

TEST(QuantizationTarget, RefusesWhatMakesNoSense) {
  QuantizationTarget target;
  target.steps.assign(3, filled(1));
  EXPECT_NO_THROW(target.validate(3));
  EXPECT_THROW(target.validate(1), std::invalid_argument);
  target.tolerance = 0;
  EXPECT_THROW(target.validate(3), std::invalid_argument);
  target.tolerance = 1;
  target.steps[2][9] = 0;
  EXPECT_THROW(target.validate(3), std::invalid_argument);
  SynthesisSettings settings{.width = 8, .height = 8, .channels = 1};
  settings.quantization = target;
  EXPECT_THROW(Synthesizer{settings}, std::invalid_argument);
}

TEST(QuantizationTarget, HalvedChromaCountsAsTwiceTheStep) {
  QuantizationSettings settings;
  settings.subsampling = Subsampling::both;
  const QuantizationTarget target = quantization_target(settings, 3);
  EXPECT_EQ(target.steps[0][0], 16);
  EXPECT_EQ(target.steps[1][0], 34);
  EXPECT_EQ(target.steps[2][term_of_frequency(1, 2)],
            2.0f * static_cast<float>(chrominance_table()[term_of_frequency(2, 4)]));
  EXPECT_TRUE(std::isinf(target.steps[1][term_of_frequency(4, 0)]));
}

// The variances of the inverse list are those of least squares: white noise with variance 1 in the
// samples gives coefficients with just that squared error, on average over many blocks.
TEST(QuantizationTarget, PredictedVariancesAreThoseOfNoise) {
  const auto list = SharedInverseList(InverseListSettings{});
  const LeastSquaresRefiner refiner(list, 1);
  constexpr std::size_t samples = 200;
  constexpr int blocks = 4000;
  std::uint32_t random = 1;
  const auto uniform = [&] {
    random = random * 1664525u + 1013904223u;
    return static_cast<double>(random >> 8) / (1 << 24) - 0.5;
  };
  struct alignas(64) State {
    float values[208];
  };
  ASSERT_EQ(refiner.state_size(), 208u);
  std::array<double, max_terms> squares{};
  double residuals = 0;
  for (int b = 0; b < blocks; ++b) {
    State state{};
    refiner.reset(state.values);
    for (std::size_t n = 0; n < samples; ++n) {
      const auto value = static_cast<float>(std::sqrt(12.0) * uniform());
      refiner.absorb(state.values, n, &value);
    }
    Block coefficients;
    refiner.coefficients(state.values, samples, 0, coefficients);
    for (std::size_t i = 0; i < max_terms; ++i) {
      squares[i] += double{coefficients[i]} * double{coefficients[i]} / blocks;
    }
    residuals += double{refiner.squared_residuals(state.values, 0)} / blocks;
  }
  // The mean of 4000 squares of a normal variable has a standard deviation of 2.2 percent.
  for (std::size_t i = 0; i < max_terms; ++i) {
    EXPECT_NEAR(squares[i] / double{list->variances(samples - 1)[i]}, 1, 0.12) << i;
  }
  // 544 000 squared residuals, of a uniform variable: a standard deviation of .0012.
  EXPECT_NEAR(residuals / (samples - max_terms), 1, 0.004);
}

/// Y of a picture with a flat left half and a busy right half.
double picture(double x, double y) {
  return x < 32 ? 128 : 128 + 100 * std::sin(0.9 * x) * std::cos(0.7 * y);
}

TEST(QuantizationTarget, EndsByItselfAndSamplesWhatTheQuantizerKeeps) {
  const auto samples_at = [](int quality) {
    QuantizationSettings quantization;
    quantization.luminance = scale_table(luminance_table(), quality);
    SynthesisSettings settings{.width = 64, .height = 64, .channels = 1};
    settings.quantization = quantization_target(quantization, 1);
    Synthesizer engine(settings);
    const RunReport report = engine.run(picture, {});
    EXPECT_EQ(report.reason, StopReason::threshold);
    const FrequencyImage image = engine.image();
    // A flat block gets little more than the least; a busy one half as many again at the least.
    EXPECT_LT(image.samples(0, 4) * 3, image.samples(6, 4) * 2);
    return engine.stats().samples;
  };
  EXPECT_LT(20 * samples_at(10), samples_at(95)) << "1892 and 55556 were measured";
}

TEST(QuantizationTarget, TheToleranceIsAShareOfTheQuantizersOwnError) {
  QuantizationTarget target;
  target.steps.assign(3, filled(7));
  target.tolerance = 0.5;
  // 192 errors that are uniform in -1/2 .. 1/2 of a step.
  EXPECT_DOUBLE_EQ(target.allowed_error(3), 0.5 * 192 / 12);
}

TEST(QuantizationTarget, EvenlySpreadSamplesConvergeFasterBeyondOneAPixel) {
  EXPECT_EQ(evenness(1), 1);
  EXPECT_EQ(evenness(64), 1);
  EXPECT_FLOAT_EQ(evenness(256), 0.5f);
}

// White noise around a constant: all AC values are 0 in truth. At the end at most those beyond two
// standard deviations, 4.6 percent of a normal distribution, are not.
TEST(QuantizationTarget, NoiseIsSampledUntilTheQuantizerHardlyNotices) {
  const auto noise = [](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      std::uint64_t random = (requests[i].id + 1) * 0x9e3779b97f4a7c15u;
      random = (random ^ (random >> 29)) * 0xbf58476d1ce4e5b9u;
      random ^= random >> 32;
      values[i] = 100 + 3 * (static_cast<float>(random >> 40) / (1 << 24) - 0.5f);
    }
  };
  const auto synthesize = [&](bool noisy) {
    QuantizationSettings quantization;
    quantization.luminance = scale_table(luminance_table(), 100);
    SynthesisSettings settings{.width = 128, .height = 128, .channels = 1};
    settings.quantization = quantization_target(quantization, 1);
    settings.noise = noisy ? Noise::present : Noise::none;
    settings.list.positions = SamplePositions::lattice;
    Synthesizer engine(settings);
    EXPECT_EQ(engine.run(noise, {}).reason, StopReason::threshold);
    // The fit as it is: finishing would remove more of the noise.
    quantization.butterworth.enabled = false;
    const QuantizedImage image = quantize(engine.image(), quantization);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < image.components[0].values.size(); ++i) {
      if (i % max_terms != 0 && image.components[0].values[i] != 0) ++wrong;
    }
    return std::pair(engine.stats().samples, static_cast<double>(wrong) / (16 * 16 * 63));
  };
  const auto [samples, wrong] = synthesize(true);
  EXPECT_LT(wrong, 0.004) << ".0032 was measured";
  // Not from sampling without end: half of the samples would leave more.
  EXPECT_GT(wrong, 0.002);
  // Noise that is not said to be there gets too few: 122921 against 303889.
  EXPECT_LT(2 * synthesize(false).first, samples);
}

// A pattern that repeats with the first lattices of a block looks flat there. Its neighbours, of
// other patterns, say that it may not be.
TEST(QuantizationTarget, NeighboursKeepALuckyBlockInDoubt) {
  const auto lines = [](double x, double y) {
    // In columns 16..24 lines of period 1 pixel, black only between the points of a lattice of
    // pixels.
    const double phase = x - std::floor(x);
    if (x >= 16 && x <= 24) return phase > 0.6 && phase < 0.9 ? 0.0 : 255.0;
    return std::sin(2.1 * x) * std::cos(1.7 * y) > 0 ? 0.0 : 255.0;
  };
  QuantizationSettings quantization;
  SynthesisSettings settings{.width = 40, .height = 40, .channels = 1};
  settings.quantization = quantization_target(quantization, 1);
  Synthesizer engine(settings);
  engine.run(lines, {.samples_per_pixel = 16});
  // The lattice of pixels is complete after 81 samples; 285 were measured.
  EXPECT_GT(engine.image().samples(2, 2), 228u);
}

TEST(QuantizationTarget, AFlatFirstImpressionIsNotTrusted) {
  // White on all corners of blocks; each block gets its 25 samples all the same.
  const auto spots = [](double x, double y) {
    return std::hypot(x - 8 * std::floor(x / 8) - 2, y - 8 * std::floor(y / 8) - 2) < 1 ? 0.0
                                                                                        : 255.0;
  };
  SynthesisSettings settings{.width = 32, .height = 32, .channels = 1};
  settings.quantization = quantization_target({}, 1);
  Synthesizer engine(settings);
  engine.run(spots, {.samples_per_pixel = 16});
  const FrequencyImage image = engine.image();
  for (std::size_t b = 0; b < 16; ++b)
    EXPECT_GT(image.samples(b % 4, b / 4), 540u) << b << ": 684 or more";
}

// An edge along a row of samples: each of its samples says the same wrong thing.
TEST(QuantizationTarget, ABlockThatCannotMeetItIsLeft) {
  const auto edge = [](double x, double) { return x < 12 ? 0.0 : 255.0; };
  for (const std::size_t most : {25u, 100u, 4096u}) {
    SynthesisSettings settings{.width = 32, .height = 32, .channels = 1};
    settings.quantization =
        quantization_target({.luminance = scale_table(luminance_table(), 95)}, 1);
    settings.quantization->most_samples = most;
    Synthesizer engine(settings);
    EXPECT_EQ(engine.run(edge, {}).reason, StopReason::threshold);
    const FrequencyImage image = engine.image();
    for (std::size_t b = 0; b < 16; ++b) {
      // Its neighbours may add what they know of its border.
      EXPECT_LE(image.samples(b % 4, b / 4), most + 2 * SampleSequence::longest_border_run) << b;
    }
    EXPECT_GE(image.samples(1, 1), most) << "the edge lies there";
  }
  // A block of a quarter of the pixels is left after a quarter of the samples.
  SynthesisSettings narrow{.width = 12, .height = 12, .channels = 1};
  narrow.quantization = quantization_target({.luminance = scale_table(luminance_table(), 99)}, 1);
  narrow.quantization->most_samples = 1000;
  Synthesizer engine(narrow);
  EXPECT_EQ(engine.run([](double x, double) { return x < 10 ? 0.0 : 255.0; }, {}).reason,
            StopReason::threshold);
  EXPECT_GE(engine.image().samples(1, 1), 250u) << "the edge lies there";
  EXPECT_LE(engine.image().samples(1, 1), 250 + 2 * SampleSequence::longest_border_run);

  SynthesisSettings settings{.width = 32, .height = 32, .channels = 1};
  settings.quantization = quantization_target({}, 1);
  settings.quantization->most_samples = 0;
  EXPECT_THAT([&] { Synthesizer{settings}; }, testing::ThrowsMessage<std::invalid_argument>(
                                                  testing::HasSubstr("most_samples is 0")));
}

}  // namespace
}  // namespace freqsynth
