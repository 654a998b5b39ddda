// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <utility>

#include "case.h"

namespace field_cases {
namespace {

// Bars; the left half `factor` times as bright as the right one.
Field dark_half(double factor) {
  Field bars = rows_field("bars", 128, 128, [](double y) {
    return sine_above(0.55, 3 * std::sin(0.21 * y), 0.2, 1, 0.15);
  });
  Field field = bars;
  field.value = [f = bars.value, factor](double x, double y) {
    return (x < 64 ? factor : 1) * f(x, y);
  };
  field.average = [f = bars.average, factor](double i, double j) {
    return (i < 64 ? factor : 1) * f(i, j);
  };
  return field;
}

// Errors of linear pixels after encoding.
Case encoded_case(double factor, bool steer) {
  std::string name = std::to_string(factor).substr(0, 4);
  name = "left half " + name + " times as bright" + (steer ? ", display steering" : "");
  return {"V14.dark" + std::to_string(factor).substr(0, 4) + (steer ? ".steer" : ""),
          name,
          {1, 4, 16},
          [factor, steer](double rate) {
            const Field field = dark_half(factor);
            const Sampler sampler = sampler_of(field);
            std::vector<double> right = right_pixels(field);
            for (double& value : right) value = display(value);
            auto settings = settings_of(128, 128);
            if (steer) settings = display_settings(settings);
            std::vector<Figure> figures;
            for (const bool left : {true, false}) {
              const Measure measure = [&](const Picture& p) {
                Picture shown = p;
                for (float& value : shown.pixels) {
                  value = static_cast<float>(display(double(value)));
                }
                return squared_error(shown, right, {0, left ? 64u : 128u});
              };
              Figure figure{left ? "RMSE in sRGB, left half" : "RMSE in sRGB", 0};
              figure.now = std::sqrt(over_seeds(sampler, settings, rate, measure));
              figure.uniform =
                  std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, measure));
              figure.jittered = std::sqrt(over_jittered(sampler, 128, 128, 1, rate, measure));
              figures.push_back(figure);
            }
            return figures;
          }};
}

}  // namespace

Kind display_errors() {
  Kind kind{"K6",
            "What is seen is not linear",
            "Linear light is sampled and averaged, but the picture is shown in sRGB, where errors "
            "in dark parts count more. Both are measured: the default, which knows nothing of the "
            "display, and the setting for such output.",
            {}};
  for (const double factor : {0.1, 0.03, 0.01}) {
    kind.cases.push_back(encoded_case(factor, false));
    kind.cases.push_back(encoded_case(factor, true));
  }
  return kind;
}

}  // namespace field_cases
