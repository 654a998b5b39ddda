// SPDX-License-Identifier: MIT
/// \file
/// libjpeg's own way from pixels to files and back, to compare with.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <span>
#include <vector>

#include <jpeglib.h>

namespace freqsynth::test {

using Bytes = std::vector<std::uint8_t>;

/// 8-bit samples, row by row, channels interleaved, in the file's own colour space.
struct DecodedPixels {
  std::size_t width = 0, height = 0, channels = 0;
  std::vector<std::uint8_t> values;
};

inline DecodedPixels decode_pixels(std::span<const std::uint8_t> data, J_DCT_METHOD method) {
  jpeg_decompress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, data.data(), static_cast<unsigned long>(data.size()));
  jpeg_read_header(&info, TRUE);
  info.out_color_space = info.jpeg_color_space;
  info.dct_method = method;
  info.do_fancy_upsampling = FALSE;
  info.do_block_smoothing = FALSE;
  jpeg_start_decompress(&info);
  DecodedPixels pixels;
  pixels.width = info.output_width;
  pixels.height = info.output_height;
  pixels.channels = static_cast<std::size_t>(info.output_components);
  pixels.values.resize(pixels.width * pixels.height * pixels.channels);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = pixels.values.data() + info.output_scanline * pixels.width * pixels.channels;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return pixels;
}

struct Compression {
  J_COLOR_SPACE space = JCS_YCbCr;  ///< of the pixels and of the file
  int channels = 3;
  int horizontal = 1, vertical = 1;  ///< of the first component
  bool progressive = false;
  bool arithmetic = false;
  unsigned restart_interval = 0;
  const jpeg_scan_info* script = nullptr;  ///< the scans of a progressive file
  std::size_t script_size = 0;
};

inline Bytes encode_pixels_with_libjpeg(std::size_t width, std::size_t height,
                                        const Compression& how) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(width);
  info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = how.channels;
  info.in_color_space = how.space;
  jpeg_set_defaults(&info);
  jpeg_set_colorspace(&info, how.space);
  jpeg_set_quality(&info, 80, TRUE);
  info.comp_info[0].h_samp_factor = how.horizontal;
  info.comp_info[0].v_samp_factor = how.vertical;
  info.restart_interval = how.restart_interval;
  info.arith_code = how.arithmetic ? TRUE : FALSE;
  if (how.progressive) jpeg_simple_progression(&info);
  if (how.script != nullptr) {
    info.scan_info = how.script;
    info.num_scans = static_cast<int>(how.script_size);
  }
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> row(width * static_cast<std::size_t>(how.channels));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = static_cast<std::uint8_t>((i * (y + 7) + 40 * (i % 3)) % 251);
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&info, &line, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  Bytes result(bytes, bytes + size);
  std::free(bytes);
  return result;
}

/// A grayscale file, baseline, whose coefficients are all 0: a few bytes for very many pixels.
inline Bytes black_hole(std::size_t width, std::size_t height, std::size_t blocks_in_file) {
  // 3 bytes are 4 blocks: "no difference" is 00 and "end of block" 1010 in the standard's codes.
  const Bytes four_blocks{0x28, 0xa2, 0x8a};
  Bytes file = encode_pixels_with_libjpeg(8, 8, {.space = JCS_GRAYSCALE, .channels = 1});
  const auto marker = [&](std::uint8_t kind) {
    const Bytes wanted{0xff, kind};
    return std::search(file.begin(), file.end(), wanted.begin(), wanted.end());
  };
  const auto frame = marker(0xc0);
  frame[5] = static_cast<std::uint8_t>(height >> 8);
  frame[6] = static_cast<std::uint8_t>(height);
  frame[7] = static_cast<std::uint8_t>(width >> 8);
  frame[8] = static_cast<std::uint8_t>(width);
  const auto scan = marker(0xda);
  file.erase(scan + 2 + scan[3], file.end());
  for (std::size_t i = 0; i < (blocks_in_file + 3) / 4; ++i) {
    file.insert(file.end(), four_blocks.begin(), four_blocks.end());
  }
  file.insert(file.end(), {0xff, 0xd9});
  return file;
}

/// A progressive grayscale file whose last scan comes `repeats` times more.
inline Bytes many_scans(std::size_t width, std::size_t height, std::size_t repeats) {
  const jpeg_scan_info script[] = {{1, {0, 0, 0, 0}, 0, 0, 0, 0}, {1, {0, 0, 0, 0}, 1, 63, 0, 0}};
  Bytes file = encode_pixels_with_libjpeg(
      width, height,
      {.space = JCS_GRAYSCALE, .channels = 1, .script = script, .script_size = std::size(script)});
  // The last scan with the codes that it uses.
  const Bytes codes{0xff, 0xc4};
  const auto last = std::find_end(file.begin(), file.end(), codes.begin(), codes.end());
  const Bytes scan(last, file.end() - 2);
  file.resize(file.size() - 2);
  for (std::size_t i = 0; i < repeats; ++i) file.insert(file.end(), scan.begin(), scan.end());
  file.insert(file.end(), {0xff, 0xd9});
  return file;
}

}  // namespace freqsynth::test
