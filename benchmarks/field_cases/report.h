// SPDX-License-Identifier: MIT
/// \file
/// Measures the cases, and tells the figures as a table and as plain values.
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "case.h"

namespace field_cases {

/// The figures of one case at one rate.
struct Result {
  const Kind* kind = nullptr;
  const Case* field_case = nullptr;
  double rate = 0;
  std::vector<Figure> figures;
};

/// All cases at all their rates, on all processors, in the order of the tables. Writes a line per
/// case to `progress`.
[[nodiscard]] std::vector<Result> measure_all(const std::vector<Kind>& kinds,
                                              std::ostream& progress);

/// Figures by name, as write_values() wrote them: "key rate what".
using Values = std::map<std::string, double>;

/// Writes "key<TAB>rate<TAB>what<TAB>value" lines of what this library gives.
void write_values(const std::vector<Result>& results, std::ostream& out);

/// Reads such lines; those that begin with # are comments.
/// \throws std::runtime_error naming the line that is none of these.
[[nodiscard]] Values read_values(std::istream& in);

/// Writes the tables in Markdown.
void write_tables(const std::vector<Kind>& kinds, const std::vector<Result>& results,
                  const Values& before, std::ostream& out);

}  // namespace field_cases
