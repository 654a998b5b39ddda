// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>

namespace quality {

/// Writes how wrong the tree is on the field cases (benchmarks/field_cases) beside Synthesizer and
/// jittered samples: a Markdown table of named ones, and one of `members` random ones of each
/// family.
void write_tree_fields(std::uint64_t members, std::FILE* out);

/// Writes how many of so many small discs at random places in flat parts, beside busy ones, the
/// tree misses, by TreeSettings::exploration: none of its samples lies on the disc.
void write_lost_discs(std::uint64_t places, std::FILE* out);

}  // namespace quality
