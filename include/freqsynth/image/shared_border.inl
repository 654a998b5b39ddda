// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "freqsynth/image/shared_border.h"

namespace freqsynth {

FREQSYNTH_INLINE void SharedBorder::add(const SequencePosition& position,
                                        const detail::SampleRow& row) {
  ++samples_;
  const std::array<bool, sides> touches = touched(position);
  for (std::size_t side = 0; side < sides; ++side) {
    for (std::size_t along = 0; along < block_size; ++along) {
      const std::size_t pixel = pixel_at(side, along, 0);
      within_[side] += row.own_pixel == pixel ? 1 : 0;
      if (!touches[side]) continue;
      for (std::size_t p = 0; p < row.pixel_count; ++p) {
        if (row.pixels[p] == pixel) border_[side][along] += row.pixel_weights[p];
      }
    }
  }
  for (std::size_t p = 0; p < row.pixel_count; ++p) weights_[row.pixels[p]] += row.pixel_weights[p];
}

/// What the samples on a side show along it, if that is the other side of an edge.
FREQSYNTH_INLINE std::optional<SharedBorder::Line> SharedBorder::beyond(const BlockFit& fit,
                                                                        const BlocksMeans& means,
                                                                        std::size_t side) const {
  constexpr std::array<std::size_t, sides> neighbours{3, 5, 1, 7};
  const float* const own = means[4];
  const float* const other = means[neighbours[side]];
  if (!own || !other || within_[side] < enough) return std::nullopt;
  Line shown;
  Line offs = {};
  float jump = 0, slope = 0, across = 0;
  int known = 0;
  for (std::size_t along = 0; along < block_size; ++along) {
    const std::size_t pixel = pixel_at(side, along, 0);
    const float here = own[pixel], within = own[pixel_at(side, along, 1)];
    const float there = other[pixel_at(side ^ 1, along, 0)];
    shown[along] = OwnMeans::unknown;
    if (border_[side][along] < 0.1f || std::max({here, within, there}) == OwnMeans::unknown) {
      continue;
    }
    // The others in the pixel show what those within it do.
    const float off = (fit.pixel_sums[pixel] - weights_[pixel] * here) / border_[side][along];
    shown[along] = here + off;
    jump += std::abs(off);
    slope += std::abs(here - within);
    across += std::abs(there - here);
    offs[along] = off;
    ++known;
  }
  // An edge, not a slope; all along the border; and the neighbour shows the same.
  constexpr int most = 6;
  constexpr float steep = 6, some = 0.1f, least_share = 0.7f, greatest_share = 1.5f;
  int up = 0, down = 0;
  for (const float off : offs) {
    up += off * static_cast<float>(known) > some * jump ? 1 : 0;
    down += -off * static_cast<float>(known) > some * jump ? 1 : 0;
  }
  const bool edge = jump > steep * slope && std::max(up, down) == known;
  const bool same = jump >= least_share * across && jump <= greatest_share * across;
  if (known < most || !edge || !same) return std::nullopt;
  return shown;
}

FREQSYNTH_INLINE std::vector<Gap> SharedBorder::foreign(const BlockFit& fit,
                                                        const BlocksMeans& means,
                                                        const InverseList& list) const {
  std::vector<Gap> gaps;
  if (std::all_of(within_.begin(), within_.end(), [](auto some) { return some < enough; })) {
    return gaps;
  }
  std::array<std::optional<Line>, sides> lines;
  bool any = false;
  for (std::size_t side = 0; side < sides; ++side) {
    lines[side] = beyond(fit, means, side);
    any = any || lines[side];
  }
  if (!any) return gaps;
  for (std::uint32_t n = 0; n < samples_; ++n) {
    const SequencePosition& position = list.position(n);
    const std::array<bool, sides> touches = touched(position);
    for (std::size_t side = 0; side < sides; ++side) {
      if (!touches[side] || !lines[side]) continue;
      const double place = side < 2 ? position.t : position.s;
      const auto along = std::min(static_cast<std::size_t>(place * block_size), block_size - 1ul);
      // Where it is not known, that nearby is.
      float value = OwnMeans::unknown;
      for (std::size_t far = 0; far < block_size && value == OwnMeans::unknown; ++far) {
        if (along >= far) value = std::min(value, (*lines[side])[along - far]);
        if (along + far < block_size) value = std::min(value, (*lines[side])[along + far]);
      }
      gaps.push_back({n, value});
      break;
    }
  }
  return gaps;
}

}  // namespace freqsynth
