// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/jpeg/block_scaling.h"
#include "freqsynth/jpeg/dequantization.h"

namespace freqsynth {
namespace detail {

inline std::vector<AxisMap> enlarging_maps(std::size_t factor) {
  std::vector<AxisMap> maps;
  for (std::size_t part = 0; part < factor; ++part) maps.push_back(AxisMap::enlarge(part, factor));
  return maps;
}

/// \param across, down  pixels of the image along a pixel of the component
inline void dequantize_component(const QuantizedComponent& component,
                                 const QuantizationTable& table, std::size_t across,
                                 std::size_t down, std::size_t channel, FrequencyImage& out) {
  const std::vector<AxisMap> maps_x = enlarging_maps(across);
  const std::vector<AxisMap> maps_y = enlarging_maps(down);
  for (std::size_t y = 0; y < out.blocks_y(); ++y) {
    for (std::size_t x = 0; x < out.blocks_x(); ++x) {
      const std::int16_t* values =
          component.values.data() + ((y / down) * component.blocks_x + x / across) * max_terms;
      AlignedBlock block, scaled;
      for (std::size_t i = 0; i < max_terms; ++i) {
        block[zigzag_to_row_major[i]] = static_cast<float>(values[i] * table[i]);
      }
      if (channel == 0) block[0] += level_shift;
      const bool same_size = across * down == 1;
      if (!same_size) AxisMap::apply(maps_x[x % across], maps_y[y % down], block, scaled);
      const AlignedBlock& result = same_size ? block : scaled;
      const auto coefficients = out.coefficients(x, y, channel);
      for (std::size_t i = 0; i < max_terms; ++i) coefficients[i] = result[zigzag_to_row_major[i]];
      const std::size_t width = out.block_width(x);
      const std::size_t height = out.block_height(y);
      if (width == block_size && height == block_size) continue;
      std::array<float, max_terms> pixels;
      inverse_dct(coefficients, pixels);
      transform_block(pixels, width, height, coefficients);
    }
  }
}

}  // namespace detail

FREQSYNTH_INLINE FrequencyImage dequantize(const QuantizedImage& image) {
  image.validate();
  const detail::SamplingFactors largest = detail::largest_factors(image);
  for (const QuantizedComponent& component : image.components) {
    if (largest.horizontal % component.horizontal != 0 ||
        largest.vertical % component.vertical != 0) {
      detail::refuse("quantized image: sampling factors " + std::to_string(component.horizontal) +
                     " x " + std::to_string(component.vertical) + " do not divide the largest, " +
                     std::to_string(largest.horizontal) + " x " + std::to_string(largest.vertical));
    }
  }
  FrequencyImage result(image.width, image.height, image.components.size(),
                        CoefficientMeaning::pixel_average);
  for (std::size_t channel = 0; channel < image.components.size(); ++channel) {
    const QuantizedComponent& component = image.components[channel];
    detail::dequantize_component(
        component, image.tables[component.table],
        static_cast<std::size_t>(largest.horizontal / component.horizontal),
        static_cast<std::size_t>(largest.vertical / component.vertical), channel, result);
  }
  return result;
}

}  // namespace freqsynth
