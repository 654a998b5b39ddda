// SPDX-License-Identifier: MIT
/// \file
/// Quantised images to the bytes of JPEG files and back: the coefficients themselves, no pixel is
/// ever made. Component `freqsynth::jpeg`, which needs libjpeg; not part of freqsynth.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/jpeg/quantized_image.h"

namespace freqsynth {

/// How coefficients are coded; it does not change the picture.
struct JpegOptions {
  bool progressive = false;  ///< coarse to fine instead of top to bottom; implies `optimize`
  bool optimize = true;      ///< Huffman codes made for this image: a second pass, a smaller file
};

/// How much a file may ask of its reader. A few bytes can claim any size, and a black image of
/// 65500 x 65500 pixels is a file of 17 MB. Every limit may be raised.
struct JpegLimits {
  /// Width times height. Reading takes up to 12 bytes of memory for each of them.
  std::uint64_t pixels = 100'000'000;
  std::uint64_t bytes = 256 << 20;  ///< of the file
  /// Passes over the image in which the file is coded: 1 of a baseline file, about 10 of a
  /// progressive one. Each takes the time of a whole image, however few bytes it has.
  std::size_t scans = 200;
};

/// The bytes of a JFIF file that holds exactly these coefficients, tables and sampling factors.
/// One component is written as grayscale, three as YCbCr. A step above 255 makes the file
/// "extended", which most decoders read, instead of baseline.
/// \throws std::invalid_argument naming the fault when QuantizedImage::validate() does, or when
///         JPEG (or libjpeg) cannot say it: a side of more than 65500 pixels, components other than
///         1 or 3, more than 4 tables, sampling factors with a sum of products above 10, AC values
///         beyond +-1023, DC values not in -1024..1023.
/// \throws std::runtime_error with libjpeg's message when libjpeg fails.
[[nodiscard]] FREQSYNTH_API std::vector<std::uint8_t> encode_jpeg(const QuantizedImage& image,
                                                                  const JpegOptions& options = {});

/// Coefficients, tables and sampling factors of the bytes of a JPEG file, baseline or progressive,
/// grayscale or YCbCr. QuantizedImage::clamped is 0.
/// \throws std::runtime_error with libjpeg's message when the data is no JPEG, is cut off or damaged
///         (also where libjpeg would only warn and guess), or saying so when it is of another kind,
///         RGB, CMYK, YCCK, or beyond a limit; what is beyond one is not allocated.
[[nodiscard]] FREQSYNTH_API QuantizedImage decode_jpeg(std::span<const std::uint8_t> data,
                                                       const JpegLimits& limits = {});

}  // namespace freqsynth
