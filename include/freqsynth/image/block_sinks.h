// SPDX-License-Identifier: MIT
/// \file
/// Where the coefficients of single blocks go: into a frequency image, or to pixels at once.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_snapshot.h"
#include "freqsynth/image/block_pixels.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth::detail {

/// The unit of each channel. Exponents are in -126..126.
template <Refiner R>
std::vector<float> units_of(const BlockSnapshot<R>& blocks) {
  std::vector<float> units;
  for (std::size_t c = 0; c < blocks.channels(); ++c) {
    units.push_back(std::ldexp(1.0f, blocks.exponent(c)));
  }
  return units;
}

/// Writes blocks into an image, in the host's unit.
class ImageSink {
 public:
  template <Refiner R>
  ImageSink(const BlockGrid& grid, const BlockSnapshot<R>& blocks, FrequencyImage& image)
      : grid_(grid), counts_(blocks.counts()), image_(image), units_(units_of(blocks)) {}

  [[nodiscard]] bool positive(std::size_t channel) const { return image_.non_negative(channel); }
  /// \param coefficients  in zig-zag order
  void put(std::size_t block, std::size_t channel,
           std::span<const float, max_terms> coefficients) const {
    const std::size_t x = grid_.column(block), y = grid_.row(block);
    if (channel == 0) image_.samples(x, y) = counts_[block];
    const auto out = image_.coefficients(x, y, channel);
    for (std::size_t i = 0; i < max_terms; ++i) out[i] = coefficients[i] * units_[channel];
  }
  /// \param rows  coefficients row by row
  void put_rows(std::size_t block, std::size_t channel, const AlignedBlock& rows) const {
    std::array<float, max_terms> coefficients;
    to_zigzag(rows, coefficients);
    put(block, channel, coefficients);
  }

 private:
  const BlockGrid& grid_;
  std::span<const std::uint32_t> counts_;
  FrequencyImage& image_;
  std::vector<float> units_;
};

/// Writes the pixels of finished blocks, in the host's unit.
class PixelSink {
 public:
  template <Refiner R>
  PixelSink(const BlockGrid& grid, const BlockSnapshot<R>& blocks, const PixelWindow& shown,
            const OutputAxes& axes, const std::vector<bool>& positive)
      : grid_(grid),
        left_(shown.x / block_size),
        top_(shown.y / block_size),
        axes_(axes),
        positive_(positive),
        units_(units_of(blocks)) {
    to_row_major(amplitude_factors(CoefficientMeaning::pixel_average), factors_);
  }

  [[nodiscard]] bool positive(std::size_t channel) const { return positive_[channel]; }
  /// \param rows  coefficients row by row
  void put_rows(std::size_t block, std::size_t channel, const AlignedBlock& rows) {
    // What is above or to the left of what is shown is beyond the end, too.
    const std::size_t x = grid_.column(block) - left_, y = grid_.row(block) - top_;
    if (x >= axes_.columns.size() || y >= axes_.rows.size()) return;
    const float unit = units_[channel];
    AlignedBlock amplitudes;
    for (std::size_t i = 0; i < max_terms; ++i) amplitudes[i] = rows[i] * unit * factors_[i];
    if (block != block_) {
      pixels_.go_to(axes_.columns[x], axes_.rows[y]);
      block_ = block;
    }
    pixels_.compute(amplitudes);
    if (positive_[channel]) pixels_.clamp_negative();
    pixels_.write(axes_.view, channel);
  }

 private:
  const BlockGrid& grid_;
  std::size_t left_, top_;  // blocks that are not shown
  const OutputAxes& axes_;
  const std::vector<bool>& positive_;
  std::vector<float> units_;
  AlignedBlock factors_;  // row by row
  std::size_t block_ = static_cast<std::size_t>(-1);
  BlockPixels pixels_;
};

}  // namespace freqsynth::detail
