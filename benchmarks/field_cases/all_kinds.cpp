// SPDX-License-Identifier: MIT
#include "case.h"

namespace field_cases {

std::vector<Kind> all_kinds() {
  return {narrow_images(),  axis_edges(), lattice_patterns(), small_features(), scales(),
          display_errors(), rare_hits(),  bad_samples(),      halos(),          random_functions()};
}

}  // namespace field_cases
