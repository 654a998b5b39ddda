// SPDX-License-Identifier: MIT
/// \file
/// Where the samples of nodes lie: of blocks, and of the quadrants that blocks are split into.
///
/// Every node has the paper's sequence over its own unit square (sample_sequence.h), on the plain
/// lattice. A lattice of (2^k + 1)^2 points of a node is made of the lattices of (2^(k-1) + 1)^2
/// points of its quadrants: what a node knows after 81 or 289 samples are the first 25 or 81 of
/// each quadrant.
///
/// On a lattice whole columns of samples lie under each other, and are blind to what repeats with
/// it, however many there are. So samples are moved by a share of their lattice's spacing. Those on
/// the border of a block stay on it, and are moved as far as their partners on the opposite side;
/// its corners stay.
///
/// A block's first 81, at the corners of its pixels, are moved at random. Its quadrants, and
/// theirs, find these where they are, in a frame of their own. All finer lattices are moved in a
/// pattern that is the same for each of them but for its size (and somewhat less for that of half
/// pixels), and that repeats after `period` cells. So deeper nodes need a list for each place in
/// that pattern alone; their own corners stay. There are 1 + 4 + 16 lists of positions, 16 for
/// pixels, and 16 for all smaller nodes.
///
/// A sample's home is where it would lie on the plain lattice. Nodes that touch its home share it,
/// wherever it has been moved to.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// A position of a node, in whole steps of which NodePositions::edge are its edge. The first
/// positions of a quadrant may lie a little beyond its square.
struct NodePosition {
  std::int32_t s = 0;  ///< steps to the right of the node's left border
  std::int32_t t = 0;  ///< steps below its top border

  /// Whether both are the same.
  friend bool operator==(const NodePosition& a, const NodePosition& b) {
    return a.s == b.s && a.t == b.t;
  }
};

/// The positions of all nodes, by class. Class 0 is that of blocks.
class FREQSYNTH_API NodePositions {
 public:
  /// Steps of a node's edge.
  static constexpr std::int32_t edge = std::int32_t{1} << 14;
  /// Positions that each class has: the lattice of 33 x 33.
  static constexpr std::size_t size = 1089;
  /// Those of a block that are moved at random.
  static constexpr std::size_t moved = 81;
  /// Cells along an axis after which the moves of a finer lattice repeat: a power of two.
  static constexpr std::size_t period = 4;
  /// No index.
  static constexpr std::uint32_t none = 0xffffffffu;

  /// \param seed          of the sequence's random choices, and of the moves
  /// \param perturbation  greatest move, as a share of the lattice's spacing, in [0, 0.45]
  /// \throws std::invalid_argument when it is not.
  explicit NodePositions(std::uint64_t seed = 0, double perturbation = 0);

  /// Number of classes: 53, or 4 when nothing is moved, one for each number of pixels.
  [[nodiscard]] std::size_t classes() const { return positions_.size(); }
  /// Class of a quadrant of a node: 0 the left upper one, 1 the right upper one, 2 and 3 below.
  [[nodiscard]] std::size_t quadrant_class(std::size_t of, std::size_t quadrant) const;
  /// Pixels along the edge of a node of a class in a block of 8 x 8: 8, 4, 2, 1; 1 as well where
  /// the node is smaller than a pixel.
  [[nodiscard]] std::size_t pixels(std::size_t of) const { return pixels_[of]; }

  /// The homes of all classes, `size` of them.
  [[nodiscard]] std::span<const NodePosition> homes() const { return homes_; }
  /// The positions of a class, `size` of them.
  [[nodiscard]] std::span<const NodePosition> of(std::size_t of) const { return positions_[of]; }
  /// Position of a class in units of the node's edge.
  [[nodiscard]] double s(std::size_t of, std::size_t index) const {
    return static_cast<double>(positions_[of][index].s) / edge;
  }
  /// The same, downwards.
  [[nodiscard]] double t(std::size_t of, std::size_t index) const {
    return static_cast<double>(positions_[of][index].t) / edge;
  }
  /// Distance to the nearest earlier positions in units of the node's edge, about.
  [[nodiscard]] float spacing(std::size_t index) const { return spacing_[index]; }

  /// Index of the sample whose home is a point of a node's own border, `none` when none is.
  [[nodiscard]] std::uint32_t index_at(const NodePosition& home) const;

  /// Samples of a quadrant that a node has which has had `samples`: 25 of 81, 81 of 289 and 289 of
  /// 1089. 0 of other numbers.
  [[nodiscard]] static constexpr std::size_t handed_down(std::size_t samples) {
    return samples == 81 ? 25 : samples == 289 ? 81 : samples == 1089 ? 289 : 0;
  }
  /// Index in a node of sample `index` < 289 of its quadrant.
  [[nodiscard]] std::uint32_t in_parent(std::size_t quadrant, std::size_t index) const {
    return in_parent_[quadrant][index];
  }
  /// Whether that is at the same place: it may not be at the corners of the deeper nodes, where
  /// those of their parents are moved.
  [[nodiscard]] bool same_place(std::size_t parent, std::size_t quadrant, std::size_t index) const;

  /// Whether a position lies on the border of its node.
  [[nodiscard]] static constexpr bool on_border(const NodePosition& p) {
    return p.s == 0 || p.t == 0 || p.s == edge || p.t == edge;
  }

 private:
  using List = std::vector<NodePosition>;
  struct Border {
    std::uint64_t key;
    std::uint32_t index;
  };
  static std::uint64_t key(const NodePosition& p) {
    return (std::uint64_t{static_cast<std::uint32_t>(p.t)} << 32) | static_cast<std::uint32_t>(p.s);
  }
  /// Where a node lies among those of its depth in the block.
  struct Spot {
    std::size_t depth, column, row;
  };
  static constexpr std::size_t repeats = period * period;
  // How far the new points of a cell are moved, in 32nds of their lattice's spacing: its centre,
  // the middle of its top, and that of its left side; each to the right, then downwards.
  using Pattern = std::array<std::array<std::int32_t, repeats>, 6>;
  // What is smooth or straight likes an even lattice best: that of half pixels is moved less.
  static constexpr double of_half = 2.0 / 3;
  void set_homes();
  void move(List& list, std::uint64_t seed, double perturbation) const;
  [[nodiscard]] static Pattern pattern_of(double perturbation);
  void follow_pattern(List& list, const Spot& spot) const;
  [[nodiscard]] List quadrant_of(const List& parent, std::size_t quadrant, const Spot& spot) const;
  void add(List list, std::size_t pixels);

  List homes_;
  std::vector<List> positions_;
  std::vector<std::size_t> pixels_;
  std::vector<float> spacing_;
  std::vector<Border> border_;  // homes on the border, sorted by key
  std::array<std::array<std::uint32_t, 289>, 4> in_parent_{};
  Pattern pattern_{}, half_pattern_{};
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/node_positions.inl"
#endif
