// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "freqsynth/image/leaf_picture.h"

namespace freqsynth::detail {

inline LeafPicture::Square LeafPicture::square_of(std::uint32_t leaf) const {
  const TreeNode& node = tree_.node(leaf);
  const auto place = [&](std::size_t block, std::uint16_t of) {
    return static_cast<std::ptrdiff_t>(block * block_size +
                                       ((std::size_t{of} * block_size) >> node.depth));
  };
  const std::size_t side = tree_.positions().pixels(node.of);
  return {place(grid_.column(node.block), node.column), place(grid_.row(node.block), node.row),
          side, tree_.area(leaf) / static_cast<double>(side * side)};
}

inline void LeafPicture::set_margin(std::uint32_t leaf, std::size_t margin) {
  if (margin == 0 || !whole(leaf)) return;
  const Square square = square_of(leaf);
  for (std::size_t j = 0; j < square.side; ++j) {
    const std::size_t y = static_cast<std::size_t>(square.y) + j - top_;
    std::fill_n(margins_.begin() + static_cast<std::ptrdiff_t>(y * grid_.width) + square.x,
                square.side, static_cast<std::uint8_t>(margin));
  }
}

inline void LeafPicture::add(std::uint32_t leaf, const LeafNumbers& leaf_numbers) {
  if (whole(leaf)) {
    add_whole(leaf, leaf_numbers);
  } else {
    add_by_area(leaf, leaf_numbers);
  }
}

FREQSYNTH_ROUNDING inline void LeafPicture::add_whole(std::uint32_t leaf,
                                                      const LeafNumbers& leaf_numbers) {
  FREQSYNTH_ROUNDING_BEGIN
  const Square square = square_of(leaf);
  const auto margin = static_cast<std::ptrdiff_t>(leaf_numbers.margin);
  const auto side = static_cast<std::ptrdiff_t>(square.side);
  const auto width = static_cast<std::ptrdiff_t>(grid_.width);
  const std::ptrdiff_t line = side + 2 * margin;
  // How far the centre of pixel i lies inside, along one axis.
  const auto inside = [&](std::ptrdiff_t i) {
    return std::min(static_cast<double>(i) + 0.5, static_cast<double>(side - i) - 0.5);
  };
  for (std::ptrdiff_t j = -margin; j < side + margin; ++j) {
    const std::ptrdiff_t y = square.y + j - static_cast<std::ptrdiff_t>(top_);
    if (y < 0 || y >= static_cast<std::ptrdiff_t>(height_)) continue;
    const double down = inside(j);
    for (std::ptrdiff_t i = -margin; i < side + margin; ++i) {
      const std::ptrdiff_t x = square.x + i;
      if (x < 0 || x >= width) continue;
      const double across = inside(i);
      const auto pixel = static_cast<std::size_t>(y * width + x);
      std::size_t blend = leaf_numbers.margin;
      if (down < 0 || across < 0) blend = std::min<std::size_t>(blend, margins_[pixel]);
      double weight = double{blend_share(down, blend)} * double{blend_share(across, blend)};
      if (weight == 0) continue;
      const auto at = static_cast<std::size_t>((j + margin) * line + i + margin);
      weight *= square.area;
      if (leaf_numbers.doubts != nullptr) weight /= double{leaf_numbers.doubts[at]};
      weights_[pixel] += weight;
      const float* number = leaf_numbers.numbers + at;
      for (std::size_t c = 0; c < channels_; ++c, number += line * line) {
        sums_[pixel * channels_ + c] += weight * double{*number};
      }
    }
  }
}

/// In the narrower last blocks pixels are made of parts that are taken to be constant.
FREQSYNTH_ROUNDING inline void LeafPicture::add_by_area(std::uint32_t leaf,
                                                        const LeafNumbers& leaf_numbers) {
  FREQSYNTH_ROUNDING_BEGIN
  const TreeNode& node = tree_.node(leaf);
  const std::size_t side = tree_.positions().pixels(node.of);
  const std::size_t line = side + 2 * leaf_numbers.margin;
  struct Run {
    double from, to;
    [[nodiscard]] std::size_t first() const { return static_cast<std::size_t>(from); }
    [[nodiscard]] std::size_t end() const {
      return std::max(first() + 1, static_cast<std::size_t>(std::ceil(to)));
    }
    [[nodiscard]] double share(std::size_t pixel) const {
      const auto at = static_cast<double>(pixel);
      return std::max(0.0, std::min(to, at + 1) - std::max(from, at));
    }
  };
  // What a part has of the pixels along an axis.
  const auto run = [&](std::size_t block, std::size_t pixels, std::uint16_t of, std::size_t part) {
    const double edge = static_cast<double>(pixels) / std::ldexp(1.0, node.depth);
    const double step = edge / static_cast<double>(side);
    const double begin = static_cast<double>(block * block_size) + edge * of;
    return Run{begin + step * static_cast<double>(part),
               begin + step * static_cast<double>(part + 1)};
  };
  for (std::size_t j = 0; j < side; ++j) {
    const Run rows = run(grid_.row(node.block), grid_.block_height(node.block), node.row, j);
    for (std::size_t i = 0; i < side; ++i) {
      const Run columns =
          run(grid_.column(node.block), grid_.block_width(node.block), node.column, i);
      const std::size_t at = (j + leaf_numbers.margin) * line + i + leaf_numbers.margin;
      for (std::size_t y = rows.first(); y < std::min(rows.end(), grid_.height); ++y) {
        for (std::size_t x = columns.first(); x < std::min(columns.end(), grid_.width); ++x) {
          const double weight = rows.share(y) * columns.share(x);
          const std::size_t pixel = (y - top_) * grid_.width + x;
          weights_[pixel] += weight;
          const float* number = leaf_numbers.numbers + at;
          for (std::size_t c = 0; c < channels_; ++c, number += line * line) {
            sums_[pixel * channels_ + c] += weight * double{*number};
          }
        }
      }
    }
  }
}

FREQSYNTH_ROUNDING inline void LeafPicture::store(std::span<float> picture) const {
  FREQSYNTH_ROUNDING_BEGIN
  float* out = picture.data() + top_ * grid_.width * channels_;
  for (std::size_t pixel = 0; pixel < weights_.size(); ++pixel) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const std::size_t i = pixel * channels_ + c;
      out[i] = static_cast<float>(sums_[i] / weights_[pixel]);
    }
  }
}

}  // namespace freqsynth::detail
