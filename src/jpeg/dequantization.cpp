#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/jpeg/quantization.h"
#include "jpeg/block_scaling.h"

namespace freqsynth {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument("freqsynth: quantized image: " + why);
}

std::string pair_of(std::size_t a, std::size_t b) {
  return std::to_string(a) + " x " + std::to_string(b);
}

struct Factors {
  int horizontal = 1, vertical = 1;
};

Factors largest_factors(const QuantizedImage& image) {
  Factors largest;
  for (const QuantizedComponent& component : image.components) {
    largest.horizontal = std::max(largest.horizontal, component.horizontal);
    largest.vertical = std::max(largest.vertical, component.vertical);
  }
  return largest;
}

/// Blocks that cover `pixels` at `factor` of `largest` of the resolution (ITU-T T.81, A.1.1).
std::size_t blocks_of(std::size_t pixels, int factor, int largest) {
  const std::size_t coarse = block_size * static_cast<std::size_t>(largest);
  const auto times = static_cast<std::size_t>(factor);
  return pixels / coarse * times + (pixels % coarse * times + coarse - 1) / coarse;
}

std::vector<detail::AxisMap> enlarging_maps(std::size_t factor) {
  std::vector<detail::AxisMap> maps;
  for (std::size_t part = 0; part < factor; ++part) {
    maps.push_back(detail::AxisMap::enlarge(part, factor));
  }
  return maps;
}

void dequantize(const QuantizedComponent& component, const QuantizationTable& table,
                std::size_t across, std::size_t down, std::size_t channel, FrequencyImage& out) {
  const std::vector<detail::AxisMap> maps_x = enlarging_maps(across);
  const std::vector<detail::AxisMap> maps_y = enlarging_maps(down);
  for (std::size_t y = 0; y < out.blocks_y(); ++y) {
    for (std::size_t x = 0; x < out.blocks_x(); ++x) {
      const std::int16_t* values =
          component.values.data() + ((y / down) * component.blocks_x + x / across) * max_terms;
      detail::RowBlock block;
      for (std::size_t i = 0; i < max_terms; ++i) {
        block.values[detail::zigzag_to_row_major[i]] = static_cast<float>(values[i] * table[i]);
      }
      // Y of JPEG is shifted by -128, which is -8 * 128 in the constant coefficient (eq. 1).
      if (channel == 0) block.values[0] += 1024;
      if (across * down > 1) {
        block = detail::AxisMap::apply(maps_x[x % across], maps_y[y % down], block);
      }
      const auto coefficients = out.coefficients(x, y, channel);
      for (std::size_t i = 0; i < max_terms; ++i) {
        coefficients[i] = block.values[detail::zigzag_to_row_major[i]];
      }
    }
  }
}

}  // namespace

void QuantizedImage::validate() const {
  if (width == 0 || height == 0) refuse(pair_of(width, height) + " pixels");
  if (components.empty()) refuse("no component");
  for (std::size_t t = 0; t < tables.size(); ++t) {
    if (std::find(tables[t].begin(), tables[t].end(), 0) != tables[t].end()) {
      refuse("table " + std::to_string(t) + " holds a 0");
    }
  }
  const Factors largest = largest_factors(*this);
  for (std::size_t c = 0; c < components.size(); ++c) {
    const QuantizedComponent& component = components[c];
    const std::string name = "component " + std::to_string(c);
    const auto possible = [](int factor) { return factor >= 1 && factor <= 4; };
    if (!possible(component.horizontal) || !possible(component.vertical)) {
      refuse(name + " has sampling factors " + std::to_string(component.horizontal) + " x " +
             std::to_string(component.vertical) + ", not in 1..4");
    }
    if (component.table >= tables.size()) {
      refuse(name + " names table " + std::to_string(component.table) + " of " +
             std::to_string(tables.size()));
    }
    const std::size_t x = blocks_of(width, component.horizontal, largest.horizontal);
    const std::size_t y = blocks_of(height, component.vertical, largest.vertical);
    if (component.blocks_x != x || component.blocks_y != y) {
      refuse(name + " has " + pair_of(component.blocks_x, component.blocks_y) + " blocks, not " +
             pair_of(x, y));
    }
    const std::size_t blocks = component.values.size() / max_terms;
    if (component.values.size() % max_terms != 0 || blocks % x != 0 || blocks / x != y) {
      refuse(name + " has " + std::to_string(component.values.size()) + " values for " +
             pair_of(x, y) + " blocks");
    }
  }
}

FrequencyImage dequantize(const QuantizedImage& image) {
  image.validate();
  const Factors largest = largest_factors(image);
  for (const QuantizedComponent& component : image.components) {
    if (largest.horizontal % component.horizontal != 0 ||
        largest.vertical % component.vertical != 0) {
      refuse("sampling factors " + std::to_string(component.horizontal) + " x " +
             std::to_string(component.vertical) + " do not divide the largest, " +
             std::to_string(largest.horizontal) + " x " + std::to_string(largest.vertical));
    }
  }
  FrequencyImage result(image.width, image.height, image.components.size(),
                        CoefficientMeaning::pixel_average);
  for (std::size_t channel = 0; channel < image.components.size(); ++channel) {
    const QuantizedComponent& component = image.components[channel];
    dequantize(component, image.tables[component.table],
               static_cast<std::size_t>(largest.horizontal / component.horizontal),
               static_cast<std::size_t>(largest.vertical / component.vertical), channel, result);
  }
  return result;
}

}  // namespace freqsynth
