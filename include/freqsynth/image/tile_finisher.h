// SPDX-License-Identifier: MIT
/// \file
/// Finished blocks, tile by tile: squares of blocks that are read, compared with those around them
/// and finished together, each by one thread.
///
/// Within a tile blocks come by their number of samples, so that what depends on it alone is made
/// once, and little memory is used that is not in a cache. No result depends on the tiles.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/own_means.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth::detail {

/// Some of the blocks of an image.
struct BlockRange {
  std::size_t left = 0, top = 0, right = 0, bottom = 0;  ///< the last two are beyond it

  [[nodiscard]] std::size_t width() const { return right - left; }
  [[nodiscard]] std::size_t size() const { return width() * (bottom - top); }
};

/// An image cut into tiles.
struct TileGrid {
  static constexpr std::size_t side = 24;  ///< blocks

  explicit TileGrid(const BlockGrid& grid)
      : blocks_x(grid.blocks_x),
        blocks_y(grid.blocks_y),
        tiles_x((grid.blocks_x + side - 1) / side),
        tiles_y((grid.blocks_y + side - 1) / side) {}

  [[nodiscard]] std::size_t size() const { return tiles_x * tiles_y; }
  [[nodiscard]] BlockRange tile(std::size_t number) const {
    const std::size_t left = number % tiles_x * side, top = number / tiles_x * side;
    return {left, top, std::min(left + side, blocks_x), std::min(top + side, blocks_y)};
  }
  /// Those of a tile and around it.
  [[nodiscard]] BlockRange around(const BlockRange& tile) const {
    return {tile.left - std::min<std::size_t>(tile.left, 1),
            tile.top - std::min<std::size_t>(tile.top, 1), std::min(tile.right + 1, blocks_x),
            std::min(tile.bottom + 1, blocks_y)};
  }
  /// How many tiles have a block in them or around them.
  [[nodiscard]] unsigned tiles_around(std::size_t x, std::size_t y) const {
    return along(x, blocks_x) * along(y, blocks_y);
  }

  std::size_t blocks_x, blocks_y, tiles_x, tiles_y;

 private:
  static unsigned along(std::size_t at, std::size_t blocks) {
    return 1u + (at > 0 && at % side == 0 ? 1 : 0) +
           (at + 1 < blocks && at % side == side - 1 ? 1 : 0);
  }
};

/// What all tiles have in common.
template <Refiner R>
struct FinishJob {
  const BlockGrid& grid;
  const BlockSnapshot<R>& blocks;
  const SharedInverseList& list;
  const FinishSettings& settings;
  const ButterworthFilters& filters;  ///< of all numbers of samples
};

/// Finishes tiles, one after the other.
template <Refiner R>
class TileFinisher {
 public:
  explicit TileFinisher(const FinishJob<R>& job)
      : job_(job),
        tiles_(job.grid),
        channels_(job.blocks.channels()),
        finisher_(job.list, job.settings, &job.filters) {}

  /// Calls take(finisher, fit, block, channel, coefficients row by row) for all channels of all
  /// blocks.
  template <class Take>
  void finish(const BlockRange& tile, Take&& take);

 private:
  [[nodiscard]] const float* state(std::size_t place) const {
    return states_.data() + place * job_.blocks.state_size();
  }
  [[nodiscard]] std::span<float, max_terms> means(std::size_t at) {
    return std::span<float, max_terms>(means_.data() + at * max_terms, max_terms);
  }
  [[nodiscard]] std::size_t block_at(std::size_t place) const {
    return (all_.top + place / all_.width()) * job_.grid.blocks_x + all_.left +
           place % all_.width();
  }
  void read(const BlockRange& tile);
  void compare();
  void join_along_rows();
  void compare_without_gaps(const OwnedSamples& all, std::span<const float> own_sums,
                            std::span<const Gap> gaps, std::size_t at);
  [[nodiscard]] PixelEvidence evidence(std::size_t place, std::size_t channel) const;

  const FinishJob<R>& job_;
  TileGrid tiles_;
  std::size_t channels_;
  PixelFinisher finisher_;
  // A place is the number of a block in all that are read, row by row.
  BlockRange all_;
  std::vector<std::uint64_t> order_;        // places, those of fewer samples first, below these
  AlignedVector<float> states_;             // [place]
  std::vector<PixelAgreement> agreements_;  // [place][channel], of it and those beside it
  AlignedVector<float> means_;              // [place][channel][pixel]
};

// ------------------------------------------------------------------------------------ definitions

template <Refiner R>
template <class Take>
void TileFinisher<R>::finish(const BlockRange& tile, Take&& take) {
  read(tile);
  const bool residuals = job_.settings.residuals;
  if (residuals) compare();
  finisher_.restart();
  std::vector<Gap> gaps;
  AlignedBlock rows;
  for (const std::uint64_t entry : order_) {
    const auto place = static_cast<std::uint32_t>(entry);
    const std::size_t block = block_at(place);
    const std::size_t x = job_.grid.column(block), y = job_.grid.row(block);
    if (x < tile.left || x >= tile.right || y < tile.top || y >= tile.bottom) continue;
    finisher_.advance(job_.blocks.samples(block));
    for (std::size_t c = 0; c < channels_; ++c) {
      const PixelEvidence known = residuals ? evidence(place, c) : PixelEvidence();
      const BlockFit fit = job_.blocks.fit_without_gaps(block, state(place), c, gaps);
      const std::vector<Gap> foreign = finisher_.foreign_samples(fit, known);
      if (foreign.empty()) {
        finisher_.finish_rows(fit, rows, known);
      } else {
        finisher_.finish_rows(job_.blocks.fit_without(block, state(place), c, foreign), rows,
                              known);
      }
      take(finisher_, fit, block, c, std::as_const(rows));
    }
  }
}

template <Refiner R>
void TileFinisher<R>::read(const BlockRange& tile) {
  const bool residuals = job_.settings.residuals;
  all_ = residuals ? tiles_.around(tile) : tile;
  states_.resize(all_.size() * job_.blocks.state_size());
  order_.clear();
  for (std::size_t place = 0; place < all_.size(); ++place) {
    const std::size_t block = block_at(place);
    const unsigned reads =
        residuals ? tiles_.tiles_around(job_.grid.column(block), job_.grid.row(block)) : 1;
    job_.blocks.read(block, states_.data() + place * job_.blocks.state_size(), reads);
    order_.push_back(std::uint64_t{job_.blocks.samples(block)} << 32 | place);
  }
  std::sort(order_.begin(), order_.end());
}

/// Finds how well samples agree within pixels, and their means.
template <Refiner R>
void TileFinisher<R>::compare() {
  agreements_.resize(all_.size() * channels_);
  means_.resize(agreements_.size() * max_terms);
  OwnedSamples owned;
  std::size_t samples = 0;
  for (const std::uint64_t entry : order_) {
    const auto place = static_cast<std::uint32_t>(entry);
    const std::size_t block = block_at(place);
    for (; samples < job_.blocks.samples(block); ++samples) owned.add(job_.list->row(samples));
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::size_t at = place * channels_ + c;
      const auto [own_sums, spread] = job_.blocks.own_samples(block, state(place), c);
      const std::vector<Gap> gaps = job_.blocks.gaps(block, c);
      if (gaps.empty()) {
        agreements_[at] = owned.means(own_sums, means(at));
        agreements_[at].spread = std::max(agreements_[at].spread, spread);
      } else {
        agreements_[at] = PixelAgreement::none();
        compare_without_gaps(owned, own_sums, gaps, at);
      }
    }
  }
  join_along_rows();
}

/// Joins with each agreement those of the blocks on both sides.
template <Refiner R>
void TileFinisher<R>::join_along_rows() {
  const std::size_t row = all_.width() * channels_;
  for (std::size_t first = 0; first < agreements_.size(); first += row) {
    for (std::size_t c = 0; c < channels_; ++c) {
      PixelAgreement before;
      for (std::size_t at = first + c; at < first + row; at += channels_) {
        const PixelAgreement own = agreements_[at];
        agreements_[at].join(before);
        if (at + channels_ < first + row) agreements_[at].join(agreements_[at + channels_]);
        before = own;
      }
    }
  }
}

template <Refiner R>
void TileFinisher<R>::compare_without_gaps(const OwnedSamples& all, std::span<const float> own_sums,
                                           std::span<const Gap> gaps, std::size_t at) {
  OwnedSamples owned = all;
  if (own_sums.empty()) {
    owned.means(own_sums, means(at));
    return;
  }
  std::array<float, max_terms> sums;
  std::copy(own_sums.begin(), own_sums.end(), sums.begin());
  for (const Gap& gap : gaps) {
    const SampleRow& row = job_.list->row(gap.sample);
    if (row.own_pixel != SampleRow::no_pixel) sums[row.own_pixel] -= gap.value;
    owned.remove(row);
  }
  owned.means(sums, means(at));
}

template <Refiner R>
PixelEvidence TileFinisher<R>::evidence(std::size_t place, std::size_t channel) const {
  const std::size_t width = all_.width();
  const std::size_t x = place % width, y = place / width;
  PixelEvidence evidence;
  PixelAgreement around;
  for (std::size_t k = 0; k < 3; ++k) {
    // One less than 0 is beyond the end, too.
    if (y + k - 1 >= all_.bottom - all_.top) continue;
    const std::size_t at = ((y + k - 1) * width + x) * channels_ + channel;
    around.join(agreements_[at]);
    const float* const means = means_.data() + at * max_terms;
    const std::size_t step = channels_ * max_terms;
    if (x > 0) evidence.own_means[3 * k] = means - step;
    evidence.own_means[3 * k + 1] = means;
    if (x + 1 < width) evidence.own_means[3 * k + 2] = means + step;
  }
  evidence.constant_pixels = around.holds();
  evidence.positive = !job_.blocks.any_negative(channel);
  return evidence;
}

}  // namespace freqsynth::detail
