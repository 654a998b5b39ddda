// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "freqsynth/image/frequency_image.h"
#include "options.h"

/// The tables and the chroma resolution of the JPEG file.
freqsynth::QuantizationSettings quantization_of(const Options& options);

/// Quantises an image of `options.averaging` and writes it as a JPEG file, without pixels where the
/// samples were display-encoded. Says on stderr when coefficients had to be clamped.
/// \throws std::runtime_error naming the file and the reason, or when this program was built without
///         libjpeg.
void write_direct(const Options& options, const freqsynth::FrequencyImage& image);

/// Says before the work what write_direct() would say after it.
/// \throws std::runtime_error naming the file and the reason, or for want of libjpeg.
void check_direct(const Options& options);
