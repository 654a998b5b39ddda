// SPDX-License-Identifier: MIT
/// \file
/// Coefficients of single blocks to pixels of an output of any size.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/image/axis_weights.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_view.h"

namespace freqsynth::detail {

/// The factors that turn coefficients F into amplitudes of a point function, filters left aside.
[[nodiscard]] FREQSYNTH_API std::array<float, max_terms> amplitude_factors(
    CoefficientMeaning meaning);

/// Where the blocks of an image lie in an output.
struct FREQSYNTH_API OutputAxes {
  /// \param output  with its strides written out
  OutputAxes(std::size_t width, std::size_t height, PixelFilter filter,
             const PixelFilterShape& shape, const PixelView& output);

  /// Whether each pixel lies in one block, so that blocks may come in any order.
  [[nodiscard]] bool separate() const;

  PixelView view;
  std::vector<AxisBlock> columns, rows;
};

/// The pixels that one block contributes to, in memory of their own.
class FREQSYNTH_API BlockPixels {
 public:
  /// Goes on to a block.
  void go_to(const AxisBlock& column, const AxisBlock& row) { go_to(column, row, 0, row.count); }
  /// The same, of whose rows of pixels those from `first` to `last` are wanted.
  void go_to(const AxisBlock& column, const AxisBlock& row, std::size_t first, std::size_t last);

  /// Computes the pixels of a channel.
  /// \param coefficients  in zig-zag order, like the factors
  void compute(std::span<const float, max_terms> coefficients,
               const std::array<float, max_terms>& factors);
  /// The same of amplitudes of a point function, row by row (v, u), on a cache line.
  void compute(const AlignedBlock& amplitudes);
  /// No block takes light away where there is none that is negative.
  void clamp_negative();
  /// Writes the pixels, or adds them to those that an earlier block has begun.
  void write(const PixelView& out, std::size_t channel) const;

 private:
  const AxisBlock* column_ = nullptr;
  const AxisBlock* row_ = nullptr;
  std::size_t first_ = 0, count_ = 0;  // rows
  std::size_t stride_ = 0;
  AlignedVector<float> pixels_;
};

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/block_pixels.inl"
#endif
