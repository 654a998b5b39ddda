// SPDX-License-Identifier: MIT
/// \file
/// A case: what is measured, at which rates, and what would be right.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "measure.h"

namespace field_cases {

/// Not measured, or without a meaning.
inline constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// One number that was measured.
struct Figure {
  std::string what;        ///< such as "RMSE", "mean"
  double right = none;     ///< what it should be
  double now = none;       ///< this library
  double jittered = none;  ///< jittered samples, as many
  double uniform = none;   ///< the same engine with equal samples in every block
};

/// One input at some rates. The key and `what` name a figure in before.txt.
struct Case {
  std::string key;   ///< such as "V4.checker8"
  std::string name;  ///< in plain words
  std::vector<double> rates;
  std::function<std::vector<Figure>(double rate)> measure;
  bool family = false;  ///< its figures are those of members_case(), in a table of their own
};

/// Inputs that fail for one reason.
struct Kind {
  std::string letter;  ///< such as "K2"
  std::string title;
  std::string text;  ///< what it is, in plain words
  std::vector<Case> cases;
};

/// The RMSE of a field, by all methods.
[[nodiscard]] Case rmse_case(std::string key, std::string name, const Field& field,
                             std::vector<double> rates);

/// The same figures at one rate.
[[nodiscard]] Figure rmse_figure(const Field& field, double rate, const Columns& columns = {},
                                 std::uint64_t seeds = synthesis_seeds,
                                 std::uint64_t of_jittered = jittered_seeds);

/// A family of random members: `make(seed, number)`.
using Family = std::function<Field(std::uint64_t seed, std::uint64_t number)>;

/// The RMSE of members 1 .. count relative to that of jittered samples, and to equal samples: of
/// each the geometric mean, then the worst. Errors below least_error count as that.
[[nodiscard]] Case members_case(std::string key, std::string name, Family family,
                                std::uint64_t count, std::vector<double> rates);

/// Errors that are told apart from none in members_case().
inline constexpr double least_error = 1e-3;
/// The seed of the members in the tables; tests take others.
inline constexpr std::uint64_t table_seed = 13;

// The kinds.
[[nodiscard]] Kind narrow_images();     // K1
[[nodiscard]] Kind axis_edges();        // K2
[[nodiscard]] Kind lattice_patterns();  // K3
[[nodiscard]] Kind small_features();    // K4
[[nodiscard]] Kind scales();            // K5
[[nodiscard]] Kind display_errors();    // K6
[[nodiscard]] Kind rare_hits();         // K7
[[nodiscard]] Kind bad_samples();       // K10
[[nodiscard]] Kind halos();             // K11
[[nodiscard]] Kind random_functions();  // never worse than uniform
/// All of them, in that order.
[[nodiscard]] std::vector<Kind> all_kinds();

}  // namespace field_cases
