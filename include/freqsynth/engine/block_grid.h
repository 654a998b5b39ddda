// SPDX-License-Identifier: MIT
/// \file
/// The blocks of an image: where they lie, and which of them share points and edges.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

/// The grid of blocks, numbered row by row. The last ones of an image whose size is no multiple of
/// 8 reach beyond it.
struct BlockGrid {
  std::size_t blocks_x = 0;  ///< in a row
  std::size_t blocks_y = 0;  ///< in a column
  std::size_t width = 0;     ///< pixels
  std::size_t height = 0;    ///< pixels

  /// The grid of an image.
  /// \throws std::invalid_argument naming the sizes when channels is 0, there would be 2^32 - 1
  ///         blocks or more, or the coefficients would not be addressable.
  FREQSYNTH_API static BlockGrid of(std::size_t width, std::size_t height, std::size_t channels);

  /// Number of blocks.
  [[nodiscard]] std::size_t size() const { return blocks_x * blocks_y; }
  /// Column of a block, from the left.
  [[nodiscard]] std::size_t column(std::size_t block) const { return block % blocks_x; }
  /// Row of a block, from the top.
  [[nodiscard]] std::size_t row(std::size_t block) const { return block / blocks_x; }

  /// Share of the pixels of a block that the image shows, in (0, 1].
  [[nodiscard]] FREQSYNTH_API float visible_share(std::size_t block) const;

  /// A point of the image, in pixels.
  struct Point {
    double x = 0;  ///< continuous pixels to the right
    double y = 0;  ///< continuous pixels downwards
  };
  /// Where a position of the sequence lies for a block. What would lie beyond the image is
  /// reflected back into it.
  [[nodiscard]] Point point(std::size_t block, const SequencePosition& position) const;

  /// Names the point that is position `index` of a block: the same whichever block asks, and no two
  /// points have the same name.
  [[nodiscard]] std::uint64_t name(std::uint32_t block, std::uint32_t index,
                                   const SequencePosition& position) const;

  /// Calls visit(block, index) for every other block that has the point of `block` at this position
  /// of the sequence on its border.
  template <class Visitor>
  void visit_sharing(std::uint32_t block, const SequencePosition& position, Visitor&& visit) const;

  /// Calls visit(block) for each of the up to four blocks that share an edge with this one.
  template <class Visitor>
  void visit_beside(std::uint32_t block, Visitor&& visit) const;
};

// ------------------------------------------------------------------------------------ definitions

namespace detail {

/// Reflects a coordinate beyond `size` back into [0, size].
[[nodiscard]] FREQSYNTH_API double reflect(double x, double size);

}  // namespace detail

inline BlockGrid::Point BlockGrid::point(std::size_t block,
                                         const SequencePosition& position) const {
  Point point{(static_cast<double>(column(block)) + position.s) * block_size,
              (static_cast<double>(row(block)) + position.t) * block_size};
  const auto right = static_cast<double>(width);
  const auto bottom = static_cast<double>(height);
  // Positions beside a border that is the image's, too, may lie beyond it.
  if (point.x < 0) [[unlikely]] {
    point.x = -point.x;
  }
  if (point.y < 0) [[unlikely]] {
    point.y = -point.y;
  }
  if (point.x > right) [[unlikely]] {
    point.x = detail::reflect(point.x, right);
  }
  if (point.y > bottom) [[unlikely]] {
    point.y = detail::reflect(point.y, bottom);
  }
  return point;
}

inline std::uint64_t BlockGrid::name(std::uint32_t block, std::uint32_t index,
                                     const SequencePosition& position) const {
  static_assert(SampleSequence::max_size < (std::size_t{1} << 21));
  // That of the lowest block which has the point.
  std::uint64_t lowest = (std::uint64_t{block} << 21) | index;
  visit_sharing(block, position, [&](std::uint32_t other, std::uint32_t other_index) {
    const std::uint64_t name = (std::uint64_t{other} << 21) | other_index;
    if (name < lowest) lowest = name;
  });
  return lowest;
}

template <class Visitor>
void BlockGrid::visit_sharing(std::uint32_t block, const SequencePosition& position,
                              Visitor&& visit) const {
  if (position.side == BlockSide::interior) return;
  const auto columns = static_cast<std::uint32_t>(blocks_x);
  const std::uint32_t x = block % columns;
  const bool has_left = x > 0;
  const bool has_right = x + 1 < columns;
  const bool has_top = block >= columns;
  const bool has_bottom = std::size_t{block} + columns < size();
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
void BlockGrid::visit_beside(std::uint32_t block, Visitor&& visit) const {
  const auto columns = static_cast<std::uint32_t>(blocks_x);
  const std::uint32_t x = block % columns;
  if (x > 0) visit(block - 1);
  if (x + 1 < columns) visit(block + 1);
  if (block >= columns) visit(block - columns);
  if (std::size_t{block} + columns < size()) visit(block + columns);
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/block_grid.inl"
#endif
