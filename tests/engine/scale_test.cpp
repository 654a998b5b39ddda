// SPDX-License-Identifier: MIT
// The signal's unit does not matter, and a channel without weight does not matter to the others.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::coefficients_of;
using helpers::counts_of;
using helpers::settings_of;

/// Discs, gratings and ramps at random, on black or not. About 0 to 3.
class RandomPicture {
 public:
  explicit RandomPicture(unsigned seed) : random_(seed) {
    level_ = random_.below(2) == 0 ? 0 : random_.uniform(0, 1);
    for (Part& part : parts_) {
      part = {random_.uniform(0, 64),  random_.uniform(0, 48), random_.uniform(2, 20),
              random_.uniform(0.1, 1), random_.uniform(0, 1),  static_cast<int>(random_.below(3))};
    }
  }

  double operator()(double x, double y) const {
    double value = level_;
    for (const Part& part : parts_) {
      const double distance = std::hypot(x - part.x, y - part.y);
      if (part.kind == 0 && distance < part.size) value += part.height;
      if (part.kind == 1) value += part.height * std::exp(-distance * distance / part.size);
      if (part.kind == 2 && std::sin(part.turn * x + distance / part.size) > 0.5) {
        value += part.height;
      }
    }
    return value;
  }

 private:
  struct Part {
    double x, y, size, height, turn;
    int kind;
  };
  oracle::Random random_;
  double level_ = 0;
  std::array<Part, 4> parts_;
};

struct Picture {
  std::vector<std::uint32_t> counts;
  std::vector<float> fit, finished;
  SynthesisStats stats;
};

template <class Sampler>
Picture picture_of(const SynthesisSettings& settings, const Sampler& sampler,
                   const StopRule& stop) {
  Synthesizer engine(settings);
  engine.run(sampler, stop);
  return {counts_of(engine.image()), coefficients_of(engine.image()),
          coefficients_of(engine.finished_image()), engine.stats()};
}

class Measures : public testing::TestWithParam<PriorityMeasure> {};
INSTANTIATE_TEST_SUITE_P(All, Measures,
                         testing::Values(PriorityMeasure::residual, PriorityMeasure::change));

TEST_P(Measures, PowersOfTwoScaleToTheBit) {
  oracle::Random random(1);
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RandomPicture f(seed);
    SynthesisSettings settings = settings_of(64, 48, 1, seed % 3 == 0 ? 1 : 0);
    settings.priority.measure = GetParam();
    const double threshold = 0.02;
    const auto scaled = [&](int exponent) {
      const auto sampler = [&](double x, double y) {
        // Rounded first, so that small units lose no digits. All of them stay above 1e-7.
        const auto value = static_cast<float>(std::max(f(x, y) - 0.01, 0.0));
        return std::ldexp(value < 1e-7f ? 0 : value, exponent);
      };
      StopRule stop{.samples_per_pixel = 3};
      if (seed % 2 == 0) stop.aliasing_threshold = std::ldexp(threshold, exponent);
      return picture_of(settings, sampler, stop);
    };
    const Picture one = scaled(0);
    for (int i = 0; i < 4; ++i) {
      const int exponent = static_cast<int>(random.below(190)) - 90;
      const Picture other = scaled(exponent);
      ASSERT_EQ(other.counts, one.counts) << "seed " << seed << ", 2^" << exponent;
      for (std::size_t at = 0; at < one.fit.size(); ++at) {
        // Coefficients that are nothing beside the others may lie below what a float can hold.
        const float least = std::ldexp(1e-7f, exponent);
        ASSERT_NEAR(other.fit[at], std::ldexp(one.fit[at], exponent), 1e-6f * least);
        ASSERT_NEAR(other.finished[at], std::ldexp(one.finished[at], exponent), 1e-6f * least);
      }
    }
  }
}

double error_of(const Picture& picture, const Picture& other, double scale) {
  double sum = 0, power = 0;
  for (std::size_t i = 0; i < picture.finished.size(); ++i) {
    sum += std::pow(double{picture.finished[i]} / scale - double{other.finished[i]}, 2);
    power += std::pow(double{other.finished[i]}, 2);
  }
  return std::sqrt(sum / power);
}

TEST(Scale, OfOtherFactorsGivesTheSamePictureToRounding) {
  oracle::Random random(2);
  for (unsigned seed = 20; seed < 32; ++seed) {
    const RandomPicture f(seed);
    // The same samples for all, so that roundings make no other choice.
    SynthesisSettings settings = settings_of(64, 48);
    settings.max_samples_per_block = 90;
    const auto scaled = [&](double factor) {
      return picture_of(
          settings, [&](double x, double y) { return static_cast<float>(factor * f(x, y)); }, {});
    };
    const Picture one = scaled(1);
    for (int i = 0; i < 4; ++i) {
      const double factor = std::pow(10, random.uniform(-30, 30));
      const Picture other = scaled(factor);
      EXPECT_EQ(other.stats.bad_samples, 0u);
      EXPECT_LT(error_of(other, one, factor), 1e-4) << "seed " << seed << ", factor " << factor;
    }
  }
}

/// Root mean square error of the finished picture, relative to `scale`.
template <class Function>
double rmse(std::size_t width, std::size_t height, double spp, const Function& function,
            double scale) {
  Synthesizer engine(settings_of(width, height));
  engine.run([&](double x, double y) { return static_cast<float>(scale * function(x, y)); },
             {.samples_per_pixel = spp});
  std::vector<float> pixels = reconstruct(engine.finished_image());
  for (float& pixel : pixels) pixel = static_cast<float>(double{pixel} / scale);
  return helpers::rmse_of(pixels, width, function);
}

TEST(Scale, AnElectronDensityInCubicMetresIsNotBlack) {
  const auto density = [](double x, double y) {
    return std::exp(-(std::pow(x - 32, 2) + std::pow(y - 30, 2)) / 400);
  };
  EXPECT_LT(rmse(64, 64, 1, density, 5e19), 2e-3);
}

TEST(Scale, SmallUnitsAreAsGoodAsOthers) {
  const auto f = [](double x, double y) {
    const double square = std::pow(x - 32, 2) + std::pow(y - 30, 2);
    return std::exp(-square / 100) + (x + y > 80 ? 0.5 : 0);
  };
  EXPECT_NEAR(rmse(64, 64, 1, f, 3e-18), rmse(64, 64, 1, f, 1), 0.05 * rmse(64, 64, 1, f, 1));
}

double busy_corner(double x, double y) {
  const double busy = x > 140 && y > 140 && std::sin(0.02 * x * y) > 0 ? 1 : 0;
  return x > 140 && y > 140 ? busy : 0.3 + 0.001 * x;
}

TEST(Scale, APictureInAnyUnitIsAsGood) {
  const double expected = rmse(256, 256, 1, busy_corner, 1);
  for (const double unit : {1e-30, 1e-18, 1e-16, 1e-14, 1e15, 1e30}) {
    EXPECT_NEAR(rmse(256, 256, 1, busy_corner, unit), expected, 0.03 * expected) << unit;
  }
}

TEST(Scale, AThresholdInASmallUnitEndsTheRun) {
  for (const double unit : {1e-30, 1e-20, 1.0, 1e20}) {
    Synthesizer engine(settings_of(64, 48));
    const auto report = engine.run(
        [&](double x, double y) {
          return static_cast<float>(unit * (std::sin(0.1 * x) + std::cos(0.2 * y)));
        },
        {.samples_per_pixel = 200, .aliasing_threshold = 0.003 * unit});
    EXPECT_EQ(report.reason, StopReason::threshold) << unit;
    EXPECT_LT(engine.stats().samples, 64u * 48u) << unit;
  }
}

TEST(Scale, AThresholdEndsABlackPicture) {
  for (const double threshold : {1e-30, 1e-3}) {
    Synthesizer engine(settings_of(64, 48));
    const auto report =
        engine.run([](double, double) { return 0.0; }, {.aliasing_threshold = threshold});
    EXPECT_EQ(report.reason, StopReason::threshold) << threshold;
  }
}

TEST(Scale, AQuantizationTargetInAnyUnitIsMet) {
  const RandomPicture f(77);
  std::uint64_t samples = 0;
  for (const int exponent : {0, -80, -40, 40, 80}) {
    SynthesisSettings settings = settings_of(64, 48);
    std::array<float, max_terms> steps;
    steps.fill(std::ldexp(0.2f, exponent));
    settings.quantization = QuantizationTarget{.steps = {steps}};
    Synthesizer engine(settings);
    const auto report = engine.run(
        [&](double x, double y) { return std::ldexp(static_cast<float>(f(x, y)), exponent); }, {});
    EXPECT_EQ(report.reason, StopReason::threshold);
    if (exponent == 0) samples = engine.stats().samples;
    EXPECT_EQ(engine.stats().samples, samples) << "2^" << exponent;
  }
}

/// What a channel without weight may hold: anything.
float garbage(oracle::Random& random, unsigned kind, double x, double y) {
  const float all[] = {0,
                       static_cast<float>(1e9 * std::sin(0.05 * x) * std::cos(0.03 * y)),
                       std::numeric_limits<float>::quiet_NaN(),
                       3e38f,
                       -std::numeric_limits<float>::infinity(),
                       1e-42f,
                       random.value()};
  return kind < 7 ? all[kind] : all[random.below(7)];
}

TEST(Weight, AChannelWithoutOneChangesNothingForTheOthers) {
  for (const PriorityMeasure measure : {PriorityMeasure::residual, PriorityMeasure::change}) {
    for (unsigned seed = 0; seed < 16; ++seed) {
      const RandomPicture f(seed);
      SynthesisSettings settings = settings_of(64, 48, 2);
      settings.priority.measure = measure;
      const std::size_t seen = seed % 2;
      settings.channel_settings.resize(2);
      settings.channel_settings[1 - seen].role = ChannelRole::passive;
      const auto picture = [&](unsigned kind, std::vector<float>& all) {
        oracle::Random random(seed);
        const auto sampler = [&](double x, double y) {
          std::array<float, 2> values{};
          values[seen] = static_cast<float>(f(x, y));
          values[1 - seen] = garbage(random, kind, x, y);
          return values;
        };
        Synthesizer engine(settings);
        engine.run(sampler, {.samples_per_pixel = 2});
        EXPECT_EQ(engine.stats().bad_samples, 0u) << kind;
        EXPECT_TRUE(engine.bad_samples().empty());
        const bool bad = kind == 2 || kind == 3 || kind == 4;
        if (kind != 7) {
          EXPECT_EQ(engine.stats().ignored_bad_samples, bad ? engine.stats().samples : 0u);
        }
        for (const FrequencyImage& image : {engine.image(), engine.finished_image()}) {
          for (std::size_t y = 0; y < image.blocks_y(); ++y) {
            for (std::size_t x = 0; x < image.blocks_x(); ++x) {
              for (const float value : image.coefficients(x, y, seen)) all.push_back(value);
              for (const float value : image.coefficients(x, y, 1 - seen)) {
                ASSERT_TRUE(std::isfinite(value)) << "seed " << seed << ", kind " << kind;
              }
            }
          }
        }
      };
      std::vector<float> expected;
      picture(0, expected);
      for (unsigned kind = 1; kind <= 7; ++kind) {
        std::vector<float> all;
        ASSERT_NO_FATAL_FAILURE(picture(kind, all));
        ASSERT_EQ(all, expected) << "seed " << seed << ", kind " << kind;
      }
    }
  }
}

TEST(Weight, AnAuxiliaryChannelHasNoEffectOnTheErrorOfTheOther) {
  SynthesisSettings settings = settings_of(256, 256, 2);
  settings.channel_settings = {{}, {ChannelRole::passive}};
  const auto picture = [&](double s) {
    const auto sampler = [&](double x, double y) {
      return std::array{busy_corner(x, y), s * (1 + std::sin(0.05 * x) * std::cos(0.03 * y))};
    };
    return picture_of(settings, sampler, {.samples_per_pixel = 0.5}).counts;
  };
  const auto expected = picture(0);
  for (const double s : {10.0, 1e3, 1e4, 1e6, 1e9}) EXPECT_EQ(picture(s), expected) << s;
}

TEST(Weight, ChannelsOfVeryDifferentUnitsAreEachRight) {
  // The small one is nothing beside the other where blocks are chosen, but is finished as well.
  const RandomPicture f(5), g(6);
  SynthesisSettings settings = settings_of(64, 48, 2);
  settings.max_samples_per_block = 60;
  const auto both = [&](double unit) {
    const auto sampler = [&](double x, double y) { return std::array{f(x, y), unit * g(x, y)}; };
    return picture_of(settings, sampler, {});
  };
  const Picture one = both(1), other = both(0x1p-90);
  for (std::size_t at = 0; at < one.finished.size(); ++at) {
    const bool second = at / max_terms % 2 == 1;
    const float back = second ? std::ldexp(other.finished[at], 90) : other.finished[at];
    ASSERT_NEAR(back, one.finished[at], 1e-5f);
  }
}

TEST(Scale, WaxesWithTheValuesOfALaterWave) {
  // All that is not black lies between the corners of blocks, and grows from sample to sample.
  for (const float growth : {10.0f, 1e6f, 1e12f}) {
    Synthesizer engine(settings_of(64, 48));
    float value = 1e-30f;
    const auto sampler = [&](double x, double y) {
      if (std::fmod(x, 8) == 0 && std::fmod(y, 8) == 0) return 0.0f;
      value = std::min(value * growth, 1e30f);
      return value;
    };
    engine.run(sampler, {.samples_per_pixel = 4});
    EXPECT_EQ(engine.stats().bad_samples, 0u);
    const std::vector<float> pixels = reconstruct(engine.finished_image());
    EXPECT_TRUE(helpers::all_finite(pixels));
    std::vector<float> sorted = pixels;
    std::nth_element(sorted.begin(), sorted.begin() + 1536, sorted.end());
    EXPECT_NEAR(sorted[1536] / 1e30f, 1, 0.2) << growth;
  }
}

}  // namespace
}  // namespace freqsynth
