// SPDX-License-Identifier: MIT
/// \file
/// The settings that saved engines are fuzzed with: small and of all kinds.
#pragma once

#include <cstddef>
#include <vector>

#include "support/random_synthesis.h"

namespace fuzz {

inline std::vector<helpers::RandomSynthesis> syntheses() {
  std::vector<helpers::RandomSynthesis> all;
  const freqsynth::SharedInverseList list{freqsynth::InverseListSettings()};
  for (unsigned number = 0; all.size() < 24; ++number) {
    helpers::RandomSynthesis one(number);
    one.settings.width = 1 + one.settings.width % 13;
    one.settings.height = 1 + one.settings.height % 13;
    one.settings.importance.clear();
    one.settings.window = {};
    one.settings.max_samples_per_block = 10 + number % 5 * 40;
    one.settings.shared_list = list;
    all.push_back(one);
  }
  return all;
}

}  // namespace fuzz
