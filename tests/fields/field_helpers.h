// SPDX-License-Identifier: MIT
/// \file
/// What the property tests of the kinds share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "field_cases/case.h"
#include "field_cases/members.h"

namespace helpers {

/// Members that the tables do not show.
inline constexpr std::uint64_t member_seed = 77;

/// The RMSE of this library, over seeds.
inline double rmse(const field_cases::Sampler& sampler,
                   const freqsynth::SynthesisSettings& settings, double rate,
                   const std::vector<double>& right) {
  return std::sqrt(field_cases::over_seeds(
      sampler, settings, rate,
      [&](const field_cases::Picture& p) { return field_cases::squared_error(p, right); }));
}

inline double rmse(const field_cases::Field& field, double rate) {
  return rmse(field_cases::sampler_of(field), field_cases::settings_of(field.width, field.height),
              rate, right_pixels(field));
}

/// Members 1 .. count of a family, at 1, 4 and 16 samples per pixel: each at most 1.1 times as
/// wrong as jittered samples, and never more wrong with more samples. Errors below
/// field_cases::least_error are none.
inline void expect_not_above_jittered(const field_cases::Family& family, std::uint64_t count) {
  for (std::uint64_t number = 1; number <= count; ++number) {
    const field_cases::Field field = family(member_seed, number);
    const std::vector<double> right = right_pixels(field);
    const field_cases::Measure error = [&](const field_cases::Picture& p) {
      return field_cases::squared_error(p, right);
    };
    double before = std::numeric_limits<double>::infinity();
    for (const double rate : {1.0, 4.0, 16.0}) {
      const double now = std::max(rmse(field, rate), field_cases::least_error);
      const double jittered = std::sqrt(field_cases::over_jittered(
          field_cases::sampler_of(field), field.width, field.height, 1, rate, error));
      EXPECT_LE(now, 1.1 * std::max(jittered, field_cases::least_error))
          << field.name << " at " << rate;
      EXPECT_LE(now, before) << field.name << " grows up to " << rate;
      before = now;
    }
  }
}

}  // namespace helpers
