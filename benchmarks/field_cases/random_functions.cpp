// SPDX-License-Identifier: MIT
#include "case.h"
#include "members.h"

namespace field_cases {

Kind random_functions() {
  return {
      "F",
      "Random functions, and equal samples everywhere",
      "100 functions, each a sum of 2 to 6 edges, discs, gratings of hard bars, smooth gratings "
      "and gradients. What must not happen, here and above: a picture that is worse than that "
      "of the same engine with equal samples in every block (\"uniform\").",
      {members_case("F.functions", "100 random functions", random_function, 100, {0.25, 1, 4})}};
}

}  // namespace field_cases
