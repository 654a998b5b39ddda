// SPDX-License-Identifier: MIT
/// \file
/// What there is to say of blocks, as pictures with a pixel for each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/freqsynth.h"

namespace live {

/// Values of blocks, row by row.
struct BlockMap {
  std::size_t columns = 0, rows = 0;
  std::vector<float> values;
};

/// The samples of the blocks of an image.
[[nodiscard]] BlockMap samples_of(const freqsynth::FrequencyImage& image);

/// The error that each block is expected to have, root mean square over its pixels and the channels
/// that are shown, in levels of 255 at an exposure of 1.
[[nodiscard]] BlockMap errors_of(const freqsynth::Synthesizer& engine);

/// The bytes of a JPEG file in gray: the root of the values, white from `white` on.
[[nodiscard]] std::vector<std::uint8_t> map_jpeg(const BlockMap& map, double white);

}  // namespace live
