// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "common/picture.h"
#include "freqsynth/image/frequency_image.h"

/// Reads a picture as finished pixels with the signal of JPEG: one channel Y, or Y, Cb and Cr, of
/// display values in 0..255. Alpha is ignored. `from_file` tells whether these are the coefficients
/// of a JPEG file; otherwise they are the transform of the picture's pixels.
struct Coefficients {
  freqsynth::FrequencyImage image;
  bool from_file = false;
};

/// \param pixels  transform the pixels also of a JPEG file
/// \throws std::runtime_error naming the file and the reason.
Coefficients read_coefficients(const std::string& file, bool pixels);

/// The pixels of such an image. What was cut off or quantised too far is clamped to 0..255.
Picture picture_of(const freqsynth::FrequencyImage& image);

/// Display values in 0..255, clamped, as the linear values that write_picture() takes.
Picture linear_picture(Picture display);
