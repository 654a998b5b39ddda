/// \file
/// The result: an image as a grid of 8 x 8 blocks of DCT coefficients per channel, with the number
/// of samples behind each block. It does not know how it came to be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// What the coefficients stand for, so that no filter is applied twice.
enum class CoefficientMeaning : std::uint8_t {
  /// A band-limited function of the position as it was fit: eq. 2 at any point is its value there.
  point_function,
  /// Finished pixels: eq. 2 at a pixel's centre is the mean over the pixel, low-pass included.
  pixel_average
};

/// A grid of blocks of coefficients. The last blocks of an image whose size is no multiple of 8
/// reach beyond it.
class FrequencyImage {
 public:
  /// An empty image.
  FrequencyImage() = default;

  /// All coefficients and counts zero. Sizes are in pixels; 0 makes an image without blocks.
  /// \throws std::invalid_argument when channels is 0 or the size overflows.
  FrequencyImage(std::size_t width, std::size_t height, std::size_t channels,
                 CoefficientMeaning meaning = CoefficientMeaning::point_function);

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }
  [[nodiscard]] std::size_t blocks_x() const { return blocks_x_; }
  [[nodiscard]] std::size_t blocks_y() const { return blocks_y_; }
  [[nodiscard]] CoefficientMeaning meaning() const { return meaning_; }

  /// The 64 coefficients F (eqs. 1 and 2) of a channel of a block, in zig-zag order.
  [[nodiscard]] std::span<float, max_terms> coefficients(std::size_t block_x, std::size_t block_y,
                                                         std::size_t channel);
  [[nodiscard]] std::span<const float, max_terms> coefficients(std::size_t block_x,
                                                               std::size_t block_y,
                                                               std::size_t channel) const;

  /// Number of samples that the coefficients of a block were fit to.
  [[nodiscard]] std::uint32_t& samples(std::size_t block_x, std::size_t block_y);
  [[nodiscard]] std::uint32_t samples(std::size_t block_x, std::size_t block_y) const;

 private:
  [[nodiscard]] std::size_t block(std::size_t block_x, std::size_t block_y) const;

  std::size_t width_ = 0, height_ = 0, channels_ = 1;
  std::size_t blocks_x_ = 0, blocks_y_ = 0;
  CoefficientMeaning meaning_ = CoefficientMeaning::point_function;
  std::vector<float> coefficients_;     // [block][channel][term]
  std::vector<std::uint32_t> samples_;  // [block]
};

// ------------------------------------------------------------------------------------ definitions

inline FrequencyImage::FrequencyImage(std::size_t width, std::size_t height, std::size_t channels,
                                      CoefficientMeaning meaning)
    : width_(width), height_(height), channels_(channels), meaning_(meaning) {
  const BlockGrid grid = BlockGrid::of(width, height, channels);
  blocks_x_ = grid.blocks_x;
  blocks_y_ = grid.blocks_y;
  coefficients_.resize(blocks_x_ * blocks_y_ * channels * max_terms);
  samples_.resize(blocks_x_ * blocks_y_);
}

inline std::size_t FrequencyImage::block(std::size_t block_x, std::size_t block_y) const {
  FREQSYNTH_ASSERT(block_x < blocks_x_ && block_y < blocks_y_);
  return block_y * blocks_x_ + block_x;
}

inline std::span<float, max_terms> FrequencyImage::coefficients(std::size_t block_x,
                                                                std::size_t block_y,
                                                                std::size_t channel) {
  FREQSYNTH_ASSERT(channel < channels_);
  return std::span<float, max_terms>(
      coefficients_.data() + (block(block_x, block_y) * channels_ + channel) * max_terms,
      max_terms);
}

inline std::span<const float, max_terms> FrequencyImage::coefficients(std::size_t block_x,
                                                                      std::size_t block_y,
                                                                      std::size_t channel) const {
  FREQSYNTH_ASSERT(channel < channels_);
  return std::span<const float, max_terms>(
      coefficients_.data() + (block(block_x, block_y) * channels_ + channel) * max_terms,
      max_terms);
}

inline std::uint32_t& FrequencyImage::samples(std::size_t block_x, std::size_t block_y) {
  return samples_[block(block_x, block_y)];
}

inline std::uint32_t FrequencyImage::samples(std::size_t block_x, std::size_t block_y) const {
  return samples_[block(block_x, block_y)];
}

}  // namespace freqsynth
