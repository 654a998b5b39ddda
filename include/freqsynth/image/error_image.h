// SPDX-License-Identifier: MIT
/// \file
/// The expected errors of all blocks of an image, and of its pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/image/error_estimate.h"
#include "freqsynth/image/finish_settings.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {
namespace detail {

/// The expected errors of all blocks, in the units of their states.
template <Refiner R>
class ImageErrors {
 public:
  /// Calls visit(block, channel, fit) with the fit of each block that has samples.
  template <class Visit>
  ImageErrors(const BlockGrid& grid, const BlockSnapshot<R>& blocks, const FinishSettings& settings,
              Visit&& visit)
      : grid_(grid), channels_(blocks.channels()), errors_(blocks.size() * channels_) {
    ErrorEstimate estimate(settings);
    levels_.resize(channels_);
    std::vector<Gap> gaps;
    AlignedVector<float> state(blocks.state_size());
    for (std::uint32_t block = 0; block < blocks.size(); ++block) {
      if (blocks.samples(block) == 0) continue;
      blocks.read(block, state.data());
      for (std::size_t c = 0; c < channels_; ++c) {
        const BlockFit fit = blocks.fit_without_gaps(block, state.data(), c, gaps);
        const std::size_t all = blocks.samples(block);
        const std::size_t samples = all > fit.gaps.size() ? all - fit.gaps.size() : 1;
        const std::size_t terms = std::min(blocks.refiner().terms(all), samples);
        errors_[block * channels_ + c] = {
            estimate.of(fit, {.samples = samples,
                              .terms = terms,
                              .area = grid.area(block),
                              .surprise = blocks.surprises().expected(c, samples)}),
            double{fit.residual}, double{blocks.refiner().freedom(samples)}, samples};
        levels_[c].add(double{fit.coefficients[0]} / block_size);
        visit(block, c, fit);
      }
    }
  }

  /// Of a block; infinite when it has no sample.
  [[nodiscard]] const BlockError& of(std::uint32_t block, std::size_t channel) const {
    return at(block, channel).error;
  }
  /// Variance of the residuals of a block, as its own and its neighbours' samples tell: these count
  /// as one sample. Infinite when it has no sample.
  [[nodiscard]] double variance(std::uint32_t block, std::size_t channel) const {
    constexpr std::size_t few = 5;  // say nothing at all of what lies between them
    const Entry& own = at(block, channel);
    if (own.samples == 0) return std::numeric_limits<double>::infinity();
    double sum = own.variance * own.freedom, weight = own.freedom;
    double beside = 0, count = 0;
    grid_.visit_beside(block, [&](std::uint32_t other) {
      const Entry& entry = at(other, channel);
      if (entry.samples == 0) return;
      beside += entry.variance;
      count += 1;
    });
    if (count > 0) {
      sum += beside / count;
      weight += 1;
    }
    if (own.samples < few) {
      sum += levels_[channel].variance();
      weight += 1;
    }
    return sum / weight;
  }
  /// Mean of the squared errors of a block's pixels; infinite when it has no sample.
  [[nodiscard]] double mean(std::uint32_t block, std::size_t channel) const {
    const double known = variance(block, channel);
    if (known == std::numeric_limits<double>::infinity()) return known;
    return of(block, channel).mean(known);
  }

 private:
  struct Entry {
    BlockError error;
    double variance = 0, freedom = 1;
    std::size_t samples = 0;
  };
  // Of the means of blocks.
  struct Levels {
    double count = 0, mean = 0, squares = 0;
    void add(double level) {
      count += 1;
      const double off = level - mean;
      mean += off / count;
      squares += off * (level - mean);
    }
    [[nodiscard]] double variance() const { return count > 0 ? squares / count : 0; }
  };
  [[nodiscard]] const Entry& at(std::uint32_t block, std::size_t channel) const {
    return errors_[block * channels_ + channel];
  }

  const BlockGrid& grid_;
  std::size_t channels_;
  std::vector<Entry> errors_;   // [block][channel]
  std::vector<Levels> levels_;  // [channel]
};

/// Calls visit(pixel of the image, cell in the middle of it) for all pixels of a block.
template <class Visit>
void visit_pixels(const BlockGrid& grid, std::uint32_t block, Visit&& visit) {
  const std::size_t width = grid.block_width(block), height = grid.block_height(block);
  const auto cell = [](std::size_t pixel, std::size_t pixels) {
    return (2 * pixel + 1) * block_size / (2 * pixels);
  };
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t pixel =
          (grid.row(block) * block_size + y) * grid.width + grid.column(block) * block_size + x;
      visit(pixel, cell(y, height) * block_size + cell(x, width));
    }
  }
}

}  // namespace detail

/// The root of the expected squared error of each pixel of finished_image(), in the values' unit,
/// row by row, channels interleaved. Infinite where a block has no sample.
/// \param settings  as for finished_image()
/// \throws std::invalid_argument when a setting is out of range.
template <Refiner R>
[[nodiscard]] std::vector<float> error_image(const BlockGrid& grid, const BlockSnapshot<R>& blocks,
                                             const FinishSettings& settings) {
  const std::size_t channels = blocks.channels();
  std::vector<float> pixels(grid.width * grid.height * channels);
  // First how errors spread within blocks, with a mean of 1.
  const detail::ImageErrors<R> errors(
      grid, blocks, settings, [&](std::uint32_t block, std::size_t c, const BlockFit& fit) {
        std::array<float, max_terms> factors;
        ErrorEstimate::spread(fit, factors);
        double sum = 0, count = 0;
        detail::visit_pixels(grid, block, [&](std::size_t, std::size_t cell) {
          sum += double{factors[cell]};
          count += 1;
        });
        detail::visit_pixels(grid, block, [&](std::size_t pixel, std::size_t cell) {
          pixels[pixel * channels + c] = static_cast<float>(double{factors[cell]} * count / sum);
        });
      });
  for (std::uint32_t block = 0; block < blocks.size(); ++block) {
    for (std::size_t c = 0; c < channels; ++c) {
      const BlockError& error = errors.of(block, c);
      const double variance = errors.variance(block, c);
      const double unit = std::ldexp(1.0, blocks.exponent(c));
      detail::visit_pixels(grid, block, [&](std::size_t pixel, std::size_t) {
        float& value = pixels[pixel * channels + c];
        const double square =
            error.even + variance * (error.even_share + error.detail_share * double{value});
        value = blocks.samples(block) > 0 ? static_cast<float>(unit * std::sqrt(square))
                                          : std::numeric_limits<float>::infinity();
      });
    }
  }
  return pixels;
}

/// The mean over the pixels of a part of the image of what error_image() is the root of, of each
/// channel, in the square of the values' unit. Costs about as much as absorbing a sample or two in
/// each block, and no finished picture.
/// \param part  in pixels of the grid
template <Refiner R>
[[nodiscard]] std::vector<double> expected_squared_errors(const BlockGrid& grid,
                                                          const BlockSnapshot<R>& blocks,
                                                          const FinishSettings& settings,
                                                          const PixelWindow& part) {
  const detail::ImageErrors<R> errors(grid, blocks, settings,
                                      [](std::uint32_t, std::size_t, const BlockFit&) {});
  // Pixels of a block that lie in the part, along an axis.
  const auto within = [](std::size_t block, std::size_t length, std::size_t first,
                         std::size_t count) {
    const std::size_t begin = std::max(block * block_size, first);
    const std::size_t end = std::min(block * block_size + length, first + count);
    return static_cast<double>(end > begin ? end - begin : 0);
  };
  std::vector<double> squares(blocks.channels());
  double pixels = 0;
  for (std::uint32_t block = 0; block < blocks.size(); ++block) {
    const double share = within(grid.column(block), grid.block_width(block), part.x, part.width) *
                         within(grid.row(block), grid.block_height(block), part.y, part.height);
    if (share == 0) continue;
    pixels += share;
    for (std::size_t c = 0; c < squares.size(); ++c) {
      squares[c] += share * errors.mean(block, c);
    }
  }
  for (std::size_t c = 0; c < squares.size(); ++c) {
    squares[c] *= std::ldexp(1.0, 2 * blocks.exponent(c)) / std::max(pixels, 1.0);
  }
  return squares;
}

}  // namespace freqsynth
