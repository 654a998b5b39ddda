// SPDX-License-Identifier: MIT
// Settings at and beyond the ends of their ranges: refused by name, or a run that works.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double hostile[] = {
    0,     -0.0,  1e-320,   1e-45,   1e-30, 1e-15,     1e-6,
    0.5,   1,     2,        1e6,     1e9,   1e30,      4e38,
    1e154, 1e308, infinity, -1e-300, -1,    -infinity, std::numeric_limits<double>::quiet_NaN()};

struct Field {
  std::string name;  // as the message says it
  std::function<void(SynthesisSettings&, double)> set;
};

std::vector<Field> fields() {
  return {
      {"priority.weight", [](auto& s, double v) { s.priority.weight = v; }},
      {"priority.uncertainty", [](auto& s, double v) { s.priority.uncertainty = v; }},
      {"priority.decay", [](auto& s, double v) { s.priority.decay = v; }},
      {"priority.neighbours", [](auto& s, double v) { s.priority.neighbours = v; }},
      {"priority.image", [](auto& s, double v) { s.priority.image = v; }},
      {"priority.exposure",
       [](auto& s, double v) {
         s.priority.steer = Steer::display;
         s.priority.exposure = v;
       }},
      {"samples_per_term", [](auto& s, double v) { s.list.samples_per_term = v; }},
      {"channel_settings",
       [](auto& s, double v) { s.channel_settings.assign(2, {.weight = static_cast<float>(v)}); }},
      {"importance", [](auto& s, double v) { s.importance.assign(20, static_cast<float>(v)); }},
      {"step",
       [](auto& s, double v) {
         s.quantization = QuantizationTarget{};
         s.quantization->steps.assign(2, {});
         for (auto& steps : s.quantization->steps) steps.fill(static_cast<float>(v));
       }},
      {"tolerance",
       [](auto& s, double v) {
         s.quantization = QuantizationTarget{};
         s.quantization->steps.assign(2, {});
         for (auto& steps : s.quantization->steps) steps.fill(10);
         s.quantization->tolerance = v;
       }},
  };
}

TEST(HostileSettings, AreRefusedByNameOrWork) {
  const std::vector<std::function<float(double, double)>> signals{
      [](double x, double y) { return picture(x, y); },
      [](double x, double y) { return 1e15f * (picture(x, y) - 0.5f) / 3; },
      [](double x, double y) { return 1e-15f * picture(x, y); },
      [](double, double) { return 0.25f; },
  };
  std::size_t refused = 0, worked = 0;
  for (const Field& field : fields()) {
    for (const double value : hostile) {
      for (const PriorityMeasure measure : {PriorityMeasure::residual, PriorityMeasure::change}) {
        for (const auto& signal : signals) {
          SynthesisSettings settings = settings_of(40, 32, 2);
          settings.priority.measure = measure;
          field.set(settings, value);
          std::optional<Synthesizer> engine;
          try {
            engine.emplace(settings);
          } catch (const std::invalid_argument& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(field.name)) << value;
            ++refused;
            continue;
          }
          ++worked;
          const RunReport report = engine->run(
              [&](double x, double y) {
                return std::array{signal(x, y), signal(y, x)};
              },
              at_samples(1500));
          // A target may be met, and blocks without importance are left at their first sample.
          const bool ends_early = settings.quantization ||
                                  (field.name == "importance" && static_cast<float>(value) == 0);
          EXPECT_EQ(report.reason, ends_early && engine->stats().samples < 1500
                                       ? StopReason::threshold
                                       : StopReason::samples)
              << field.name << " " << value;
          for (const std::uint32_t count : helpers::counts_of(engine->image())) {
            EXPECT_GE(count, 1u) << field.name << " " << value;
          }
          EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine->finished_image())))
              << field.name << " " << value;
        }
      }
    }
  }
  EXPECT_GT(refused, 200u);
  EXPECT_GT(worked, 600u);
}

TEST(HostileSettings, MessagesSayNumbersAsTheyAre) {
  SynthesisSettings settings = settings_of(8, 8);
  settings.priority.uncertainty = -1e-300;
  EXPECT_THAT([&] { Synthesizer{settings}; },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("priority.uncertainty is -1e-300, not in 0..1e6")));
  settings.priority.uncertainty = 1e308;
  EXPECT_THAT([&] { Synthesizer{settings}; },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("is 1e+308, not")));
}

}  // namespace
}  // namespace freqsynth
