// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "freqsynth/basis/check.h"
#include "freqsynth/jpeg/quantized_image.h"

namespace freqsynth {
namespace detail {

[[noreturn]] inline void refuse_quantized(const std::string& why) {
  refuse("quantized image: " + why);
}

/// "4 x 3"
inline std::string pair_text(std::size_t a, std::size_t b) {
  return std::to_string(a) + " x " + std::to_string(b);
}

/// Blocks that cover `pixels` at `factor` of `largest` of the resolution (ITU-T T.81, A.1.1).
inline std::size_t component_blocks(std::size_t pixels, int factor, int largest) {
  const std::size_t coarse = block_size * static_cast<std::size_t>(largest);
  const auto times = static_cast<std::size_t>(factor);
  return pixels / coarse * times + (pixels % coarse * times + coarse - 1) / coarse;
}

/// Checks what one component says against the rest of the image.
inline void check_component(const QuantizedImage& image, std::size_t number,
                            const SamplingFactors& largest) {
  const QuantizedComponent& component = image.components[number];
  const std::string name = "component " + std::to_string(number);
  const auto possible = [](int factor) { return factor >= 1 && factor <= 4; };
  if (!possible(component.horizontal) || !possible(component.vertical)) {
    refuse_quantized(name + " has sampling factors " + std::to_string(component.horizontal) +
                     " x " + std::to_string(component.vertical) + ", not in 1..4");
  }
  if (component.table >= image.tables.size()) {
    refuse_quantized(name + " names table " + std::to_string(component.table) + " of " +
                     std::to_string(image.tables.size()));
  }
  const std::size_t x = component_blocks(image.width, component.horizontal, largest.horizontal);
  const std::size_t y = component_blocks(image.height, component.vertical, largest.vertical);
  if (component.blocks_x != x || component.blocks_y != y) {
    refuse_quantized(name + " has " + pair_text(component.blocks_x, component.blocks_y) +
                     " blocks, not " + pair_text(x, y));
  }
  const std::size_t blocks = component.values.size() / max_terms;
  if (component.values.size() % max_terms != 0 || blocks % x != 0 || blocks / x != y) {
    refuse_quantized(name + " has " + std::to_string(component.values.size()) + " values for " +
                     pair_text(x, y) + " blocks");
  }
}

FREQSYNTH_INLINE SamplingFactors largest_factors(const QuantizedImage& image) {
  SamplingFactors largest;
  for (const QuantizedComponent& component : image.components) {
    largest.horizontal = std::max(largest.horizontal, component.horizontal);
    largest.vertical = std::max(largest.vertical, component.vertical);
  }
  return largest;
}

}  // namespace detail

FREQSYNTH_INLINE void QuantizedImage::validate() const {
  if (width == 0 || height == 0) {
    detail::refuse_quantized(detail::pair_text(width, height) + " pixels");
  }
  if (components.empty()) detail::refuse_quantized("no component");
  for (std::size_t t = 0; t < tables.size(); ++t) {
    detail::check_table(tables[t], ("quantized image: table " + std::to_string(t)).c_str());
  }
  const detail::SamplingFactors largest = detail::largest_factors(*this);
  for (std::size_t c = 0; c < components.size(); ++c) detail::check_component(*this, c, largest);
}

}  // namespace freqsynth
