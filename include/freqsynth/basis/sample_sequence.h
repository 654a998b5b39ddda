// SPDX-License-Identifier: MIT
/// \file
/// The quad-tree sample sequence that all blocks share (paper, section 4.3.1).
///
/// Four corners, then level by level of a quad-tree over the block: the centres of all nodes, then
/// of every node one of the middles of its top and right border (chosen at random), then the other
/// one. A position on the block's own border is followed at once by its partner on the opposite
/// border, so that level k is complete, a regular lattice of (2^k + 1)^2 points, after as many
/// samples.
///
/// On that lattice whole columns of samples lie under each other, and edges along an axis and
/// patterns that repeat with it are measured wrong however many samples there are. So by default
/// the lattice is bent (SamplePositions::bent): by a smooth flow that nearly preserves areas, so
/// that it stays about as even as it was, and along the borders the same on both sides. Points on a
/// border stay on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/list_settings.h"

namespace freqsynth {

/// Where on the block a position lies. Positions on a border belong to every block they touch.
enum class BlockSide : std::uint8_t { interior, corner, left, right, top, bottom };

/// One position of the sequence.
struct SequencePosition {
  double s = 0;  ///< horizontal place in the unit block, 0 = left border, 1 = right border
  double t = 0;  ///< vertical place in the unit block, 0 = top border, 1 = bottom border
  BlockSide side = BlockSide::interior;  ///< where on the block it lies
  /// How many earlier positions lie on the same side. Partners on opposite sides have the same
  /// rank, so that "the k-th point of an edge" means the same to both blocks. For corners: 0..3 in
  /// the order (0,0) (1,1) (1,0) (0,1).
  std::uint32_t rank = 0;
  /// Index of the same point as seen from the block across this border. Positions in the interior
  /// and the corners (which have three) are their own partner; see corner_at().
  std::uint32_t partner = 0;
  /// Distance to the nearest earlier positions of the sequence in units of the block's edge; on a
  /// bent lattice about that.
  float spacing = 1;
};

/// The sequence itself: the same for the same seed, grown on demand. Not thread-safe while growing.
class FREQSYNTH_API SampleSequence {
 public:
  /// \param seed       of the random choices
  /// \param positions  where the samples lie
  explicit SampleSequence(std::uint64_t seed = 0, SamplePositions positions = SamplePositions::bent)
      : seed_(seed), kind_(positions) {}

  /// Position `index`; grows the sequence as far as needed (by whole levels, amortised O(1)). The
  /// reference is valid until the sequence grows again.
  /// \throws std::invalid_argument when index >= max_size, std::bad_alloc; nothing has changed then.
  const SequencePosition& operator[](std::size_t index);

  /// Number of positions known so far.
  [[nodiscard]] std::size_t size() const { return positions_.size(); }

  /// Seed of the random choices.
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /// Index (0..3) of the corner at s = right, t = bottom.
  [[nodiscard]] static constexpr std::size_t corner_at(bool right, bool bottom) {
    return right ? (bottom ? 1 : 2) : (bottom ? 3 : 0);
  }

  /// How many samples it takes until they are even for the `step`-th time, counted from 0: 1, then
  /// the 4 corners, then by turns with the centres of all nodes of a level and with the whole
  /// level, which makes 5, 9, 13, 25, 41, 81 and so on.
  [[nodiscard]] static constexpr std::size_t even_size(std::size_t step) {
    if (step == 0) return 1;
    const std::size_t nodes = std::size_t{1} << (step / 2 - (step % 2 == 0 ? 1 : 0));
    const std::size_t centres = step % 2 == 0 ? nodes * nodes : 0;
    return (nodes + 1) * (nodes + 1) + centres;
  }

  /// Most positions of the block's own border that follow each other, partners included: so many
  /// samples a block can get from its neighbours without one of its own.
  static constexpr std::size_t longest_border_run = 6;

  /// Positions of the finest level that is kept: 1025 x 1025.
  static constexpr std::size_t max_size = std::size_t{1025} * 1025;

 private:
  void append_level();
  void append(double s, double t, float spacing);
  static void bend(SequencePosition& position);

  std::uint64_t seed_;
  SamplePositions kind_;
  std::uint32_t level_ = 0;
  std::uint32_t ranks_[6] = {};  // positions so far on each BlockSide
  std::vector<SequencePosition> positions_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/sample_sequence.inl"
#endif
