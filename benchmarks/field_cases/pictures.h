// SPDX-License-Identifier: MIT
/// \file
/// Pictures of some cases, enlarged, to look at.
#pragma once

#include <string>

namespace field_cases {

/// Writes PNG files into a folder, which is made: of each case right, now and jittered side by
/// side.
/// \throws std::runtime_error naming the file and the reason.
void write_pictures(const std::string& folder);

}  // namespace field_cases
