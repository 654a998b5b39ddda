// SPDX-License-Identifier: MIT
/// \file
/// What a run took, in words and as JSON.
#pragma once

#include <cstdint>
#include <string>

#include "leader.h"
#include "options.h"
#include "packet.h"

namespace farm {

/// A run and its figures.
struct RunFigures {
  const Options& options;
  std::uint64_t samples;  ///< of the picture
  std::uint64_t waves;    ///< of its engine
  double seconds;         ///< wall clock
  const PacketFormat& format;
  const Figures& figures;
};

/// A line that tells of it.
[[nodiscard]] std::string as_text(const RunFigures& run);
/// All of it.
[[nodiscard]] std::string as_json(const RunFigures& run);

}  // namespace farm
