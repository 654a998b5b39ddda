// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "freqsynth/basis/archive.h"
#include "freqsynth/basis/large_pages.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/image/frequency_image.h"

namespace freqsynth {

FREQSYNTH_INLINE FrequencyImage::FrequencyImage(std::size_t width, std::size_t height,
                                                std::size_t channels, CoefficientMeaning meaning)
    : meaning_(meaning) {
  const BlockGrid grid = BlockGrid::of(width, height, channels);
  size_ = {width, height, channels, grid.blocks_x, grid.blocks_y};
  const std::size_t numbers = grid.blocks_x * grid.blocks_y * channels * max_terms;
  coefficients_.reserve(numbers);
  detail::ask_for_large_pages(coefficients_.data(), numbers * sizeof(float));
  coefficients_.resize(numbers);
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

/// All that is saved.
template <class Archive, class Self>
void FrequencyImage::archive(Archive& archive, Self& self) {
  archive.section("SIZE", [&] {
    auto& size = self.size_;
    archive.count(size.width);
    archive.count(size.height);
    archive.count(size.channels);
    archive.number(self.meaning_);
    archive.check(self.meaning_ <= CoefficientMeaning::pixel_average);
    if constexpr (Archive::loading) {
      try {
        const BlockGrid grid = BlockGrid::of(size.width, size.height, size.channels);
        size.blocks_x = grid.blocks_x;
        size.blocks_y = grid.blocks_y;
      } catch (const std::invalid_argument&) {
        archive.fail_section("has sizes that no image has");
      }
    }
  });
  const std::size_t blocks = self.size_.blocks_x * self.size_.blocks_y;
  const std::size_t coefficients = blocks * self.size_.channels * max_terms;
  // As lists, for the sizes may be wrong: then there are not as many numbers.
  archive.section("COEF", [&] {
    archive.list(self.coefficients_, coefficients);
    archive.check(self.coefficients_.size() == coefficients);
  });
  archive.section("SMPL", [&] {
    archive.list(self.samples_, blocks);
    archive.check(self.samples_.size() == blocks);
  });
  archive.section("NNEG", [&] {
    archive.list(self.non_negative_, self.size_.channels);
    // An image that was moved from has none.
    archive.check(self.non_negative_.size() == self.size_.channels ||
                  (blocks == 0 && self.non_negative_.empty()));
    for (const std::uint8_t one : self.non_negative_) archive.check(one <= 1);
  });
  archive.finish();
}

FREQSYNTH_INLINE void FrequencyImage::save(ByteSink sink) const {
  detail::StateWriter writer(sink, detail::image_kind);
  archive(writer, *this);
}

FREQSYNTH_INLINE std::vector<std::byte> FrequencyImage::save() const {
  std::vector<std::byte> bytes;
  save([&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  return bytes;
}

FREQSYNTH_INLINE FrequencyImage FrequencyImage::load(ByteSource source) {
  FrequencyImage image;
  detail::StateReader reader(source, detail::image_kind);
  archive(reader, image);
  return image;
}

FREQSYNTH_INLINE FrequencyImage FrequencyImage::part(const PixelWindow& window) const {
  const BlockGrid all = BlockGrid::of(width(), height(), channels());
  all.check(window);
  const BlockGrid some = all.part(window, 0);
  FrequencyImage image(some.width, some.height, channels(), meaning_);
  image.non_negative_ = non_negative_;
  for (std::size_t y = 0; y < some.blocks_y; ++y) {
    for (std::size_t x = 0; x < some.blocks_x; ++x) {
      const std::size_t u = x + some.frame.left, v = y + some.frame.top;
      image.samples(x, y) = samples(u, v);
      for (std::size_t c = 0; c < channels(); ++c) {
        const auto from = coefficients(u, v, c);
        std::copy(from.begin(), from.end(), image.coefficients(x, y, c).begin());
      }
    }
  }
  return image;
}

}  // namespace freqsynth
