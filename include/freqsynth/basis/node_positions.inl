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
  List plain;
  plain.reserve(size);
  spacing_.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const SequencePosition& position = sequence[i];
    plain.push_back({static_cast<std::int32_t>(position.s * edge),
                     static_cast<std::int32_t>(position.t * edge)});
    spacing_.push_back(position.spacing);
  }
  set_parents(plain);
  if (perturbation == 0) {
    for (std::size_t side = block_size; side > 0; side /= 2) add(plain, side);
    return;
  }
  List root = plain;
  move(root, seed, perturbation);
  add(std::move(root), block_size);
  for (std::size_t k = 0; k < 4; ++k) add(quadrant_of(positions_[0], plain, k), block_size / 2);
  for (std::size_t parent = 1; parent <= 4; ++parent) {
    for (std::size_t k = 0; k < 4; ++k) {
      add(quadrant_of(positions_[parent], plain, k), block_size / 4);
    }
  }
  add(plain, 1);
}

FREQSYNTH_INLINE std::size_t NodePositions::quadrant_class(std::size_t of,
                                                           std::size_t quadrant) const {
  if (classes() == 4) return std::min<std::size_t>(of + 1, 3);
  return of < 5 ? 4 * of + 1 + quadrant : 21;
}

FREQSYNTH_INLINE std::uint32_t NodePositions::index_at(std::size_t of,
                                                       const NodePosition& point) const {
  const std::vector<Border>& border = borders_[of];
  const std::uint64_t wanted = key(point);
  const auto found =
      std::lower_bound(border.begin(), border.end(), wanted,
                       [](const Border& one, std::uint64_t at) { return one.key < at; });
  return found != border.end() && found->key == wanted ? found->index : none;
}

FREQSYNTH_INLINE bool NodePositions::same_place(std::size_t parent, std::size_t quadrant,
                                                std::size_t index) const {
  const NodePosition& own = positions_[quadrant_class(parent, quadrant)][index];
  const NodePosition& there = positions_[parent][in_parent_[quadrant][index]];
  const auto right = static_cast<std::int32_t>(quadrant & 1) * edge;
  const auto down = static_cast<std::int32_t>(quadrant >> 1) * edge;
  return own.s + right == 2 * there.s && own.t + down == 2 * there.t;
}

/// Finds the samples of quadrants among those of the whole, on the plain lattice.
FREQSYNTH_INLINE void NodePositions::set_parents(const List& plain) {
  std::vector<Border> all(size);
  for (std::uint32_t i = 0; i < size; ++i) all[i] = {key(plain[i]), i};
  const auto by_key = [](const Border& a, const Border& b) { return a.key < b.key; };
  std::sort(all.begin(), all.end(), by_key);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < in_parent_[k].size(); ++i) {
      const NodePosition there = {(plain[i].s + static_cast<std::int32_t>(k & 1) * edge) / 2,
                                  (plain[i].t + static_cast<std::int32_t>(k >> 1) * edge) / 2};
      const auto found = std::lower_bound(all.begin(), all.end(), Border{key(there), 0}, by_key);
      FREQSYNTH_ASSERT(found != all.end() && found->key == key(there));
      in_parent_[k][i] = found->index;
    }
  }
}

/// Moves the first positions of a block.
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

/// The positions of a quadrant: what the whole has of it where that is, then the lattice.
FREQSYNTH_INLINE NodePositions::List NodePositions::quadrant_of(const List& parent,
                                                                const List& plain,
                                                                std::size_t quadrant) const {
  List list = plain;
  for (std::size_t i = 0; i < handed_down(moved); ++i) {
    const NodePosition& there = parent[in_parent_[quadrant][i]];
    list[i] = {2 * there.s - static_cast<std::int32_t>(quadrant & 1) * edge,
               2 * there.t - static_cast<std::int32_t>(quadrant >> 1) * edge};
  }
  return list;
}

FREQSYNTH_INLINE void NodePositions::add(List list, std::size_t pixels) {
  std::vector<Border> border;
  for (std::uint32_t i = 0; i < list.size(); ++i) {
    if (on_border(list[i])) border.push_back({key(list[i]), i});
  }
  std::sort(border.begin(), border.end(),
            [](const Border& a, const Border& b) { return a.key < b.key; });
  borders_.push_back(std::move(border));
  positions_.push_back(std::move(list));
  pixels_.push_back(pixels);
}

}  // namespace freqsynth
