// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

FREQSYNTH_INLINE NodePositions::NodePositions(std::uint64_t seed, double perturbation) {
  detail::require(perturbation >= 0 && perturbation <= 0.45, "perturbation", perturbation,
                  "in [0, 0.45]");
  SampleSequence sequence(seed, SamplePositions::lattice);
  homes_.reserve(size);
  spacing_.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const SequencePosition& position = sequence[i];
    homes_.push_back({static_cast<std::int32_t>(position.s * edge),
                      static_cast<std::int32_t>(position.t * edge)});
    spacing_.push_back(position.spacing);
  }
  set_homes();
  if (perturbation == 0) {
    for (std::size_t side = block_size; side > 0; side /= 2) add(homes_, side);
    return;
  }
  pattern_ = pattern_of(perturbation);
  half_pattern_ = pattern_of(of_half * perturbation);
  List root = homes_;
  move(root, seed, perturbation);
  follow_pattern(root, {0, 0, 0});
  add(std::move(root), block_size);
  for (std::size_t k = 0; k < 4; ++k) {
    add(quadrant_of(positions_[0], k, {1, k % 2, k / 2}), block_size / 2);
  }
  for (std::size_t parent = 0; parent < 4; ++parent) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Spot spot{2, 2 * (parent % 2) + k % 2, 2 * (parent / 2) + k / 2};
      add(quadrant_of(positions_[parent + 1], k, spot), block_size / 4);
    }
  }
  for (const std::size_t depth : {std::size_t{3}, std::size_t{4}}) {
    for (std::size_t k = 0; k < repeats; ++k) {
      List deep = homes_;
      follow_pattern(deep, {depth, k % period, k / period});
      add(std::move(deep), 1);
    }
  }
}

FREQSYNTH_INLINE std::size_t NodePositions::quadrant_class(std::size_t of,
                                                           std::size_t quadrant) const {
  constexpr std::size_t first = 21;  // of depth 3
  if (classes() == 4) return std::min<std::size_t>(of + 1, 3);
  if (of < 5) return 4 * of + 1 + quadrant;
  // Its place in the pattern, as far as that repeats.
  std::size_t column = quadrant % 2, row = quadrant / 2;
  if (of < first) {
    const std::size_t parent = (of - 5) / 4, k = (of - 5) % 4;
    column += 2 * (2 * (parent % 2) + k % 2);
    row += 2 * (2 * (parent / 2) + k / 2);
  } else {
    column += 2 * ((of - first) % repeats % period);
    row += 2 * ((of - first) % repeats / period);
  }
  return first + (of < first ? 0 : repeats) + (row % period) * period + column % period;
}

FREQSYNTH_INLINE std::uint32_t NodePositions::index_at(const NodePosition& home) const {
  const std::uint64_t wanted = key(home);
  const auto found =
      std::lower_bound(border_.begin(), border_.end(), wanted,
                       [](const Border& one, std::uint64_t at) { return one.key < at; });
  return found != border_.end() && found->key == wanted ? found->index : none;
}

FREQSYNTH_INLINE bool NodePositions::same_place(std::size_t parent, std::size_t quadrant,
                                                std::size_t index) const {
  const NodePosition& own = positions_[quadrant_class(parent, quadrant)][index];
  const NodePosition& there = positions_[parent][in_parent_[quadrant][index]];
  const auto right = static_cast<std::int32_t>(quadrant & 1) * edge;
  const auto down = static_cast<std::int32_t>(quadrant >> 1) * edge;
  return own.s + right == 2 * there.s && own.t + down == 2 * there.t;
}

/// Finds by their homes those on the border, and the samples of quadrants among the whole's.
FREQSYNTH_INLINE void NodePositions::set_homes() {
  std::vector<Border> all(size);
  for (std::uint32_t i = 0; i < size; ++i) all[i] = {key(homes_[i]), i};
  const auto by_key = [](const Border& a, const Border& b) { return a.key < b.key; };
  std::sort(all.begin(), all.end(), by_key);
  for (const Border& one : all) {
    if (on_border(homes_[one.index])) border_.push_back(one);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < in_parent_[k].size(); ++i) {
      const NodePosition there = {(homes_[i].s + static_cast<std::int32_t>(k & 1) * edge) / 2,
                                  (homes_[i].t + static_cast<std::int32_t>(k >> 1) * edge) / 2};
      const auto found = std::lower_bound(all.begin(), all.end(), Border{key(there), 0}, by_key);
      FREQSYNTH_ASSERT(found != all.end() && found->key == key(there));
      in_parent_[k][i] = found->index;
    }
  }
}

/// Moves the first positions of a block, at the corners of its pixels.
FREQSYNTH_INLINE void NodePositions::move(List& list, std::uint64_t seed,
                                          double perturbation) const {
  const std::uint64_t stream = detail::mix_bits(seed + 7 * detail::golden_step);
  const auto inside = [](std::int32_t at) { return at != 0 && at != edge; };
  for (std::size_t i = 0; i < moved; ++i) {
    NodePosition& p = list[i];
    // The spacing of the coarsest lattice of 2^k intervals that has the position.
    std::int32_t spacing = edge;
    while (p.s % spacing != 0 || p.t % spacing != 0) spacing /= 2;
    // Partners have all but the border that they lie on in common, and so their draw.
    const auto draw = [&](std::int32_t along, std::int32_t across, std::uint64_t axis) {
      const std::int32_t common = inside(across) ? across : 0;
      const std::uint64_t name = (axis << 40) | (static_cast<std::uint64_t>(along) << 20) |
                                 static_cast<std::uint64_t>(common);
      const std::uint64_t bits = detail::mix_bits(stream + detail::golden_step * (name + 1)) >> 11;
      const double share = std::ldexp(static_cast<double>(bits), -52) - 1;
      return static_cast<std::int32_t>(std::lround(share * perturbation * spacing));
    };
    const std::int32_t s = p.s, t = p.t;
    if (inside(s)) p.s += draw(s, t, 0);
    if (inside(t)) p.t += draw(t, s, 1);
  }
}

/// Moves that are evenly spread over the lines of a lattice.
FREQSYNTH_INLINE NodePositions::Pattern NodePositions::pattern_of(double perturbation) {
  // Each line of samples is moved as a whole along itself, so that it stays even; lines beside each
  // other, and those of centres and of middles, are not in step.
  constexpr std::array<double, period> shares = {-0.75, 0.25, -0.25, 0.75};
  Pattern pattern{};
  for (std::size_t kind = 0; kind < pattern.size(); ++kind) {
    for (std::size_t i = 0; i < repeats; ++i) {
      const std::size_t line = kind % 2 == 0 ? i / period : i % period;
      const double share = shares[(line + kind / 2) % period];
      pattern[kind][i] = static_cast<std::int32_t>(std::lround(32 * perturbation * share));
    }
  }
  return pattern;
}

/// Moves the positions of a node that are of finer lattices than that of the pixels' corners, or
/// the node's where it is smaller.
FREQSYNTH_INLINE void NodePositions::follow_pattern(List& list, const Spot& spot) const {
  const std::int32_t coarsest = spot.depth < 3 ? edge >> (3 - spot.depth) : edge;
  constexpr auto repeat = static_cast<std::int32_t>(period);
  for (NodePosition& p : list) {
    const std::int32_t s = p.s, t = p.t;
    if (s % coarsest == 0 && t % coarsest == 0) continue;
    // The spacing of the coarsest lattice that has it, whose cells before it were twice as large.
    std::int32_t spacing = coarsest / 2;
    while (s % spacing != 0 || t % spacing != 0) spacing /= 2;
    const std::int32_t cells = edge / (2 * spacing);
    const auto cell = [&](std::size_t node, std::int32_t at) {
      return (static_cast<std::int32_t>(node % period) * cells + at / (2 * spacing)) % repeat;
    };
    const bool half = (edge / spacing) << spot.depth == 2 * std::int32_t{block_size};
    const Pattern& pattern = half ? half_pattern_ : pattern_;
    const std::int32_t column = cell(spot.column, s), row = cell(spot.row, t);
    const auto place = static_cast<std::size_t>(row * repeat + column);
    const bool across = s % (2 * spacing) != 0, down = t % (2 * spacing) != 0;
    const std::size_t kind = across && down ? 0 : across ? 2 : 4;
    // Borders of blocks are among those where the pattern begins.
    if (across || column != 0) p.s += pattern[kind][place] * (spacing / 32);
    if (down || row != 0) p.t += pattern[kind + 1][place] * (spacing / 32);
  }
}

/// The positions of a quadrant: the first of the whole's where these are, then the finer ones.
FREQSYNTH_INLINE NodePositions::List NodePositions::quadrant_of(const List& parent,
                                                                std::size_t quadrant,
                                                                const Spot& spot) const {
  List list = homes_;
  follow_pattern(list, spot);
  for (std::size_t i = 0; i < handed_down(moved); ++i) {
    const NodePosition& there = parent[in_parent_[quadrant][i]];
    list[i] = {2 * there.s - static_cast<std::int32_t>(quadrant & 1) * edge,
               2 * there.t - static_cast<std::int32_t>(quadrant >> 1) * edge};
  }
  return list;
}

FREQSYNTH_INLINE void NodePositions::add(List list, std::size_t pixels) {
  positions_.push_back(std::move(list));
  pixels_.push_back(pixels);
}

}  // namespace freqsynth
