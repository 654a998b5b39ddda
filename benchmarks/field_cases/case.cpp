// SPDX-License-Identifier: MIT
#include "case.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace field_cases {

Figure rmse_figure(const Field& field, double rate, const Columns& columns, std::uint64_t seeds,
                   std::uint64_t of_jittered) {
  const Sampler sampler = sampler_of(field);
  const std::vector<double> right = right_pixels(field);
  const Measure measure = [&](const Picture& p) { return squared_error(p, right, columns); };
  const auto settings = settings_of(field.width, field.height);
  Figure figure{"RMSE", 0};
  figure.now = std::sqrt(over_seeds(sampler, settings, rate, measure, seeds));
  figure.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, measure, seeds));
  figure.jittered =
      std::sqrt(over_jittered(sampler, field.width, field.height, 1, rate, measure, of_jittered));
  return figure;
}

Case rmse_case(std::string key, std::string name, const Field& field, std::vector<double> rates) {
  return {std::move(key), std::move(name), std::move(rates),
          [field](double rate) { return std::vector{rmse_figure(field, rate)}; }};
}

Case members_case(std::string key, std::string name, Family family, std::uint64_t count,
                  std::vector<double> rates) {
  return {std::move(key), std::move(name), std::move(rates),
          [family = std::move(family), count](double rate) {
            double sum = 0, worst = 0, uniform_sum = 0, uniform_worst = 0;
            for (std::uint64_t number = 1; number <= count; ++number) {
              const Figure f = rmse_figure(family(table_seed, number), rate, {}, 2, jittered_seeds);
              const double now = std::max(f.now, least_error);
              const double ratio = now / std::max(f.jittered, least_error);
              const double uniform = now / std::max(f.uniform, least_error);
              sum += std::log(ratio);
              worst = std::max(worst, ratio);
              uniform_sum += std::log(uniform);
              uniform_worst = std::max(uniform_worst, uniform);
            }
            const auto n = static_cast<double>(count);
            return std::vector<Figure>{
                {"RMSE / jittered, geometric mean", none, std::exp(sum / n)},
                {"RMSE / jittered, worst", none, worst},
                {"RMSE / uniform, geometric mean", none, std::exp(uniform_sum / n)},
                {"RMSE / uniform, worst", none, uniform_worst}};
          },
          true};
}

}  // namespace field_cases
