// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "case.h"
#include "members.h"

namespace field_cases {
namespace {

// The RMSE with that share of bad samples. Right is that of so many fewer samples, all good.
Figure bad_figure(const Field& field, double share, double rate) {
  const Sampler good = sampler_of(field);
  const Sampler sampler = [&](double x, double y, std::uint64_t id, std::span<float> values) {
    good(x, y, id, values);
    if (is_bad_place(x, y, share)) values[0] = std::numeric_limits<float>::quiet_NaN();
  };
  const std::vector<double> right = right_pixels(field);
  const Measure error = [&](const Picture& p) { return squared_error(p, right); };
  const auto settings = settings_of(field.width, field.height);
  Figure rmse{"RMSE"};
  rmse.right = std::sqrt(over_seeds(good, settings, (1 - share) * rate, error));
  rmse.now = std::sqrt(over_seeds(sampler, settings, rate, error));
  rmse.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, error));
  rmse.jittered = std::sqrt(over_jittered(sampler, field.width, field.height, 1, rate, error));
  return rmse;
}

}  // namespace

Kind bad_samples() {
  Kind kind{"K10",
            "Samples that are not numbers",
            "One in k samples is not a number, scattered over the picture. Right is what as many "
            "good samples give when none is bad (the rate times 1 - 1 / k); jittered samples leave "
            "the bad ones out.",
            {}};
  const Field field = rows_field("bars", 128, 128,
                                 [](double y) { return sine_above(0.3, 0.01 * y * y, 0, 1, 0.2); });
  for (const int k : {0, 2, 4, 20}) {
    const double share = k > 0 ? 1.0 / k : 0;
    kind.cases.push_back(
        {"V16.bad" + std::to_string(k),
         k > 0 ? "one bad sample in " + std::to_string(k) : "no bad samples",
         {1, 4},
         [field, share](double rate) { return std::vector{bad_figure(field, share, rate)}; }});
  }
  kind.cases.push_back(
      {"K10.functions", "32 random functions, 1 to 6 of 10 samples bad", {1, 4}, [](double rate) {
         double sum = 0, worst = 0;
         for (std::uint64_t number = 1; number <= 32; ++number) {
           const double share = 0.1 * static_cast<double>(1 + number % 6);
           const Figure f = bad_figure(random_function(table_seed, number), share, rate);
           const double ratio = f.now / f.right;
           sum += std::log(ratio);
           worst = std::max(worst, ratio);
         }
         return std::vector<Figure>{{"RMSE / right RMSE, geometric mean", 1, std::exp(sum / 32)},
                                    {"RMSE / right RMSE, worst", 1, worst}};
       }});
  return kind;
}

}  // namespace field_cases
