// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/jpeg/block_scaling.h"
#include "freqsynth/jpeg/quantization.h"

namespace freqsynth {
namespace detail {

using TermValues = std::array<float, max_terms>;

inline void check_quantization(const QuantizationSettings& settings, std::size_t channels) {
  if (channels != 1 && channels != 3) {
    refuse("quantization of " + std::to_string(channels) + " channels, not 1 or 3");
  }
  check_table(settings.luminance, "the luminance quantization table");
  check_table(settings.chrominance, "the chrominance quantization table");
  settings.butterworth.validate();
}

/// What turns coefficients of the image into those of the pixels' means.
inline ButterworthTable mean_factors(const ButterworthSettings& butterworth) {
  TermValues box;
  for (std::size_t i = 0; i < max_terms; ++i) box[i] = static_cast<float>(pixel_mean_of_term(i));
  return {butterworth, box};
}

/// The filtered coefficients of the pixels' means.
class PixelBlocks {
 public:
  PixelBlocks(const FrequencyImage& image, const ButterworthSettings& butterworth)
      : image_(image),
        factors_(mean_factors(butterworth)),
        whole_(AxisMap::extend(block_size)),
        last_column_(AxisMap::extend(image.block_width(image.blocks_x() - 1))),
        last_row_(AxisMap::extend(image.block_height(image.blocks_y() - 1))) {}

  /// Block (x, y) of 8 x 8 pixels; beyond the image it is continued as in a mirror.
  void read(std::size_t x, std::size_t y, std::size_t channel, TermValues& block) {
    const bool mirror_x = x >= image_.blocks_x();
    const bool mirror_y = y >= image_.blocks_y();
    const std::size_t bx = mirror_x ? image_.blocks_x() - 1 : x;
    const std::size_t by = mirror_y ? image_.blocks_y() - 1 : y;
    const auto coefficients = image_.coefficients(bx, by, channel);
    if (image_.meaning() == CoefficientMeaning::point_function) {
      const TermValues& factors = factors_.of(image_.samples(bx, by));
      for (std::size_t i = 0; i < max_terms; ++i) block[i] = coefficients[i] * factors[i];
    } else {
      std::copy(coefficients.begin(), coefficients.end(), block.begin());
    }
    extend(bx, by, block);
    if (!mirror_x && !mirror_y) return;
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      if ((mirror_x && f.u % 2 == 1) != (mirror_y && f.v % 2 == 1)) block[i] = -block[i];
    }
  }

  /// The means of 2 x 2 pixels of the four blocks from (2 x, 2 y) on.
  void read_halved(std::size_t x, std::size_t y, std::size_t channel, TermValues& block) {
    for (std::size_t i = 0; i < 4; ++i) read(2 * x + i % 2, 2 * y + i / 2, channel, four_[i]);
    block = halve_blocks(four_);
  }

 private:
  /// Makes 8 x 8 pixels of a block that is narrower.
  void extend(std::size_t bx, std::size_t by, TermValues& block) const {
    const bool narrow = image_.block_width(bx) < block_size;
    const bool low = image_.block_height(by) < block_size;
    if (!narrow && !low) return;
    AlignedBlock own, extended;
    for (std::size_t i = 0; i < max_terms; ++i) own[zigzag_to_row_major[i]] = block[i];
    AxisMap::apply(narrow ? last_column_ : whole_, low ? last_row_ : whole_, own, extended);
    for (std::size_t i = 0; i < max_terms; ++i) block[i] = extended[zigzag_to_row_major[i]];
  }

  const FrequencyImage& image_;
  ButterworthTable factors_;
  AxisMap whole_, last_column_, last_row_;
  std::array<TermValues, 4> four_;
};

/// The quantised value of a term that may be out of range or not a number.
inline std::int16_t clamp_value(float value, std::size_t term, std::uint64_t& clamped) {
  const float least = term == 0 ? -1024 : -1023;
  if (is_nan(value)) {
    ++clamped;
    return 0;
  }
  // A value half a step beyond the range is rounding, not an overshoot.
  if (!(value > least - 1 && value < 1024)) ++clamped;
  return static_cast<std::int16_t>(std::clamp(std::round(value), least, 1023.0f));
}

/// Eq. 3 for one block, halves away from zero.
inline void quantize_block(const TermValues& block, const TermValues& steps, std::int16_t* out,
                           std::uint64_t& clamped) {
  // As bits, for magnitudes above 1023 and what is no number are alike then.
  constexpr auto most = std::bit_cast<std::uint32_t>(1023.0f);
  TermValues values;
  int outside = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    values[i] = block[i] / steps[i];
    outside |= static_cast<int>((std::bit_cast<std::uint32_t>(values[i]) & 0x7fffffffu) > most);
  }
  if (outside != 0) {
    for (std::size_t i = 0; i < max_terms; ++i) out[i] = clamp_value(values[i], i, clamped);
    return;
  }
  // std::round() without a call: the float below 1/2 takes a half to the next integer, for the sum
  // is rounded to even, and nothing that is less.
  constexpr float below_half = 0x1.fffffep-2f;
  for (std::size_t i = 0; i < max_terms; ++i) {
    out[i] = static_cast<std::int16_t>(
        static_cast<int>(values[i] + std::copysign(below_half, values[i])));
  }
}

/// Blocks of Y along a block of Cb.
inline std::size_t luma_blocks(const FrequencyImage& image, const QuantizationSettings& settings) {
  return image.channels() == 3 && settings.subsampling == Subsampling::both ? 2 : 1;
}

/// The quantised image with all of its values still 0.
inline QuantizedImage empty_quantized(const FrequencyImage& image,
                                      const QuantizationSettings& settings) {
  const std::size_t group = luma_blocks(image, settings);
  QuantizedImage result;
  result.width = image.width();
  result.height = image.height();
  result.tables.push_back(settings.luminance);
  if (image.channels() > 1) result.tables.push_back(settings.chrominance);
  result.components.resize(image.channels());
  for (std::size_t channel = 0; channel < image.channels(); ++channel) {
    const bool luma = channel == 0;
    QuantizedComponent& component = result.components[channel];
    component.blocks_x = luma ? image.blocks_x() : (image.blocks_x() + group - 1) / group;
    component.blocks_y = luma ? image.blocks_y() : (image.blocks_y() + group - 1) / group;
    component.horizontal = component.vertical = luma ? static_cast<int>(group) : 1;
    component.table = luma ? 0 : 1;
    component.values.resize(component.blocks_x * component.blocks_y * max_terms);
  }
  return result;
}

}  // namespace detail

FREQSYNTH_INLINE std::array<float, max_terms> halve_blocks(
    const std::array<std::array<float, max_terms>, 4>& blocks) {
  using detail::AxisMap;
  static const std::array<AxisMap, 2> shrink{AxisMap::shrink(0, 2), AxisMap::shrink(1, 2)};
  detail::AlignedBlock sum{};
  detail::AlignedBlock rows, part;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < max_terms; ++k) rows[detail::zigzag_to_row_major[k]] = blocks[i][k];
    AxisMap::apply(shrink[i % 2], shrink[i / 2], rows, part);
    for (std::size_t k = 0; k < max_terms; ++k) sum[k] += part[k];
  }
  std::array<float, max_terms> out;
  for (std::size_t k = 0; k < max_terms; ++k) out[k] = sum[detail::zigzag_to_row_major[k]];
  return out;
}

FREQSYNTH_INLINE QuantizedImage quantize(const FrequencyImage& image,
                                         const QuantizationSettings& settings) {
  if (image.blocks_x() == 0) detail::refuse("quantize: the image has no pixels");
  detail::check_quantization(settings, image.channels());
  QuantizedImage result = detail::empty_quantized(image, settings);
  std::array<detail::TermValues, 2> steps;
  for (std::size_t t = 0; t < result.tables.size(); ++t) {
    std::copy(result.tables[t].begin(), result.tables[t].end(), steps[t].begin());
  }
  detail::PixelBlocks blocks(image, settings.butterworth);
  detail::TermValues block;
  const auto write = [&](std::size_t x, std::size_t y, std::size_t channel) {
    QuantizedComponent& component = result.components[channel];
    if (channel == 0) block[0] -= detail::level_shift;
    detail::quantize_block(block, steps[component.table],
                           component.values.data() + (y * component.blocks_x + x) * max_terms,
                           result.clamped);
  };
  const std::size_t group = detail::luma_blocks(image, settings);
  const std::size_t groups_x = (image.blocks_x() + group - 1) / group;
  const std::size_t groups_y = (image.blocks_y() + group - 1) / group;
  // All channels of a block in one go, for they lie together in memory.
  for (std::size_t y = 0; y < groups_y; ++y) {
    for (std::size_t x = 0; x < groups_x; ++x) {
      for (std::size_t i = 0; i < group * group; ++i) {
        const std::size_t luma_x = group * x + i % group;
        const std::size_t luma_y = group * y + i / group;
        if (luma_x >= image.blocks_x() || luma_y >= image.blocks_y()) continue;
        blocks.read(luma_x, luma_y, 0, block);
        write(luma_x, luma_y, 0);
      }
      for (std::size_t channel = 1; channel < image.channels(); ++channel) {
        if (group == 2) {
          blocks.read_halved(x, y, channel, block);
        } else {
          blocks.read(x, y, channel, block);
        }
        write(x, y, channel);
      }
    }
  }
  return result;
}

FREQSYNTH_INLINE QuantizationTarget quantization_target(const QuantizationSettings& settings,
                                                        std::size_t channels, double tolerance) {
  detail::check_quantization(settings, channels);
  QuantizationTarget target;
  target.tolerance = tolerance;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const QuantizationTable& table = channel == 0 ? settings.luminance : settings.chrominance;
    const bool half = channel > 0 && settings.subsampling == Subsampling::both;
    auto& steps = target.steps.emplace_back();
    for (std::size_t i = 0; i < max_terms; ++i) {
      const Frequency f = frequency_of_term(i);
      if (!half) {
        steps[i] = table[i];
      } else if (f.u < block_size / 2 && f.v < block_size / 2) {
        // The four blocks' terms (u, v) make (2u, 2v) and those beside it, with a quarter of the
        // variance.
        steps[i] = 2.0f * static_cast<float>(table[term_of_frequency(2 * f.u, 2 * f.v)]);
      } else {
        steps[i] = std::numeric_limits<float>::infinity();
      }
    }
  }
  target.validate(channels);
  return target;
}

}  // namespace freqsynth
