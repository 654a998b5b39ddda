// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/rounding.h"
#include "freqsynth/image/bank_picture.h"

namespace freqsynth {

FREQSYNTH_INLINE BankPictures::BankPictures(std::span<const UnitPoint> positions,
                                            const BankPictureSettings& settings)
    : settings_(settings) {
  detail::require(!positions.empty() && positions.size() <= 1800, "positions.size()",
                  static_cast<double>(positions.size()), "in 1..1800");
  detail::require(settings.blend <= block_size / 2, "blend", static_cast<double>(settings.blend),
                  "in 0..4");
  const AverageGrid grid = AverageGrid::with_margin(block_size, settings.blend);
  const auto add = [&](std::size_t level, std::vector<detail::RingSample> ring) {
    const std::vector<UnitPoint> all = detail::with_ring(ring, positions);
    kinds_.push_back(
        {level, std::move(ring), std::make_unique<const BankLists>(settings.bank, all, grid)});
  };
  add(0, {});
  for (const detail::RingReach& which : detail::ring_reaches) {
    if (!settings.ring || which.level > positions.size()) continue;
    add(which.level, detail::ring_samples(positions, which));
  }
}

FREQSYNTH_INLINE std::size_t BankPictures::memory() const {
  std::size_t bytes = 0;
  for (const Kind& kind : kinds_) bytes += kind.lists->memory();
  return bytes;
}

/// A picture in the making.
struct BankPictures::Work {
  Work(const BankPictures& pictures, std::span<const BlockSamples> samples, const PixelView& view,
       std::size_t channel_count);

  void estimate_rows(std::size_t first, std::size_t last);
  void blend(std::size_t x, std::size_t y);
  void fill(std::size_t x, std::size_t y, std::span<float> errors);
  void divide();

  [[nodiscard]] float* pixel(std::size_t x, std::size_t y) const {
    return picture.data + static_cast<std::ptrdiff_t>(x) * picture.pixel_stride +
           static_cast<std::ptrdiff_t>(y) * picture.row_stride;
  }

  [[nodiscard]] std::size_t kind_of(std::size_t x, std::size_t y) const;
  /// Pixels of a block along one axis.
  static std::size_t width_of(std::size_t block, std::size_t pixels) {
    return std::min(block_size, pixels - block * block_size);
  }
  void set_shares(std::size_t block, std::size_t count, std::size_t pixels,
                  std::vector<float>& shares) const;

  const BankPictures& maker;
  std::span<const BlockSamples> blocks;
  PixelView picture;
  std::size_t channels, columns, rows, margin, side;
  std::vector<BankEstimator> estimators;                          // one of each kind
  std::vector<float> gathered, averages, squared_errors, doubts;  // of the blocks at work
  std::vector<float> weights;                                     // of each pixel of the picture
  std::size_t first_row = 0;
};

FREQSYNTH_INLINE BankPictures::Work::Work(const BankPictures& pictures,
                                          std::span<const BlockSamples> samples,
                                          const PixelView& view, std::size_t channel_count)
    : maker(pictures),
      blocks(samples),
      picture(view),
      channels(channel_count),
      columns((view.width + block_size - 1) / block_size),
      rows((view.height + block_size - 1) / block_size),
      margin(pictures.settings_.blend),
      side(block_size + 2 * margin) {
  for (const Kind& kind : maker.kinds_) {
    estimators.emplace_back(*kind.lists, channels, maker.settings_.weights);
  }
}

/// The largest ring that all blocks around have samples for.
FREQSYNTH_INLINE std::size_t BankPictures::Work::kind_of(std::size_t x, std::size_t y) const {
  if (x == 0 || y == 0 || x + 1 >= columns || y + 1 >= rows) return 0;
  if (width_of(x + 1, picture.width) < block_size) return 0;
  if (width_of(y + 1, picture.height) < block_size) return 0;
  std::size_t least = static_cast<std::size_t>(-1);
  for (std::size_t row = y - 1; row <= y + 1; ++row) {
    for (std::size_t column = x - 1; column <= x + 1; ++column) {
      if (row == y && column == x) continue;
      least = std::min(least, blocks[row * columns + column].count);
    }
  }
  std::size_t kind = 0;
  while (kind + 1 < maker.kinds_.size() && maker.kinds_[kind + 1].level <= least) ++kind;
  return kind;
}

/// Estimates the blocks of some rows, all of a kind at once.
FREQSYNTH_INLINE void BankPictures::Work::estimate_rows(std::size_t first, std::size_t last) {
  first_row = first;
  const std::size_t count = (last - first) * columns;
  const std::size_t room = channels * side * side;
  averages.resize(count * room);
  squared_errors.resize(count * side * side);
  doubts.resize(count * side * side);
  for (std::size_t k = 0; k < maker.kinds_.size(); ++k) {
    const Kind& kind = maker.kinds_[k];
    std::vector<BankNode> nodes;
    std::vector<std::size_t> places;  // of the blocks at work
    std::size_t numbers = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t x = i % columns, y = first + i / columns;
      if (kind_of(x, y) != k) continue;
      places.push_back(i);
      numbers += (kind.ring.size() + blocks[y * columns + x].count) * channels;
    }
    gathered.resize(std::max(gathered.size(), numbers));
    float* next = gathered.data();
    for (const std::size_t i : places) {
      const std::size_t x = i % columns, y = first + i / columns;
      const BlockSamples& own = blocks[y * columns + x];
      BankNode node;
      node.values = next;
      node.count = kind.ring.size() + own.count;
      node.averages = averages.data() + i * room;
      node.squared_errors = squared_errors.data() + i * side * side;
      node.doubts = doubts.data() + i * side * side;
      for (const detail::RingSample& sample : kind.ring) {
        const std::size_t column = x + static_cast<std::size_t>(sample.right);
        const std::size_t row = y + static_cast<std::size_t>(sample.down);
        const float* values = blocks[row * columns + column].values + sample.index * channels;
        next = std::copy(values, values + channels, next);
      }
      next = std::copy(own.values, own.values + own.count * channels, next);
      nodes.push_back(node);
    }
    estimators[k].estimate(nodes);
  }
}

FREQSYNTH_INLINE void BankPictures::render(std::span<const BlockSamples> blocks,
                                           const PixelView& picture, std::size_t channels,
                                           std::span<float> errors) const {
  const PixelView view = picture.resolved(channels);
  Work work(*this, blocks, view, channels);
  const auto refuse_count = [](const char* what, std::size_t count, std::size_t right) {
    detail::refuse("there are " + std::to_string(count) + " " + what + ", not " +
                   std::to_string(right));
  };
  const std::size_t count = work.columns * work.rows, pixels = view.width * view.height;
  if (blocks.size() != count) refuse_count("blocks", blocks.size(), count);
  if (!errors.empty() && errors.size() != pixels) refuse_count("errors", errors.size(), pixels);
  for (const BlockSamples& block : blocks) {
    detail::require(block.count >= 1 && block.count <= kinds_.front().lists->max_samples(), "count",
                    static_cast<double>(block.count), "from 1 to that of positions");
  }
  work.weights.assign(pixels, 0);
  for (std::size_t y = 0; y < view.height; ++y) {
    for (std::size_t x = 0; x < view.width; ++x) {
      for (std::size_t c = 0; c < channels; ++c) {
        work.pixel(x, y)[static_cast<std::ptrdiff_t>(c) * view.channel_stride] = 0;
      }
    }
  }
  const std::size_t at_once = 1 + 255 / std::max<std::size_t>(1, work.columns);
  for (std::size_t first = 0; first < work.rows; first += at_once) {
    const std::size_t last = std::min(work.rows, first + at_once);
    work.estimate_rows(first, last);
    for (std::size_t y = first; y < last; ++y) {
      for (std::size_t x = 0; x < work.columns; ++x) {
        const bool whole = Work::width_of(x, view.width) == block_size &&
                           Work::width_of(y, view.height) == block_size;
        if (whole) work.blend(x, y);
        if (!whole || !errors.empty()) work.fill(x, y, errors);
      }
    }
  }
  work.divide();
}

}  // namespace freqsynth

#include "freqsynth/image/bank_picture_blend.inl"
