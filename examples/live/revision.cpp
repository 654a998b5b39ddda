// SPDX-License-Identifier: MIT
#include "revision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/jpeg/quantization.h"
#include "shown_light.h"

namespace live {
namespace {

std::string bytes_of(const freqsynth::QuantizedImage& image) {
  const std::vector<std::uint8_t> bytes = freqsynth::encode_jpeg(image, {.progressive = true});
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A pixel for each block, in gray.
/// \param levels  row by row, 0..255
std::string block_jpeg(std::size_t columns, std::size_t rows, const std::vector<float>& levels) {
  constexpr std::uint16_t step = 2;
  freqsynth::QuantizedImage image;
  image.width = columns;
  image.height = rows;
  image.tables.emplace_back().fill(step);
  freqsynth::QuantizedComponent& gray = image.components.emplace_back();
  gray.blocks_x = (columns + 7) / 8;
  gray.blocks_y = (rows + 7) / 8;
  std::array<float, 64> pixels{}, coefficients{};
  for (std::size_t block = 0; block < gray.blocks_x * gray.blocks_y; ++block) {
    for (std::size_t p = 0; p < 64; ++p) {
      const std::size_t x = std::min(block % gray.blocks_x * 8 + p % 8, columns - 1);
      const std::size_t y = std::min(block / gray.blocks_x * 8 + p / 8, rows - 1);
      pixels[p] = levels[y * columns + x] - 128;  // the zero of JPEG
    }
    freqsynth::forward_dct(pixels, coefficients);
    for (const float coefficient : coefficients) {
      gray.values.push_back(static_cast<std::int16_t>(std::lround(coefficient / step)));
    }
  }
  return bytes_of(image);
}

}  // namespace

std::string picture_jpeg(const freqsynth::FrequencyImage& image, const View& view) {
  freqsynth::QuantizationSettings settings;
  settings.luminance = freqsynth::scale_table(freqsynth::luminance_table(), view.quality);
  settings.chrominance = freqsynth::scale_table(freqsynth::chrominance_table(), view.quality);
  settings.subsampling = freqsynth::Subsampling::both;
  return bytes_of(freqsynth::quantize(exposed(image, view.stops), settings));
}

std::string density_jpeg(const freqsynth::FrequencyImage& image, std::uint32_t& most) {
  most = 1;
  std::vector<float> levels;
  for (std::size_t by = 0; by < image.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
      most = std::max(most, image.samples(bx, by));
      levels.push_back(static_cast<float>(image.samples(bx, by)));
    }
  }
  for (float& level : levels) level = 255 * std::sqrt(level / static_cast<float>(most));
  return block_jpeg(image.blocks_x(), image.blocks_y(), levels);
}

std::string error_jpeg(const freqsynth::Synthesizer& engine, const View& view) {
  const freqsynth::PixelWindow window = engine.window();
  const std::vector<float> errors = engine.error_image();
  const std::size_t columns = (window.width + 7) / 8, rows = (window.height + 7) / 8;
  std::vector<double> squares(columns * rows);
  std::vector<double> counts(columns * rows);
  for (std::size_t p = 0; p < window.width * window.height; ++p) {
    const std::size_t block = p / window.width / 8 * columns + p % window.width / 8;
    for (std::size_t c = 0; c < shown_channels; ++c) {
      squares[block] += std::pow(double{errors[p * channels + c]}, 2) / shown_channels;
    }
    ++counts[block];
  }
  const double factor = double{exposure_factor(view.stops)} / most_error;
  std::vector<float> levels;
  for (std::size_t block = 0; block < squares.size(); ++block) {
    const double share = factor * std::sqrt(squares[block] / counts[block]);
    levels.push_back(static_cast<float>(255 * std::sqrt(std::min(share, 1.0))));
  }
  return block_jpeg(columns, rows, levels);
}

}  // namespace live
