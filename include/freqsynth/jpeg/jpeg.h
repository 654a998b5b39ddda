/// \file
/// Quantised images to JPEG files and back: the coefficients themselves, no pixel is ever made.
/// Component `freqsynth::jpeg`, which needs libjpeg; not part of freqsynth.h.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/jpeg/quantization.h"

namespace freqsynth {

struct JpegOptions {
  bool progressive = false;  ///< coarse to fine instead of top to bottom; implies `optimize`
  bool optimize = true;      ///< Huffman codes made for this image: a second pass, a smaller file
};

/// The bytes of a JFIF file that holds exactly these coefficients, tables and sampling factors.
/// One component is written as grayscale, three as YCbCr. A step above 255 makes the file
/// "extended", which most decoders read, instead of baseline.
/// \throws std::invalid_argument naming the fault when QuantizedImage::validate() does, or when
///         JPEG (or libjpeg) cannot say it: a side of more than 65500 pixels, components other than
///         1 or 3, more than 4 tables, sampling factors with a sum of products above 10, AC values
///         beyond +-1023, DC values not in -1024..1023.
/// \throws std::runtime_error with libjpeg's message when libjpeg fails.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg(const QuantizedImage& image,
                                                    const JpegOptions& options = {});

/// encode_jpeg() into a file. A file of that name is replaced when all is written and keeps its
/// content until then and on any failure; devices and pipes are written directly.
/// \throws what encode_jpeg() throws, and std::runtime_error naming the file and the system's reason
///         when it cannot be written.
void write_jpeg(const std::string& file, const QuantizedImage& image,
                const JpegOptions& options = {});

/// encode_jpeg() into a stream.
/// \throws what encode_jpeg() throws, and std::runtime_error when the stream fails.
void write_jpeg(std::ostream& stream, const QuantizedImage& image, const JpegOptions& options = {});

/// Coefficients, tables and sampling factors of the bytes of a JPEG file, baseline or progressive,
/// grayscale or YCbCr. QuantizedImage::clamped is 0.
/// \throws std::runtime_error with libjpeg's message when the data is no JPEG, is cut off or damaged
///         (also where libjpeg would only warn and guess), or saying so when it is of another kind:
///         RGB, CMYK, YCCK.
[[nodiscard]] QuantizedImage decode_jpeg(std::span<const std::uint8_t> data);

/// decode_jpeg() of a file.
/// \throws std::runtime_error naming the file and the reason.
[[nodiscard]] QuantizedImage read_jpeg(const std::string& file);

}  // namespace freqsynth
