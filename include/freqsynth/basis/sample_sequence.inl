// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {
namespace detail {

/// A well-mixed bit of a counter.
inline bool random_bit(std::uint64_t seed, std::uint64_t counter) {
  return (mix_bits(seed + golden_step * (counter + 1)) & 1) != 0;
}

struct QuadNode {
  std::uint32_t x, y;  // column and row among the nodes of a level
};

/// Node that is visited at `visit` (0 .. 4^level - 1). The lowest base-4 digit of the visit chooses
/// the quadrant of the block, so that consecutive samples fall into different quadrants.
inline QuadNode node_of_visit(std::uint64_t visit, std::uint32_t level) {
  // Sub-block order (0,0) (1,1) (1,0) (0,1), like the corners.
  constexpr std::uint32_t right[4] = {0, 1, 1, 0};
  constexpr std::uint32_t bottom[4] = {0, 1, 0, 1};
  QuadNode node{0, 0};
  for (std::uint32_t depth = 0; depth < level; ++depth) {
    const std::size_t digit = (visit >> (2 * depth)) & 3;
    node.x = 2 * node.x + right[digit];
    node.y = 2 * node.y + bottom[digit];
  }
  return node;
}

/// Displacement of a point of the unit block.
struct Displacement {
  double s = 0, t = 0;
};

/// A flow without sources, (d psi / dt, -d psi / ds) of
///   psi = sin^2(pi s) g(t) + g(s) sin^2(pi t), g(x) = (sin(2 pi x + phase) - sin phase) a / 2 pi:
/// so small a step along it nearly preserves areas, nothing crosses the border of the block, and
/// opposite borders move alike. The phases keep points that mirror each other out of each other's
/// rows and columns; were they opposite, they would cancel.
inline Displacement flow(double s, double t) {
  constexpr double pi = std::numbers::pi;
  constexpr double amplitude = 0.06;
  constexpr double phase_s = -0.15, phase_t = 0.3;
  const auto bell = [](double x) { return std::sin(pi * x) * std::sin(pi * x); };
  const auto wave = [](double x, double phase) {
    return 0.5 * (std::sin(2 * pi * x + phase) - std::sin(phase));
  };
  return {amplitude *
              (bell(s) * std::cos(2 * pi * t + phase_t) + wave(s, phase_s) * std::sin(2 * pi * t)),
          amplitude * (-wave(t, phase_t) * std::sin(2 * pi * s) -
                       bell(t) * std::cos(2 * pi * s + phase_s))};
}

}  // namespace detail

FREQSYNTH_INLINE const SequencePosition& SampleSequence::operator[](std::size_t index) {
  if (index >= max_size) {
    detail::refuse("sequence index " + std::to_string(index) + " is not below " +
                   std::to_string(max_size));
  }
  while (index >= positions_.size()) append_level();
  return positions_[index];
}

FREQSYNTH_INLINE void SampleSequence::append_level() {
  // All memory first: a level is appended whole or not at all.
  const std::size_t side = positions_.empty() ? 2 : (std::size_t{2} << level_) + 1;
  positions_.reserve(side * side);
  if (positions_.empty()) {
    append(0, 0, 1);
    append(1, 1, std::numbers::sqrt2_v<float>);
    append(1, 0, 1);
    append(0, 1, 1);
    return;
  }
  const std::uint64_t nodes = std::uint64_t{1} << (2 * level_);
  const double size = 1.0 / static_cast<double>(std::uint64_t{1} << level_);
  const auto spacing = static_cast<float>(size);
  constexpr float half_diagonal = 0.5f * std::numbers::sqrt2_v<float>;
  for (std::uint64_t visit = 0; visit < nodes; ++visit) {
    const detail::QuadNode node = detail::node_of_visit(visit, level_);
    append((node.x + 0.5) * size, (node.y + 0.5) * size, half_diagonal * spacing);
  }
  for (const bool second : {false, true}) {
    for (std::uint64_t visit = 0; visit < nodes; ++visit) {
      const detail::QuadNode node = detail::node_of_visit(visit, level_);
      const bool top_first = detail::random_bit(seed_, (std::uint64_t{level_} << 32) + visit);
      const bool top = top_first != second;
      const double s = top ? (node.x + 0.5) * size : (node.x + 1) * size;
      const double t = top ? node.y * size : (node.y + 0.5) * size;
      append(s, t, 0.5f * spacing);
      // The partner across the block, in the paper the sample of an "imaginary bounding block".
      if (t == 0) append(s, 1, 0.5f * spacing);
      if (s == 1) append(0, t, 0.5f * spacing);
    }
  }
  ++level_;
}

FREQSYNTH_INLINE void SampleSequence::append(double s, double t, float spacing) {
  const bool on_column = s == 0 || s == 1;
  const bool on_row = t == 0 || t == 1;
  SequencePosition position;
  position.s = s;
  position.t = t;
  position.spacing = spacing;
  const auto index = static_cast<std::uint32_t>(positions_.size());
  position.partner = index;
  if (on_column && on_row) {
    position.side = BlockSide::corner;
  } else if (on_column) {
    position.side = s == 1 ? BlockSide::right : BlockSide::left;
    position.partner = s == 1 ? index + 1 : index - 1;
  } else if (on_row) {
    position.side = t == 0 ? BlockSide::top : BlockSide::bottom;
    position.partner = t == 0 ? index + 1 : index - 1;
  }
  position.rank = ranks_[static_cast<std::size_t>(position.side)]++;
  if (kind_ == SamplePositions::bent) bend(position);
  positions_.push_back(position);
}

/// Moves a position of the lattice to where it lies on the bent one. Nothing leaves its side.
FREQSYNTH_INLINE void SampleSequence::bend(SequencePosition& position) {
  const detail::Displacement flow = detail::flow(position.s, position.t);
  // The last digits are left to no mathematics library.
  constexpr double digits = 1 << 26;
  const auto moved = [](double at, double by) {
    return at == 0 || at == 1 ? at : at + std::round(by * digits) / digits;
  };
  position.s = moved(position.s, flow.s);
  position.t = moved(position.t, flow.t);
}

}  // namespace freqsynth
