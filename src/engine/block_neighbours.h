/// \file
/// Which blocks share points and edges. Private.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

/// The blocks of an image, numbered row by row.
struct BlockNeighbours {
  std::uint32_t columns;
  std::uint32_t blocks;

  /// Calls visit(block, index) for every other block that has the point of `block` at this position
  /// of the sequence on its border.
  template <class Visitor>
  void visit_sharing(std::uint32_t block, const SequencePosition& position, Visitor&& visit) const;

  /// Calls visit(block) for each of the up to four blocks that share an edge with this one.
  template <class Visitor>
  void visit_beside(std::uint32_t block, Visitor&& visit) const;
};

// ------------------------------------------------------------------------------------ definitions

template <class Visitor>
void BlockNeighbours::visit_sharing(std::uint32_t block, const SequencePosition& position,
                                    Visitor&& visit) const {
  if (position.side == BlockSide::interior) return;
  const std::uint32_t x = block % columns;
  const bool has_left = x > 0;
  const bool has_right = x + 1 < columns;
  const bool has_top = block >= columns;
  const bool has_bottom = block + columns < blocks;
  switch (position.side) {
    case BlockSide::left:
      if (has_left) visit(block - 1, position.partner);
      break;
    case BlockSide::right:
      if (has_right) visit(block + 1, position.partner);
      break;
    case BlockSide::top:
      if (has_top) visit(block - columns, position.partner);
      break;
    case BlockSide::bottom:
      if (has_bottom) visit(block + columns, position.partner);
      break;
    default: {
      const bool right = position.s == 1;
      const bool bottom = position.t == 1;
      const bool across = right ? has_right : has_left;
      const bool down = bottom ? has_bottom : has_top;
      const std::uint32_t beside = right ? block + 1 : block - 1;
      const auto corner = [](bool r, bool b) {
        return static_cast<std::uint32_t>(SampleSequence::corner_at(r, b));
      };
      if (across) visit(beside, corner(!right, bottom));
      if (down) visit(bottom ? block + columns : block - columns, corner(right, !bottom));
      if (across && down) {
        visit(bottom ? beside + columns : beside - columns, corner(!right, !bottom));
      }
    }
  }
}

template <class Visitor>
void BlockNeighbours::visit_beside(std::uint32_t block, Visitor&& visit) const {
  const std::uint32_t x = block % columns;
  if (x > 0) visit(block - 1);
  if (x + 1 < columns) visit(block + 1);
  if (block >= columns) visit(block - columns);
  if (block + columns < blocks) visit(block + columns);
}

}  // namespace freqsynth
