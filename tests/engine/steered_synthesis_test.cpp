// SPDX-License-Identifier: MIT
// Errors that are compared as they are seen.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::counts_of;
using helpers::same_image;
using helpers::settings_of;

/// Stripes everywhere, 20 times as dark in the left half; the light changes within two blocks.
double dusk(double x, double y) {
  const double light = std::pow(20, std::clamp((x - 24) / 16, 0.0, 1.0) - 1);
  return light * (std::sin(0.7 * x + 2 * std::sin(0.2 * y)) > 0.2 ? 0.9 : 0.2);
}

SynthesisSettings steered(Steer steer, PriorityMeasure measure = PriorityMeasure::residual,
                          std::size_t channels = 1) {
  SynthesisSettings settings = settings_of(64, 48, channels);
  settings.priority.steer = steer;
  settings.priority.measure = measure;
  return settings;
}

template <class Sampler>
std::vector<std::uint32_t> counts(const SynthesisSettings& settings, const Sampler& sampler,
                                  const StopRule& stop = {.samples_per_pixel = 3}) {
  Synthesizer engine(settings);
  engine.run(sampler, stop);
  EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine.finished_image())));
  return counts_of(engine.image());
}

/// Share of all samples that the 3 leftmost of 8 columns of blocks have.
double dark_share(const std::vector<std::uint32_t>& counts) {
  double dark = 0, all = 0;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    all += counts[b];
    if (b % 8 < 3) dark += counts[b];
  }
  return dark / all;
}

constexpr std::array measures{PriorityMeasure::residual, PriorityMeasure::change};

TEST(SteeredSynthesis, DarkPartsGetWhatIsSeenOfThem) {
  for (const PriorityMeasure measure : measures) {
    const auto share = [&](Steer steer) {
      SynthesisSettings settings = steered(steer, measure);
      settings.priority.exploration = 0;
      return dark_share(counts(settings, dusk));
    };
    const double linear = share(Steer::linear);
    EXPECT_LT(linear, 0.1);
    EXPECT_GT(share(Steer::display), 1.3 * linear);
    EXPECT_GT(share(Steer::relative), 0.25) << "about as many as others";
    EXPECT_GT(share(Steer::relative), share(Steer::display));
  }
}

TEST(SteeredSynthesis, ExposureIsForDisplaysAlone) {
  for (const Steer steer : {Steer::linear, Steer::relative, Steer::display}) {
    SynthesisSettings settings = steered(steer);
    const auto usual = counts(settings, dusk);
    settings.priority.exposure = 8;
    EXPECT_EQ(counts(settings, dusk) == usual, steer != Steer::display);
  }
}

TEST(SteeredSynthesis, RelativeErrorsHaveNoUnit) {
  for (const PriorityMeasure measure : measures) {
    for (const double threshold : {0.0, 0.01}) {
      const auto scaled = [&](int exponent) {
        return counts(steered(Steer::relative, measure),
                      [=](double x, double y) {
                        return std::ldexp(static_cast<float>(dusk(x, y)), exponent);
                      },
                      {.samples_per_pixel = 3, .aliasing_threshold = threshold});
      };
      const auto one = scaled(0);
      for (const int exponent : {-99, -3, 40, 99}) EXPECT_EQ(scaled(exponent), one) << exponent;
    }
  }
}

TEST(SteeredSynthesis, ExposureIsTheUnitOfADisplay) {
  for (const PriorityMeasure measure : measures) {
    for (const double threshold : {0.0, 0.01}) {
      const auto scaled = [&](int exponent) {
        SynthesisSettings settings = steered(Steer::display, measure);
        settings.priority.exposure = std::ldexp(1.0, -exponent);
        return counts(settings,
                      [=](double x, double y) {
                        return std::ldexp(static_cast<float>(dusk(x, y)), exponent);
                      },
                      {.samples_per_pixel = 3, .aliasing_threshold = threshold});
      };
      const auto one = scaled(0);
      for (const int exponent : {-70, -3, 40, 70}) EXPECT_EQ(scaled(exponent), one) << exponent;
    }
  }
}

TEST(SteeredSynthesis, AThresholdIsInTheUnitOfWhatIsSeen) {
  // Of a picture that is a thousand times as dark, 1/200 of the value is as much; but it is nothing
  // on a display.
  const auto samples = [](Steer steer, double factor) {
    Synthesizer engine(steered(steer));
    engine.run([=](double x, double y) { return factor * dusk(x, y); },
               {.samples_per_pixel = 20, .aliasing_threshold = 0.005});
    EXPECT_EQ(engine.stopped(), StopReason::threshold);
    return static_cast<double>(engine.stats().samples);
  };
  EXPECT_NEAR(samples(Steer::relative, 1e-3) / samples(Steer::relative, 1), 1, 0.05);
  EXPECT_GT(samples(Steer::display, 1), 1.5 * samples(Steer::display, 1e-3));
}

TEST(SteeredSynthesis, TheSignDoesNotMatterToRelativeErrors) {
  for (const PriorityMeasure measure : measures) {
    const SynthesisSettings settings = steered(Steer::relative, measure);
    EXPECT_EQ(counts(settings, [](double x, double y) { return -dusk(x, y); }),
              counts(settings, dusk));
  }
}

TEST(SteeredSynthesis, WhatADisplayCannotShowIsSampledEvenly) {
  for (const PriorityMeasure measure : measures) {
    for (const double factor : {-1.0, -1e30, 1e5, 1e30}) {
      const auto all = counts(steered(Steer::display, measure),
                              [=](double x, double y) { return factor * (2 + dusk(x, y)); });
      const auto [least, most] = std::minmax_element(all.begin(), all.end());
      EXPECT_LT(*most, 1.5 * *least) << factor;
    }
  }
}

TEST(SteeredSynthesis, AChannelWithoutWeightChangesNothing) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    for (const PriorityMeasure measure : measures) {
      SynthesisSettings settings = steered(steer, measure, 2);
      settings.channel_settings = {{}, {ChannelRole::passive}};
      const auto with = [&](double other) {
        return counts(settings, [=](double x, double y) {
          return std::array{dusk(x, y), other * std::cos(0.3 * x + y)};
        });
      };
      const auto alone = with(0);
      const double nan = std::numeric_limits<double>::quiet_NaN();
      for (const double other : {1e-30, 1.0, 1e30, nan}) EXPECT_EQ(with(other), alone) << other;
    }
  }
}

TEST(SteeredSynthesis, WithoutAnyWeightAllBlocksAreSampledEvenly) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    for (const PriorityMeasure measure : measures) {
      SynthesisSettings settings = steered(steer, measure);
      settings.channel_settings = {{ChannelRole::passive}};
      const auto all = counts(settings, dusk);
      const auto [least, most] = std::minmax_element(all.begin(), all.end());
      EXPECT_LT(*most, 1.5 * *least);
    }
  }
}

TEST(SteeredSynthesis, BlackAndBadPicturesWork) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Steer steer : {Steer::relative, Steer::display}) {
    for (const PriorityMeasure measure : measures) {
      const auto black = counts(steered(steer, measure), [](double, double) { return 0.0; });
      const auto [least, most] = std::minmax_element(black.begin(), black.end());
      EXPECT_LT(*most, 1.5 * *least);
      // Bad in one quarter, with a firefly.
      counts(steered(steer, measure), [=](double x, double y) {
        return x < 16 && y < 24 ? nan : x > 40 && x < 40.5 && y < 0.5 ? 1e20 : dusk(x, y);
      });
    }
  }
}

TEST(SteeredSynthesis, TheOrderOfDeliveryDoesNotMatter) {
  for (const Steer steer : {Steer::relative, Steer::display}) {
    for (const PriorityMeasure measure : measures) {
      const SynthesisSettings settings = steered(steer, measure);
      Synthesizer one(settings), other(settings);
      one.run(dusk, {.samples_per_pixel = 2});
      other.set_stop({.samples_per_pixel = 2});
      std::vector<Request> requests(1000);
      for (std::size_t n = other.request(requests); n > 0; n = other.request(requests)) {
        for (std::size_t i = n; i-- > 0;) {
          const auto value = static_cast<float>(dusk(requests[i].x, requests[i].y));
          other.deliver({&requests[i], 1}, {&value, 1});
        }
      }
      EXPECT_TRUE(same_image(one.image(), other.image()));
    }
  }
}

TEST(SteeredSynthesis, AQuantizationTargetHasAUnitOfItsOwn) {
  SynthesisSettings settings = steered(Steer::display);
  settings.quantization = QuantizationTarget{};
  settings.quantization->steps.assign(1, {});
  settings.quantization->steps[0].fill(1);
  EXPECT_THAT([&] { Synthesizer{settings}; },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("priority.steer")));
  settings.priority.steer = Steer::linear;
  EXPECT_NO_THROW(Synthesizer{settings});
}

}  // namespace
}  // namespace freqsynth
