// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>

namespace quality {

/// Writes how wrong the tree is on the field cases (benchmarks/field_cases) beside Synthesizer and
/// jittered samples: a Markdown table of named ones, and one of `members` random ones of each
/// family.
void write_tree_fields(std::uint64_t members, std::FILE* out);

}  // namespace quality
