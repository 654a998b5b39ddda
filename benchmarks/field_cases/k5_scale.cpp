// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "members.h"
#include "named_fields.h"

namespace field_cases {
namespace {

// RMSE of channel 0, whose weight is 1, beside a channel whose weight is 0 and whose values are of
// size `scale`.
Case unweighted_case(double scale, const std::string& name) {
  return {
      "V11.aside" + name,
      "beside a channel of weight 0 with values up to " + name,
      {0.5, 1, 2},
      [scale](double rate) {
        const Field field = ramp_and_busy_corner();
        const std::vector<double> right = right_pixels(field);
        const Sampler sampler = [&](double x, double y, std::uint64_t, std::span<float> values) {
          values[0] = static_cast<float>(field.value(x, y));
          values[1] = static_cast<float>(scale / 2 * (1 + std::sin(0.05 * x) * std::cos(0.03 * y)));
        };
        auto settings = settings_of(256, 256);
        settings.channels = 2;
        settings.channel_settings = {{}, {freqsynth::ChannelRole::passive}};
        const Measure measure = [&](const Picture& p) { return squared_error(p, right); };
        Figure figure{"RMSE of channel 0"};
        figure.right =
            std::sqrt(over_seeds(sampler_of(field), settings_of(256, 256), rate, measure));
        figure.now = std::sqrt(over_seeds(sampler, settings, rate, measure));
        figure.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, measure));
        figure.jittered = std::sqrt(over_jittered(sampler, 256, 256, 2, rate, measure));
        return std::vector{figure};
      }};
}

// The same function in other units: RMSE in that unit.
Figure unit_figure(const Field& field, double unit, double rate) {
  const std::vector<double> right = right_pixels(field);
  const auto error_in = [&](double of) {
    return [&right, of](const Picture& p) {
      double sum = 0;
      for (std::size_t k = 0; k < right.size(); ++k) {
        const double error = static_cast<double>(p.pixels[k]) / of - right[k];
        sum += error * error;
      }
      return sum / static_cast<double>(right.size());
    };
  };
  const Sampler plain = sampler_of(field);
  const Sampler sampler = [&](double x, double y, std::uint64_t, std::span<float> values) {
    values[0] = static_cast<float>(unit * field.value(x, y));
  };
  Figure figure{"RMSE in that unit"};
  const auto settings = settings_of(field.width, field.height);
  figure.right = std::sqrt(over_seeds(plain, settings, rate, error_in(1)));
  figure.now = std::sqrt(over_seeds(sampler, settings, rate, error_in(unit)));
  figure.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, error_in(unit)));
  figure.jittered =
      std::sqrt(over_jittered(plain, field.width, field.height, 1, rate, error_in(1)));
  return figure;
}

Case unit_case(const std::string& key, const std::string& name, const Field& field, double unit) {
  return {key, name, {1}, [field, unit](double rate) {
            return std::vector{unit_figure(field, unit, rate)};
          }};
}

Case unit_members_case() {
  return {"K5.functions", "32 random functions in units of 1e-30 .. 1e30", {1}, [](double rate) {
            double least = 1, most = 1;
            for (std::uint64_t number = 1; number <= 32; ++number) {
              const double unit = std::pow(10.0, Draw(~table_seed, number).real(-30, 30));
              const Figure f = unit_figure(random_function(table_seed, number), unit, rate);
              least = std::min(least, f.now / f.right);
              most = std::max(most, f.now / f.right);
            }
            return std::vector<Figure>{{"RMSE / that in units of 1, least", 1, least},
                                       {"RMSE / that in units of 1, greatest", 1, most}};
          }};
}

// exp(-((x - x0)^2 + (y - y0)^2) / s), averaged with the error function.
struct Bell {
  double x = 0, y = 0, s = 1;

  [[nodiscard]] double value(double at_x, double at_y) const {
    return std::exp(-((at_x - x) * (at_x - x) + (at_y - y) * (at_y - y)) / s);
  }
  [[nodiscard]] double average(double i, double j) const { return along(i - x) * along(j - y); }

 private:
  [[nodiscard]] double along(double t) const {
    const double width = std::sqrt(s);
    return width * std::sqrt(std::numbers::pi) / 2 *
           (std::erf((t + 1) / width) - std::erf(t / width));
  }
};

}  // namespace

Kind scales() {
  Kind kind{
      "K5",
      "Units and weights",
      "The same function in other units must give the same picture, and a channel with weight "
      "0 must not change the others, whatever its values. Right is the error in units of 1, "
      "or without the other channel.",
      {}};
  for (const auto& [scale, name] :
       {std::pair{0.0, "0"}, {20.0, "20"}, {2e3, "2e3"}, {2e6, "2e6"}, {2e9, "2e9"}}) {
    kind.cases.push_back(unweighted_case(scale, name));
  }
  const Field dark = product_field("dark", 64, 64, 0, {});
  const Field bell = plus(dark, 1, Bell{32, 30, 400});
  for (const auto& [unit, name] :
       {std::pair{1.0, "1"}, {2e15, "2e15"}, {5e19, "5e19"}, {1e30, "1e30"}}) {
    kind.cases.push_back(
        unit_case(std::string("V12.bell") + name, std::string("bell, unit ") + name, bell, unit));
  }
  const Field bell_and_edge = plus(plus(dark, 1, Bell{32, 30, 100}), 0.5, HalfPlane{-1, -1, -80});
  for (const auto& [unit, name] : {std::pair{1.0, "1"}, {3e-18, "3e-18"}, {1e-30, "1e-30"}}) {
    kind.cases.push_back(unit_case(std::string("V13.edge") + name,
                                   std::string("bell and edge, unit ") + name, bell_and_edge,
                                   unit));
  }
  for (const auto& [unit, name] : {std::pair{1.0, "1"},
                                   {5e14, "5e14"},
                                   {1e-11, "1e-11"},
                                   {1e-14, "1e-14"},
                                   {1e-16, "1e-16"},
                                   {1e-18, "1e-18"},
                                   {1e-30, "1e-30"}}) {
    kind.cases.push_back(unit_case(std::string("V13.ramp") + name,
                                   std::string("ramp and busy corner, unit ") + name,
                                   ramp_and_busy_corner(), unit));
  }
  kind.cases.push_back(unit_members_case());
  return kind;
}

}  // namespace field_cases
