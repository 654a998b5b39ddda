// SPDX-License-Identifier: MIT
/// \file
/// The result: an image as a grid of 8 x 8 blocks of DCT coefficients per channel, with the number
/// of samples behind each block. It does not know how it came to be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/byte_stream.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"

namespace freqsynth {

/// What the coefficients stand for, so that no filter is applied twice.
enum class CoefficientMeaning : std::uint8_t {
  /// A band-limited function of the position as it was fit: eq. 2 at any point is its value there.
  point_function,
  /// Finished pixels: eq. 2 at a pixel's centre is the mean over the pixel, low-pass included. In a
  /// block narrower than 8 pixels, at the centre of each of 8 x 8 equal cells the mean over the
  /// cell.
  pixel_average
};

/// A grid of blocks of coefficients, which tile the image exactly: the last column and the last row
/// are as narrow as what is left of it, and s and t go from 0 to 1 over that. An image that was
/// moved from is empty.
class FrequencyImage {
 public:
  /// An empty image.
  FrequencyImage() = default;

  /// All coefficients and counts zero. Sizes are in pixels; 0 makes an image without blocks.
  /// \throws std::invalid_argument when channels is 0 or the size overflows.
  FREQSYNTH_API FrequencyImage(std::size_t width, std::size_t height, std::size_t channels,
                               CoefficientMeaning meaning = CoefficientMeaning::point_function);

  /// A copy.
  FrequencyImage(const FrequencyImage&) = default;
  /// A copy.
  FrequencyImage& operator=(const FrequencyImage&) = default;
  /// `other` is empty then.
  FREQSYNTH_API FrequencyImage(FrequencyImage&& other) noexcept;
  /// `other` is empty then.
  FREQSYNTH_API FrequencyImage& operator=(FrequencyImage&& other) noexcept;
  ~FrequencyImage() = default;

  /// Pixels in a row.
  [[nodiscard]] std::size_t width() const { return size_.width; }
  /// Pixels in a column.
  [[nodiscard]] std::size_t height() const { return size_.height; }
  /// Values per pixel.
  [[nodiscard]] std::size_t channels() const { return size_.channels; }
  /// Blocks in a row: width / 8, rounded up.
  [[nodiscard]] std::size_t blocks_x() const { return size_.blocks_x; }
  /// Blocks in a column: height / 8, rounded up.
  [[nodiscard]] std::size_t blocks_y() const { return size_.blocks_y; }
  /// Width in pixels (1..8) of the blocks of a column.
  [[nodiscard]] std::size_t block_width(std::size_t block_x) const {
    FREQSYNTH_ASSERT(block_x < size_.blocks_x);
    return detail::block_length(block_x, size_.width);
  }
  /// Height in pixels (1..8) of the blocks of a row.
  [[nodiscard]] std::size_t block_height(std::size_t block_y) const {
    FREQSYNTH_ASSERT(block_y < size_.blocks_y);
    return detail::block_length(block_y, size_.height);
  }
  /// What the coefficients stand for.
  [[nodiscard]] CoefficientMeaning meaning() const { return meaning_; }

  /// The blocks that a part of the image has pixels of, as an image of their own.
  /// \throws std::invalid_argument when the part is empty or does not lie within the image.
  [[nodiscard]] FREQSYNTH_API FrequencyImage part(const PixelWindow& window) const;

  /// Whether a channel has no values below zero: all pixels that are made of it are at least 0.
  [[nodiscard]] bool non_negative(std::size_t channel) const {
    FREQSYNTH_ASSERT(channel < size_.channels);
    return non_negative_[channel] != 0;
  }
  /// Says so, or not.
  void set_non_negative(std::size_t channel, bool non_negative) {
    FREQSYNTH_ASSERT(channel < size_.channels);
    non_negative_[channel] = non_negative ? 1 : 0;
  }

  /// The 64 coefficients F (eqs. 1 and 2) of a channel of a block, in zig-zag order.
  [[nodiscard]] std::span<float, max_terms> coefficients(std::size_t block_x, std::size_t block_y,
                                                         std::size_t channel) {
    const std::size_t first = first_coefficient(block_x, block_y, channel);
    return std::span<float, max_terms>(coefficients_.data() + first, max_terms);
  }
  /// The same, to be read only.
  [[nodiscard]] std::span<const float, max_terms> coefficients(std::size_t block_x,
                                                               std::size_t block_y,
                                                               std::size_t channel) const {
    const std::size_t first = first_coefficient(block_x, block_y, channel);
    return std::span<const float, max_terms>(coefficients_.data() + first, max_terms);
  }

  /// Number of samples that the coefficients of a block were fit to.
  [[nodiscard]] std::uint32_t& samples(std::size_t block_x, std::size_t block_y) {
    return samples_[block(block_x, block_y)];
  }
  /// The same, to be read only.
  [[nodiscard]] std::uint32_t samples(std::size_t block_x, std::size_t block_y) const {
    return samples_[block(block_x, block_y)];
  }

  /// Saves the image: the same bytes on all machines, with check values. A file of them is written
  /// by save_file(), see frequency_image_file.h.
  /// \param sink  takes the bytes, some at a time
  /// \throws what `sink` throws, std::bad_alloc.
  FREQSYNTH_API void save(ByteSink sink) const;
  /// Saves it into memory.
  [[nodiscard]] FREQSYNTH_API std::vector<std::byte> save() const;
  /// An image that was saved, to the bit. Takes no more memory than there are bytes.
  /// \throws std::runtime_error naming the reason: when these are other bytes, damaged, too few or
  ///         of a newer format; what `source` throws, std::bad_alloc.
  [[nodiscard]] FREQSYNTH_API static FrequencyImage load(ByteSource source);

 private:
  struct Size {
    std::size_t width = 0, height = 0, channels = 1;
    std::size_t blocks_x = 0, blocks_y = 0;
  };

  template <class Archive, class Self>
  static void archive(Archive& archive, Self& self);

  [[nodiscard]] std::size_t block(std::size_t block_x, std::size_t block_y) const {
    FREQSYNTH_ASSERT(block_x < size_.blocks_x && block_y < size_.blocks_y);
    return block_y * size_.blocks_x + block_x;
  }
  [[nodiscard]] std::size_t first_coefficient(std::size_t block_x, std::size_t block_y,
                                              std::size_t channel) const {
    FREQSYNTH_ASSERT(channel < size_.channels);
    return (block(block_x, block_y) * size_.channels + channel) * max_terms;
  }

  Size size_;
  CoefficientMeaning meaning_ = CoefficientMeaning::point_function;
  std::vector<float> coefficients_;         // [block][channel][term]
  std::vector<std::uint32_t> samples_;      // [block]
  std::vector<std::uint8_t> non_negative_;  // [channel]
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/frequency_image.inl"
#endif
