// SPDX-License-Identifier: MIT
#include "case.h"
#include "members.h"
#include "named_fields.h"

namespace field_cases {

Kind lattice_patterns() {
  Kind kind{"K3",
            "Patterns that repeat with the samples",
            "A fence whose posts lie as far apart as the samples: each sample sees the same, and "
            "nothing tells that the picture is wrong. Right is the mean everywhere.",
            {}};
  for (const double period : {1.0, 0.5, 0.25}) {
    const std::string name = "fence, period " + std::to_string(period).substr(0, 4) + " px";
    const Field field = fence(period);
    kind.cases.push_back({"V8.fence" + std::to_string(period).substr(0, 4),
                          name,
                          {0.25, 1, 4, 16},
                          [field](double rate) {
                            const Sampler sampler = sampler_of(field);
                            Figure level{"mean", 0.2};
                            level.now = over_seeds(sampler, settings_of(64, 64), rate, mean);
                            level.jittered = over_jittered(sampler, 64, 64, 1, rate, mean);
                            return std::vector{level, rmse_figure(field, rate)};
                          }});
  }
  kind.cases.push_back(
      members_case("K3.fences", "48 random fences", random_fence, 48, {0.25, 1, 4, 16}));
  return kind;
}

}  // namespace field_cases
