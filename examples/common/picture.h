// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "freqsynth/jpeg/quantization.h"
#include "output_file.h"

/// Pixels, row by row, channels interleaved.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 3;
  std::vector<float> pixels;
  bool encoded = false;  ///< values are display-encoded (sRGB, 0..1) instead of linear
};

/// How a JPEG file is written.
struct JpegSettings {
  int quality = 95;  ///< 1..100
  freqsynth::Subsampling subsampling = freqsynth::Subsampling::none;
};

/// Writes a picture. The ending of the name chooses the format: EXR, PFM, HDR and TIFF hold the
/// linear values, all others get 8 bits in sRGB. Whole or not at all, see output_file.h.
/// \throws std::runtime_error naming the file and the reason.
void write_picture(const std::string& file, const Picture& picture, const JpegSettings& jpeg = {});

/// Says before the work what write_picture() would say after it of a picture of that size.
/// \throws std::runtime_error naming the file and the reason.
void check_picture(const std::string& file, std::size_t width, std::size_t height,
                   std::size_t channels);

/// \throws std::runtime_error naming the file when a JPEG file cannot be of that size.
void check_jpeg_size(const std::string& file, std::size_t width, std::size_t height);

/// Writes text, in the same way.
void write_text(const std::string& file, const std::string& text);

/// Pictures of one size side by side, `columns` in a row, on white.
Picture contact_sheet(const std::vector<Picture>& pictures, std::size_t columns);
