// SPDX-License-Identifier: MIT
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "baselines/sampler.h"
#include "case.h"

namespace field_cases {

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
    kind.cases.push_back(
        {"V16.bad" + std::to_string(k),
         k > 0 ? "one bad sample in " + std::to_string(k) : "no bad samples",
         {1, 4},
         [field, k](double rate) {
           const Sampler good = sampler_of(field);
           const Sampler sampler = [&](double x, double y, std::uint64_t id,
                                       std::span<float> values) {
             good(x, y, id, values);
             const std::uint64_t place = baselines::scatter(std::bit_cast<std::uint64_t>(x)) ^
                                         std::bit_cast<std::uint64_t>(y);
             if (k > 0 && baselines::scatter(place) % static_cast<std::uint64_t>(k) == 0) {
               values[0] = std::numeric_limits<float>::quiet_NaN();
             }
           };
           const std::vector<double> right = right_pixels(field);
           const Measure error = [&](const Picture& p) { return squared_error(p, right); };
           const auto settings = settings_of(128, 128);
           const double share = k > 0 ? 1 - 1.0 / k : 1;
           Figure rmse{"RMSE"};
           rmse.right = std::sqrt(over_seeds(good, settings, share * rate, error));
           rmse.now = std::sqrt(over_seeds(sampler, settings, rate, error));
           rmse.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, error));
           rmse.jittered = std::sqrt(over_jittered(sampler, 128, 128, 1, rate, error));
           return std::vector{rmse};
         }});
  }
  return kind;
}

}  // namespace field_cases
