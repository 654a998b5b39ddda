// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "case.h"
#include "members.h"

namespace field_cases {
namespace {

// Bars; the left half `factor` times as bright as the right one.
Field dark_half(double factor) {
  return darken_left_half(
      rows_field("bars", 128, 128,
                 [](double y) { return sine_above(0.55, 3 * std::sin(0.21 * y), 0.2, 1, 0.15); }),
      factor);
}

// Errors of linear pixels after encoding: of the left half, and of all.
std::vector<Figure> encoded_figures(const Field& field, double rate) {
  const Sampler sampler = sampler_of(field);
  std::vector<double> right = right_pixels(field);
  for (double& value : right) value = display(value);
  const auto settings = settings_of(field.width, field.height);
  std::vector<Figure> figures;
  for (const bool left : {true, false}) {
    const Columns columns{0, left ? field.width / 2 : field.width};
    const Measure measure = [&](const Picture& p) {
      Picture shown = p;
      for (float& value : shown.pixels) value = static_cast<float>(display(double(value)));
      return squared_error(shown, right, columns);
    };
    Figure figure{left ? "RMSE in sRGB, left half" : "RMSE in sRGB", 0};
    figure.now = std::sqrt(over_seeds(sampler, settings, rate, measure));
    figure.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, measure));
    figure.jittered =
        std::sqrt(over_jittered(sampler, field.width, field.height, 1, rate, measure));
    figures.push_back(figure);
  }
  return figures;
}

Case encoded_case(double factor) {
  const std::string times = std::to_string(factor).substr(0, 4);
  return {"V14.dark" + times,
          "left half " + times + " times as bright",
          {1, 4, 16},
          [factor](double rate) { return encoded_figures(dark_half(factor), rate); }};
}

Case dark_members_case() {
  return {"K6.functions", "32 random functions with a dark half", {1, 4, 16}, [](double rate) {
            double sum = 0, worst = 0;
            for (std::uint64_t number = 1; number <= 32; ++number) {
              const Figure left =
                  encoded_figures(random_dark_half(table_seed, number), rate).front();
              const double ratio =
                  std::max(left.now, least_error) / std::max(left.jittered, least_error);
              sum += std::log(ratio);
              worst = std::max(worst, ratio);
            }
            return std::vector<Figure>{
                {"left half: RMSE / jittered, geometric mean", none, std::exp(sum / 32)},
                {"left half: RMSE / jittered, worst", none, worst}};
          }};
}

}  // namespace

Kind display_errors() {
  Kind kind{"K6",
            "What is seen is not linear",
            "Linear light is sampled and averaged, but the picture is shown in sRGB, where errors "
            "in dark parts count more. A host that shows its picture can return encoded samples.",
            {}};
  for (const double factor : {0.1, 0.03, 0.01}) {
    kind.cases.push_back(encoded_case(factor));
  }
  kind.cases.push_back(dark_members_case());
  return kind;
}

}  // namespace field_cases
