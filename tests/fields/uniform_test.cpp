// SPDX-License-Identifier: MIT
// Random functions of every sort.

#include "fields/field_helpers.h"

namespace {

TEST(RandomFunctions, AreBetterThanJittered) {
  helpers::expect_not_above_jittered(field_cases::random_function, 32);
}

}  // namespace
