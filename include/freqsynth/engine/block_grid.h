// SPDX-License-Identifier: MIT
/// \file
/// The blocks of an image: where they lie, and which of them share points and edges.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

namespace detail {

/// Length in pixels (1..8) of block `block` along an axis of `pixels` pixels: 8, or what is left of
/// the image.
[[nodiscard]] constexpr std::size_t block_length(std::size_t block, std::size_t pixels) {
  const std::size_t left = pixels - block * block_size;
  return left < block_size ? left : block_size;
}

}  // namespace detail

/// A part of a picture, in whole pixels of it.
struct PixelWindow {
  std::size_t x = 0;       ///< pixels to the left of it
  std::size_t y = 0;       ///< pixels above it
  std::size_t width = 0;   ///< pixels
  std::size_t height = 0;  ///< pixels
};

/// The grid of blocks, numbered row by row. They tile the image exactly: the last column and the
/// last row are as narrow as what is left of it, and their unit square is stretched over that.
struct BlockGrid {
  std::size_t blocks_x = 0;  ///< in a row
  std::size_t blocks_y = 0;  ///< in a column
  std::size_t width = 0;     ///< pixels
  std::size_t height = 0;    ///< pixels

  /// The picture that the grid covers some of, all of it when its width is 0.
  struct Frame {
    std::size_t width = 0;   ///< pixels
    std::size_t height = 0;  ///< pixels
    std::size_t left = 0;    ///< columns of blocks to the left of the grid
    std::size_t top = 0;     ///< rows of blocks above the grid
  };
  /// Points and names are those of the frame, so that they do not depend on what is covered.
  Frame frame = {};

  /// The grid of an image.
  /// \throws std::invalid_argument naming the sizes when channels is 0, there would be 2^32 - 1
  ///         blocks or more, or the coefficients would not be addressable.
  FREQSYNTH_API static BlockGrid of(std::size_t width, std::size_t height, std::size_t channels);
  /// The grid of all blocks that a part of this one, which is no part itself, has pixels of, and of
  /// `margin` more on each side where there are so many. The part is not empty and lies within.
  [[nodiscard]] BlockGrid part(const PixelWindow& window, std::size_t margin) const;

  /// \throws std::invalid_argument when a part is empty or does not lie within the pixels.
  FREQSYNTH_API void check(const PixelWindow& window) const;

  /// Whether the grid covers some of a frame only.
  [[nodiscard]] bool is_part() const { return frame.width != 0; }
  /// What is covered of the frame.
  [[nodiscard]] PixelWindow covered() const {
    return {frame.left * block_size, frame.top * block_size, width, height};
  }
  /// The grid of the frame.
  [[nodiscard]] BlockGrid whole() const;
  /// Number in the frame of a block.
  [[nodiscard]] std::size_t in_frame(std::size_t block) const {
    if (!is_part()) return block;
    return (row(block) + frame.top) * whole().blocks_x + column(block) + frame.left;
  }

  /// Number of blocks.
  [[nodiscard]] std::size_t size() const { return blocks_x * blocks_y; }
  // There are less than 2^32 blocks: see of(). Division of short numbers is much faster.
  /// Column of a block, from the left.
  [[nodiscard]] std::size_t column(std::size_t block) const {
    return static_cast<std::uint32_t>(block) % static_cast<std::uint32_t>(blocks_x);
  }
  /// Row of a block, from the top.
  [[nodiscard]] std::size_t row(std::size_t block) const {
    return static_cast<std::uint32_t>(block) / static_cast<std::uint32_t>(blocks_x);
  }

  /// Width of a block in pixels, 1..8.
  [[nodiscard]] std::size_t block_width(std::size_t block) const {
    return detail::block_length(column(block), width);
  }
  /// Height of a block in pixels, 1..8.
  [[nodiscard]] std::size_t block_height(std::size_t block) const {
    return detail::block_length(row(block), height);
  }
  /// Area of a block relative to that of 8 x 8 pixels, in (0, 1].
  [[nodiscard]] float area(std::size_t block) const {
    const std::size_t pixels = block_width(block) * block_height(block);
    return static_cast<float>(pixels) / static_cast<float>(block_size * block_size);
  }

  /// A point of the image, in pixels.
  struct Point {
    double x = 0;  ///< continuous pixels to the right
    double y = 0;  ///< continuous pixels downwards
  };
  /// Where a position of the sequence lies in a block, in the frame. Within the image; exactly on
  /// its border where the position is on that side of a last block.
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

inline BlockGrid::Point BlockGrid::point(std::size_t block,
                                         const SequencePosition& position) const {
  const std::size_t x = column(block);
  const std::size_t y = row(block);
  const auto place = [](std::size_t block_before, std::size_t pixels, double at) {
    const auto length = static_cast<double>(detail::block_length(block_before, pixels));
    return static_cast<double>(block_before * block_size) + at * length;
  };
  return {place(x, width, position.s) + static_cast<double>(frame.left * block_size),
          place(y, height, position.t) + static_cast<double>(frame.top * block_size)};
}

inline BlockGrid BlockGrid::whole() const {
  if (!is_part()) return *this;
  const auto blocks = [](std::size_t pixels) { return (pixels + block_size - 1) / block_size; };
  return {blocks(frame.width), blocks(frame.height), frame.width, frame.height};
}

inline BlockGrid BlockGrid::part(const PixelWindow& window, std::size_t margin) const {
  struct Range {
    std::size_t first, count, pixels;
  };
  const auto range = [margin](std::size_t begin, std::size_t length, std::size_t blocks,
                              std::size_t pixels) {
    FREQSYNTH_ASSERT(length > 0 && begin + length <= pixels);
    const std::size_t low = begin / block_size;
    const std::size_t high = (begin + length - 1) / block_size;
    const std::size_t first = low > margin ? low - margin : 0;
    const std::size_t last = margin < blocks - 1 - high ? high + margin : blocks - 1;
    const std::size_t end = last + 1 < blocks ? (last + 1) * block_size : pixels;
    return Range{first, last - first + 1, end - first * block_size};
  };
  const Range x = range(window.x, window.width, blocks_x, width);
  const Range y = range(window.y, window.height, blocks_y, height);
  if (x.count == blocks_x && y.count == blocks_y) return *this;
  return {x.count, y.count, x.pixels, y.pixels, {width, height, x.first, y.first}};
}

inline std::uint64_t BlockGrid::name(std::uint32_t block, std::uint32_t index,
                                     const SequencePosition& position) const {
  static_assert(SampleSequence::max_size < (std::size_t{1} << 21));
  if (is_part()) return whole().name(static_cast<std::uint32_t>(in_frame(block)), index, position);
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
