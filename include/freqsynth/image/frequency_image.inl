// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/frequency_image.h"

namespace freqsynth {

FREQSYNTH_INLINE FrequencyImage::FrequencyImage(std::size_t width, std::size_t height,
                                                std::size_t channels, CoefficientMeaning meaning)
    : meaning_(meaning) {
  const BlockGrid grid = BlockGrid::of(width, height, channels);
  size_ = {width, height, channels, grid.blocks_x, grid.blocks_y};
  coefficients_.resize(grid.blocks_x * grid.blocks_y * channels * max_terms);
  samples_.resize(grid.blocks_x * grid.blocks_y);
  non_negative_.resize(channels);
}

FREQSYNTH_INLINE FrequencyImage::FrequencyImage(FrequencyImage&& other) noexcept
    : size_(std::exchange(other.size_, Size())),
      meaning_(other.meaning_),
      coefficients_(std::exchange(other.coefficients_, {})),
      samples_(std::exchange(other.samples_, {})),
      non_negative_(std::exchange(other.non_negative_, {})) {}

FREQSYNTH_INLINE FrequencyImage& FrequencyImage::operator=(FrequencyImage&& other) noexcept {
  FrequencyImage taken(std::move(other));
  std::swap(size_, taken.size_);
  std::swap(meaning_, taken.meaning_);
  std::swap(coefficients_, taken.coefficients_);
  std::swap(samples_, taken.samples_);
  std::swap(non_negative_, taken.non_negative_);
  return *this;
}

}  // namespace freqsynth
