#include "freqsynth/jpeg/display_encoding.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/dct.h"

namespace freqsynth {

void DisplayEncoding::validate() const {
  if (!(exposure > 0 && std::isfinite(exposure))) {
    throw std::invalid_argument("freqsynth: exposure is " + std::to_string(exposure) +
                                ", not a finite number > 0");
  }
}

void detail::check_display_channels(std::size_t channels, std::size_t sampler_channels) {
  if (channels != 1 && channels != 3) {
    throw std::invalid_argument("freqsynth: display encoding of " + std::to_string(channels) +
                                " channels, not 1 or 3");
  }
  if (sampler_channels != channels) {
    throw std::invalid_argument("freqsynth: display encoding of " + std::to_string(channels) +
                                " channels for a sampler that returns " +
                                std::to_string(sampler_channels) + " values");
  }
}

FrequencyImage encode_pixels(const FrequencyImage& linear, const DisplayEncoding& encoding,
                             const ReconstructionSettings& settings) {
  const std::size_t channels = linear.channels();
  detail::check_display_channels(channels, channels);
  encoding.validate();
  // Whole blocks, also where they reach beyond the image.
  FrequencyImage whole(linear.blocks_x() * block_size, linear.blocks_y() * block_size, channels,
                       linear.meaning());
  for (std::size_t by = 0; by < whole.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < whole.blocks_x(); ++bx) {
      whole.samples(bx, by) = linear.samples(bx, by);
      for (std::size_t c = 0; c < channels; ++c) {
        const auto coefficients = linear.coefficients(bx, by, c);
        std::copy(coefficients.begin(), coefficients.end(), whole.coefficients(bx, by, c).begin());
      }
    }
  }
  std::vector<float> pixels = reconstruct(whole, settings);
  if (channels == 1) {
    for (float& value : pixels) value = encoding.encode(value);
  } else {
    for (std::size_t i = 0; i < pixels.size(); i += 3) {
      const auto ycc = encoding.encode(std::array{pixels[i], pixels[i + 1], pixels[i + 2]});
      std::copy(ycc.begin(), ycc.end(), pixels.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  FrequencyImage encoded(linear.width(), linear.height(), channels,
                         CoefficientMeaning::pixel_average);
  std::array<float, max_terms> block;
  for (std::size_t by = 0; by < encoded.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < encoded.blocks_x(); ++bx) {
      encoded.samples(bx, by) = linear.samples(bx, by);
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < max_terms; ++i) {
          const std::size_t x = bx * block_size + i % block_size;
          const std::size_t y = by * block_size + i / block_size;
          block[i] = pixels[(y * whole.width() + x) * channels + c];
        }
        forward_dct(block, encoded.coefficients(bx, by, c));
      }
    }
  }
  return encoded;
}

}  // namespace freqsynth
