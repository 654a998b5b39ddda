// SPDX-License-Identifier: MIT
/// \file
/// Quantised images to JPEG files and back. Component `freqsynth::jpeg`, which needs libjpeg; not
/// part of freqsynth.h.
#pragma once

#include <iosfwd>
#include <string>

#include "freqsynth/basis/config.h"
#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/jpeg/quantized_image.h"

namespace freqsynth {

/// encode_jpeg() into a file. A file of that name is replaced when all is written and keeps its
/// content until then and on any failure; devices and pipes are written directly.
/// \throws what encode_jpeg() throws, and std::runtime_error naming the file and the system's reason
///         when it cannot be written.
FREQSYNTH_API void write_jpeg(const std::string& file, const QuantizedImage& image,
                              const JpegOptions& options = {});

/// encode_jpeg() into a stream.
/// \throws what encode_jpeg() throws, and std::runtime_error when the stream fails.
FREQSYNTH_API void write_jpeg(std::ostream& stream, const QuantizedImage& image,
                              const JpegOptions& options = {});

/// decode_jpeg() of a file, which may be a pipe. Nothing is read beyond what is no JPEG, or more
/// than the limit of bytes.
/// \throws std::runtime_error naming the file and the reason.
[[nodiscard]] FREQSYNTH_API QuantizedImage read_jpeg(const std::string& file,
                                                     const JpegLimits& limits = {});

}  // namespace freqsynth
