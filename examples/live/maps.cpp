// SPDX-License-Identifier: MIT
#include "maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/jpeg.h"
#include "shown_light.h"

namespace live {

BlockMap samples_of(const freqsynth::FrequencyImage& image) {
  BlockMap map{image.blocks_x(), image.blocks_y(), {}};
  for (std::size_t by = 0; by < map.rows; ++by) {
    for (std::size_t bx = 0; bx < map.columns; ++bx) {
      map.values.push_back(static_cast<float>(image.samples(bx, by)));
    }
  }
  return map;
}

BlockMap errors_of(const freqsynth::Synthesizer& engine) {
  const freqsynth::PixelWindow window = engine.window();
  const std::vector<float> errors = engine.error_image();
  BlockMap map{(window.width + 7) / 8, (window.height + 7) / 8, {}};
  std::vector<double> squares(map.columns * map.rows), counts(map.columns * map.rows);
  for (std::size_t p = 0; p < window.width * window.height; ++p) {
    const std::size_t block = p / window.width / 8 * map.columns + p % window.width / 8;
    for (std::size_t c = 0; c < shown_channels; ++c) {
      squares[block] += std::pow(double{errors[p * channels + c]}, 2) / shown_channels;
    }
    ++counts[block];
  }
  for (std::size_t block = 0; block < squares.size(); ++block) {
    map.values.push_back(static_cast<float>(std::sqrt(squares[block] / counts[block])));
  }
  return map;
}

std::vector<std::uint8_t> map_jpeg(const BlockMap& map, double white) {
  constexpr std::uint16_t step = 2;
  freqsynth::QuantizedImage image;
  image.width = map.columns;
  image.height = map.rows;
  image.tables.emplace_back().fill(step);
  freqsynth::QuantizedComponent& gray = image.components.emplace_back();
  gray.blocks_x = (map.columns + 7) / 8;
  gray.blocks_y = (map.rows + 7) / 8;
  std::array<float, 64> pixels{}, coefficients{};
  for (std::size_t block = 0; block < gray.blocks_x * gray.blocks_y; ++block) {
    for (std::size_t p = 0; p < 64; ++p) {
      const std::size_t x = std::min(block % gray.blocks_x * 8 + p % 8, map.columns - 1);
      const std::size_t y = std::min(block / gray.blocks_x * 8 + p / 8, map.rows - 1);
      const double share = std::min(double{map.values[y * map.columns + x]} / white, 1.0);
      pixels[p] = static_cast<float>(255 * std::sqrt(share)) - 128;  // the zero of JPEG
    }
    freqsynth::forward_dct(pixels, coefficients);
    for (const float coefficient : coefficients) {
      gray.values.push_back(static_cast<std::int16_t>(std::lround(coefficient / step)));
    }
  }
  return freqsynth::encode_jpeg(image, {.progressive = true});
}

}  // namespace live
