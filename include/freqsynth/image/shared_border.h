// SPDX-License-Identifier: MIT
/// \file
/// Edges that lie on the border of a block.
///
/// Samples on the border belong to the blocks on both sides of it. Where an edge lies just there,
/// as in pictures that are made of tiles, they show one side of it, and the fit of the other side's
/// block carries that through all of the block. Beside a bright part a dark one is spoilt by it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// How much the samples on each side of a block's border count for the pixels along it.
class FREQSYNTH_API SharedBorder {
 public:
  /// One more sample of the sequence.
  void add(const SequencePosition& position, const detail::SampleRow& row);

  /// The samples of a block that show what lies beyond an edge on its border, each with about the
  /// value that it had; none where there is no such edge.
  /// \param fit   of all samples that were added, none of which was a gap
  /// \param list  that they are of
  [[nodiscard]] std::vector<Gap> foreign(const BlockFit& fit, const BlocksMeans& means,
                                         const InverseList& list) const;

 private:
  static constexpr std::size_t sides = 4;  // left, right, top, bottom
  using Line = std::array<float, block_size>;
  // So many samples do not miss what reaches farther into the block.
  static constexpr std::uint32_t enough = 24;

  static std::array<bool, sides> touched(const SequencePosition& position) {
    return {position.s == 0, position.s == 1, position.t == 0, position.t == 1};
  }
  /// The pixel that is `deep` pixels within a side.
  static std::size_t pixel_at(std::size_t side, std::size_t along, std::size_t deep) {
    const std::size_t across = side % 2 == 0 ? deep : block_size - 1 - deep;
    return side < 2 ? along * block_size + across : across * block_size + along;
  }
  [[nodiscard]] std::optional<Line> beyond(const BlockFit& fit, const BlocksMeans& means,
                                           std::size_t side) const;

  std::uint32_t samples_ = 0;
  std::array<float, max_terms> weights_ = {};     // of all samples in each pixel
  std::array<Line, sides> border_ = {};           // of those on a side, along it
  std::array<std::uint32_t, sides> within_ = {};  // samples that lie in a side's pixels
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/shared_border.inl"
#endif
