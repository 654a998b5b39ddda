// SPDX-License-Identifier: MIT
/// \file
/// The ordinary way to a JPEG file, through libjpeg's compressor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

#include <jpeglib.h>

#include "freqsynth/jpeg/quantization.h"

namespace freqsynth::bench {

struct PixelsToJpeg {
  int quality = 75;
  Subsampling subsampling = Subsampling::none;
  bool optimize = true;              ///< Huffman codes made for the image
  J_COLOR_SPACE pixels = JCS_YCbCr;  ///< or JCS_RGB
};

/// The file of 8-bit pixels, three channels interleaved, row by row.
inline std::vector<std::uint8_t> pixels_to_jpeg(std::span<const std::uint8_t> pixels,
                                                std::size_t width, std::size_t height,
                                                const PixelsToJpeg& options) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = 3;
  info.in_color_space = options.pixels;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, options.quality, TRUE);
  info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor =
      options.subsampling == Subsampling::both ? 2 : 1;
  info.optimize_coding = options.optimize ? TRUE : FALSE;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPLE*>(pixels.data() + info.next_scanline * width * 3);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::vector<std::uint8_t> file(bytes, bytes + size);
  std::free(bytes);
  return file;
}

}  // namespace freqsynth::bench
