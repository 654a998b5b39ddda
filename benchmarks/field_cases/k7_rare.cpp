// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include "baselines/sampler.h"
#include "case.h"

namespace field_cases {

Kind rare_hits() {
  Kind kind{"K7",
            "Light of rare bright samples",
            "A Monte Carlo estimate that is 1 / p with probability p and else 0: its mean is 1 "
            "everywhere. What must not happen: a picture that is smooth and too dark.",
            {}};
  for (const auto& [p, name] : {std::pair{0.1, "0.1"}, {0.02, "0.02"}, {0.005, "0.005"}}) {
    kind.cases.push_back(
        {std::string("V15.hits") + name,
         std::string("hits with probability ") + name,
         {1, 4, 16},
         [p = p](double rate) {
           const Sampler sampler = [p](double, double, std::uint64_t id, std::span<float> values) {
             const double u = static_cast<double>(baselines::scatter(id) >> 11) * 0x1p-53;
             values[0] = u < p ? static_cast<float>(1 / p) : 0.0f;
           };
           auto settings = settings_of(96, 96);
           settings.noise = freqsynth::Noise::present;
           const std::vector<double> right(96 * 96, 1.0);
           const Measure error = [&](const Picture& picture) {
             return squared_error(picture, right);
           };
           // The noise of the mean itself is small only over many seeds.
           Figure level{"mean", 1};
           level.now = over_seeds(sampler, settings, rate, mean, 6);
           level.jittered = over_jittered(sampler, 96, 96, 1, rate, mean, 16);
           Figure rmse{"RMSE", 0};
           rmse.now = std::sqrt(over_seeds(sampler, settings, rate, error));
           rmse.jittered = std::sqrt(over_jittered(sampler, 96, 96, 1, rate, error));
           rmse.uniform = std::sqrt(over_seeds(sampler, uniform_settings(settings), rate, error));
           return std::vector{level, rmse};
         }});
  }
  return kind;
}

}  // namespace field_cases
