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

struct Part {
  const char* what;
  Columns columns;
};

// The left half also without its blocks that touch the other one: these have samples on the border,
// which are bright.
std::vector<Part> parts_of(std::size_t width) {
  const std::size_t half = width / 2;
  return {{"RMSE in sRGB, left half", {0, half}},
          {"RMSE in sRGB, left half away from the border", {0, half - 8}},
          {"RMSE in sRGB", {0, width}}};
}

// Errors of linear pixels after encoding.
std::vector<Figure> encoded_figures(const Field& field, double rate, bool steered) {
  const Sampler sampler = sampler_of(field);
  std::vector<double> right = right_pixels(field);
  for (double& value : right) value = display(value);
  const auto usual = settings_of(field.width, field.height);
  const auto settings = steered ? display_settings(usual) : usual;
  std::vector<Figure> figures;
  for (const auto& [what, columns] : parts_of(field.width)) {
    const Measure measure = [&right, part = columns](const Picture& p) {
      Picture shown = p;
      for (float& value : shown.pixels) value = static_cast<float>(display(double(value)));
      return squared_error(shown, right, part);
    };
    Figure figure{what, 0};
    figure.now = std::sqrt(over_seeds(sampler, settings, rate, measure));
    figure.uniform = std::sqrt(over_seeds(sampler, uniform_settings(usual), rate, measure));
    figure.jittered =
        std::sqrt(over_jittered(sampler, field.width, field.height, 1, rate, measure));
    figures.push_back(figure);
  }
  return figures;
}

// Keys and names of what is steered.
std::string key_of(std::string key, bool steered) { return key + (steered ? ".steer" : ""); }
std::string name_of(std::string name, bool steered) {
  return name + (steered ? ", steered as displayed" : "");
}

Case encoded_case(double factor, bool steered) {
  const std::string times = std::to_string(factor).substr(0, 4);
  return {key_of("V14.dark" + times, steered),
          name_of("left half " + times + " times as bright", steered),
          {1, 4, 16},
          [=](double rate) { return encoded_figures(dark_half(factor), rate, steered); }};
}

// Relative to jittered samples: of each part the geometric mean over members, then the worst.
Case dark_members_case(bool steered) {
  const auto measure = [steered](double rate) {
    constexpr std::uint64_t members = 32;
    std::vector<double> sums, worst;
    for (std::uint64_t number = 1; number <= members; ++number) {
      const auto figures = encoded_figures(random_dark_half(table_seed, number), rate, steered);
      sums.resize(figures.size());
      worst.resize(figures.size());
      for (std::size_t k = 0; k < figures.size(); ++k) {
        const double ratio =
            std::max(figures[k].now, least_error) / std::max(figures[k].jittered, least_error);
        sums[k] += std::log(ratio) / static_cast<double>(members);
        worst[k] = std::max(worst[k], ratio);
      }
    }
    const auto mean_of = [&](std::size_t part) { return std::exp(sums[part]); };
    return std::vector<Figure>{
        {"left half: RMSE / jittered, geometric mean", none, mean_of(0)},
        {"left half: RMSE / jittered, worst", none, worst[0]},
        {"left half away from the border: RMSE / jittered, geometric mean", none, mean_of(1)},
        {"left half away from the border: RMSE / jittered, worst", none, worst[1]},
        {"RMSE / jittered, geometric mean", none, mean_of(2)}};
  };
  return {key_of("K6.functions", steered),
          name_of("32 random functions with a dark half", steered),
          {1, 4, 16},
          measure};
}

}  // namespace

Kind display_errors() {
  Kind kind{"K6",
            "What is seen is not linear",
            "Linear light is sampled and averaged, but the picture is shown in sRGB, where errors "
            "in dark parts count more. Each case is told twice: with the default, which compares "
            "linear errors, and with priority.steer = Steer::display. Samples on the border of the "
            "two halves are bright and belong to blocks of both: what they do to dark pixels is no "
            "question of where samples are taken, so errors away from that border are told too.",
            {}};
  for (const bool steered : {false, true}) {
    for (const double factor : {0.1, 0.03, 0.01}) {
      kind.cases.push_back(encoded_case(factor, steered));
    }
    kind.cases.push_back(dark_members_case(steered));
  }
  return kind;
}

}  // namespace field_cases
