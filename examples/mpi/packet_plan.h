// SPDX-License-Identifier: MIT
/// \file
/// How many requests a packet holds.
#pragma once

#include <cstddef>

namespace farm {

/// How requests are parcelled.
struct PacketSettings {
  std::size_t under_way = 2;    ///< packets to each rank at a time
  double least_seconds = 3e-4;  ///< that a packet takes to trace, for the mail's sake
  double most_seconds = 1e-2;   ///< for the sake of those that wait at the end of a wave
  std::size_t most_samples = 8192;
};

/// Requests of the next packet to a rank: half of what falls to it of the rest of the wave by its
/// speed, so that all ranks come to the end at about the same time; but at least what is worth a
/// letter.
/// \param left   requests of the wave that are to be handed out, >= 1
/// \param speed  samples that the rank traces in a second, > 0
/// \param all    the same of all ranks together, >= speed
/// \return 1..left
[[nodiscard]] std::size_t packet_size(const PacketSettings& settings, std::size_t left,
                                      double speed, double all);

}  // namespace farm
