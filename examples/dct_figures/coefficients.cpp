// SPDX-License-Identifier: MIT
#include "coefficients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "../scenes/picture_file.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/dequantization.h"
#include "freqsynth/jpeg/display_encoding.h"
#ifdef FREQSYNTH_HAS_JPEG
#include "freqsynth/jpeg/jpeg_file.h"
#endif

namespace {

/// The inverse of the transfer function of sRGB, for 0..1.
float linear_of(float encoded) { return freqsynth::DisplayEncoding{}.decode(255 * encoded); }

/// Linear values, one channel or three.
Picture read_picture(const std::string& file) {
  const scenes::PictureFile stored = scenes::read_picture_file(file);
  const float* const values = stored.values.get();
  Picture picture{stored.width, stored.height, stored.channels, {values, values + stored.size()}};
  for (float& value : picture.pixels) {
    if (!std::isfinite(value) || value < 0) value = 0;
    if (stored.encoded) value = linear_of(value);
  }
  return picture;
}

/// Display-encodes linear values and transforms each block (eq. 1).
freqsynth::FrequencyImage transform(Picture picture) {
  const freqsynth::DisplayEncoding encoding;
  const std::size_t channels = picture.channels;
  for (std::size_t i = 0; i < picture.pixels.size(); i += channels) {
    float* const p = &picture.pixels[i];
    if (channels == 1) {
      *p = encoding.encode(*p);
    } else {
      std::ranges::copy(encoding.encode(std::array{p[0], p[1], p[2]}), p);
    }
  }
  return freqsynth::transform_pixels(picture.pixels, picture.width, picture.height, channels);
}

#ifdef FREQSYNTH_HAS_JPEG
/// Whatever its name is.
bool is_jpeg(const std::string& file) {
  std::array<char, 3> start{};
  std::ifstream(file, std::ios::binary).read(start.data(), start.size());
  return start == std::array{'\xff', '\xd8', '\xff'};
}
#endif

}  // namespace

Coefficients read_coefficients(const std::string& file, [[maybe_unused]] bool pixels) {
  // A device may have no end, and a pipe cannot be read twice.
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error(file + ": not a regular file");
  }
#ifdef FREQSYNTH_HAS_JPEG
  if (!pixels && is_jpeg(file)) return {freqsynth::dequantize(freqsynth::read_jpeg(file)), true};
#endif
  return {transform(read_picture(file)), false};
}

Picture picture_of(const freqsynth::FrequencyImage& image) {
  Picture picture{image.width(), image.height(), image.channels(), freqsynth::reconstruct(image)};
  for (std::size_t i = 0; image.channels() == 3 && i < picture.pixels.size(); i += 3) {
    float* const p = &picture.pixels[i];
    std::ranges::copy(freqsynth::display_rgb({p[0], p[1], p[2]}), p);
  }
  return linear_picture(std::move(picture));
}

Picture linear_picture(Picture display) {
  for (float& value : display.pixels) value = linear_of(std::clamp(value, 0.0f, 255.0f) / 255);
  return display;
}
