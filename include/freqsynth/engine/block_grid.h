/// \file
/// The blocks of an image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Number of blocks, and the size in pixels checked against overflow.
struct BlockGrid {
  std::size_t blocks_x = 0, blocks_y = 0;

  /// \throws std::invalid_argument naming the sizes when channels is 0, there would be 2^32 - 1
  ///         blocks or more, or the coefficients would not be addressable.
  static BlockGrid of(std::size_t width, std::size_t height, std::size_t channels);
};

// ------------------------------------------------------------------------------------ definitions

inline BlockGrid BlockGrid::of(std::size_t width, std::size_t height, std::size_t channels) {
  const auto refuse = [&](const char* why) {
    throw std::invalid_argument("freqsynth: image of " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels with " +
                                std::to_string(channels) + " channels " + why);
  };
  if (channels == 0) refuse("has no channel");
  const std::size_t x = width / block_size + (width % block_size != 0);
  const std::size_t y = height / block_size + (height % block_size != 0);
  if (x == 0 || y == 0) return {0, 0};
  constexpr std::size_t most_blocks = std::numeric_limits<std::uint32_t>::max() - 1;
  if (x > most_blocks / y) refuse("has too many blocks");
  constexpr std::size_t most_floats =
      static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(float);
  if (channels > most_floats / max_terms / (x * y)) refuse("is too large");
  return {x, y};
}

}  // namespace freqsynth
