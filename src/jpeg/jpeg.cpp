// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/jpeg.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "libjpeg_session.h"

namespace freqsynth {
namespace {

using detail::Errors;
using detail::guarded;
using detail::Session;

/// Compressed bytes go to a vector.
struct Destination : jpeg_destination_mgr {
  std::vector<std::uint8_t> bytes;

  Destination() {
    init_destination = [](j_compress_ptr info) { grow(info, 0); };
    empty_output_buffer = [](j_compress_ptr info) -> boolean {
      grow(info, of(info).bytes.size());
      return TRUE;
    };
    term_destination = [](j_compress_ptr info) {
      Destination& self = of(info);
      self.bytes.resize(self.bytes.size() - self.free_in_buffer);
    };
  }

 private:
  static Destination& of(j_compress_ptr info) { return *static_cast<Destination*>(info->dest); }

  static void grow(j_compress_ptr info, std::size_t used) {
    Destination& self = of(info);
    bool grown = true;
    try {
      self.bytes.resize(std::max<std::size_t>(2 * used, 1 << 16));
    } catch (const std::exception&) {
      grown = false;
    }
    // Not within the handler, which longjmp must not leave.
    if (!grown) ERREXIT1(info, JERR_OUT_OF_MEMORY, 0);
    self.next_output_byte = self.bytes.data() + used;
    self.free_in_buffer = self.bytes.size() - used;
  }
};

[[noreturn]] void refuse(const std::string& why) { detail::refuse("encode_jpeg: " + why); }

/// What QuantizedImage::validate() lets pass and JPEG cannot say.
void check(const QuantizedImage& image) {
  image.validate();
  if (image.width > JPEG_MAX_DIMENSION || image.height > JPEG_MAX_DIMENSION) {
    refuse("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
           " pixels; libjpeg writes no side above " + std::to_string(JPEG_MAX_DIMENSION));
  }
  if (image.components.size() != 1 && image.components.size() != 3) {
    refuse(std::to_string(image.components.size()) + " components, not 1 or 3");
  }
  if (image.tables.size() > NUM_QUANT_TBLS) {
    refuse(std::to_string(image.tables.size()) + " tables, more than 4");
  }
  int blocks = 0;
  for (const QuantizedComponent& component : image.components) {
    blocks += component.horizontal * component.vertical;
  }
  if (image.components.size() > 1 && blocks > C_MAX_BLOCKS_IN_MCU) {
    refuse("sampling factors that make groups of " + std::to_string(blocks) +
           " blocks, more than 10");
  }
  for (std::size_t c = 0; c < image.components.size(); ++c) {
    const auto& values = image.components[c].values;
    for (std::size_t first = 0; first < values.size(); first += max_terms) {
      int least = values[first] + 1, most = values[first];  // DC may be -1024
      for (std::size_t i = 1; i < max_terms; ++i) {
        least = std::min<int>(least, values[first + i]);
        most = std::max<int>(most, values[first + i]);
      }
      if (least < -1023 || most > 1023) {
        const int value = most > 1023 ? most : std::min<int>(least, values[first]);
        refuse("block " + std::to_string(first / max_terms) + " of component " + std::to_string(c) +
               " holds " + std::to_string(value) + ", which baseline JPEG cannot code");
      }
    }
  }
}

/// Creates the object and describes the image. The arrays are those of libjpeg, not yet filled.
void describe(jpeg_compress_struct& info, const QuantizedImage& image, const JpegOptions& options,
              jvirt_barray_ptr* arrays) {
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = static_cast<int>(image.components.size());
  info.in_color_space = image.components.size() == 1 ? JCS_GRAYSCALE : JCS_YCbCr;
  jpeg_set_defaults(&info);
  info.optimize_coding = options.optimize ? TRUE : FALSE;
  auto* common = reinterpret_cast<j_common_ptr>(&info);
  for (std::size_t t = 0; t < image.tables.size(); ++t) {
    if (info.quant_tbl_ptrs[t] == nullptr) info.quant_tbl_ptrs[t] = jpeg_alloc_quant_table(common);
    for (std::size_t i = 0; i < max_terms; ++i) {
      info.quant_tbl_ptrs[t]->quantval[detail::zigzag_to_row_major[i]] = image.tables[t][i];
    }
  }
  for (std::size_t c = 0; c < image.components.size(); ++c) {
    const QuantizedComponent& component = image.components[c];
    info.comp_info[c].h_samp_factor = component.horizontal;
    info.comp_info[c].v_samp_factor = component.vertical;
    info.comp_info[c].quant_tbl_no = static_cast<int>(component.table);
    // Whole groups of rows: libjpeg asks for them, though it codes only the image's own.
    const auto rows = static_cast<JDIMENSION>(component.vertical);
    const auto height = static_cast<JDIMENSION>(component.blocks_y) + rows - 1;
    arrays[c] = info.mem->request_virt_barray(common, JPOOL_IMAGE, FALSE,
                                              static_cast<JDIMENSION>(component.blocks_x),
                                              height / rows * rows, rows);
  }
  if (options.progressive) jpeg_simple_progression(&info);
}

/// Blocks in zig-zag order to the natural order of libjpeg.
void fill(jpeg_compress_struct& info, const QuantizedComponent& component, jvirt_barray_ptr array) {
  auto* common = reinterpret_cast<j_common_ptr>(&info);
  const auto rows = static_cast<std::size_t>(component.vertical);
  const std::int16_t* in = component.values.data();
  for (std::size_t y = 0; y < component.blocks_y; y += rows) {
    JBLOCKARRAY blocks = info.mem->access_virt_barray(common, array, static_cast<JDIMENSION>(y),
                                                      static_cast<JDIMENSION>(rows), TRUE);
    for (std::size_t row = 0; row < std::min(rows, component.blocks_y - y); ++row) {
      for (std::size_t x = 0; x < component.blocks_x; ++x, in += max_terms) {
        JCOEF* out = blocks[row][x];
        for (std::size_t i = 0; i < max_terms; ++i) out[i] = in[detail::row_major_to_zigzag[i]];
      }
    }
  }
}

/// Ends the reading of a file with more passes than are allowed; libjpeg calls it all the time.
struct PassLimit : jpeg_progress_mgr {
  std::size_t most;

  explicit PassLimit(std::size_t passes) : jpeg_progress_mgr(), most(passes) {
    progress_monitor = [](j_common_ptr info) {
      const auto number = reinterpret_cast<j_decompress_ptr>(info)->input_scan_number;
      const std::size_t allowed = static_cast<PassLimit*>(info->progress)->most;
      if (number <= 0 || static_cast<std::size_t>(number) <= allowed) return;
      char text[80];
      std::snprintf(text, sizeof text, "more than the limit of %zu scans", allowed);
      Errors::leave_with(info, text);
    };
  }
};

/// What libjpeg may take for the coefficients of an image within the limit of pixels: three
/// components of 2 bytes each; and what is added to narrow images to make whole groups of blocks.
long memory_for(std::uint64_t pixels) {
  constexpr std::uint64_t narrow = 32 << 20;
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<long>::max());
  return static_cast<long>(pixels > (most - narrow) / 6 ? most : 6 * pixels + narrow);
}

[[noreturn]] void refuse_file(const std::string& why) {
  throw std::runtime_error("freqsynth: decode_jpeg: " + why);
}

const char* name_of(J_COLOR_SPACE space) {
  switch (space) {
    case JCS_RGB:
      return "RGB";
    case JCS_CMYK:
      return "CMYK";
    case JCS_YCCK:
      return "YCCK";
    default:
      return "unknown colours";
  }
}

/// Appends a component, and its table where the image has not got it yet.
void take_component(Session<jpeg_decompress_struct>& session, int number, jvirt_barray_ptr array,
                    QuantizedImage& image) {
  jpeg_decompress_struct& info = session.info;
  const jpeg_component_info& from = info.comp_info[number];
  // A file may define a table anew between two components.
  QuantizationTable table{};
  for (std::size_t i = 0; i < max_terms; ++i) {
    table[i] = from.quant_table->quantval[detail::zigzag_to_row_major[i]];
  }
  const auto place = std::find(image.tables.begin(), image.tables.end(), table);
  QuantizedComponent& component = image.components.emplace_back();
  component.table = static_cast<std::size_t>(place - image.tables.begin());
  if (place == image.tables.end()) image.tables.push_back(table);
  component.horizontal = from.h_samp_factor;
  component.vertical = from.v_samp_factor;
  component.blocks_x = from.width_in_blocks;
  component.blocks_y = from.height_in_blocks;
  component.values.resize(component.blocks_x * component.blocks_y * max_terms);
  std::int16_t* out = component.values.data();
  guarded(session.errors, "decode_jpeg", [&] {
    for (JDIMENSION y = 0; y < from.height_in_blocks; ++y) {
      JBLOCKARRAY row = info.mem->access_virt_barray(session.common(), array, y, 1, FALSE);
      for (JDIMENSION x = 0; x < from.width_in_blocks; ++x) {
        for (const std::size_t place_of_term : detail::zigzag_to_row_major) {
          *out++ = row[0][x][place_of_term];
        }
      }
    }
  });
}

}  // namespace

std::vector<std::uint8_t> encode_jpeg(const QuantizedImage& image, const JpegOptions& options) {
  check(image);
  Destination destination;
  Session<jpeg_compress_struct> session;
  jpeg_compress_struct& info = session.info;
  guarded(session.errors, "encode_jpeg", [&] {
    jpeg_create_compress(&info);
    info.dest = &destination;
    jvirt_barray_ptr arrays[MAX_COMPONENTS];
    describe(info, image, options, arrays);
    jpeg_write_coefficients(&info, arrays);
    // The call above has allocated the arrays; they are read when the file is finished.
    for (std::size_t c = 0; c < image.components.size(); ++c) {
      fill(info, image.components[c], arrays[c]);
    }
    jpeg_finish_compress(&info);
  });
  return std::move(destination.bytes);
}

QuantizedImage decode_jpeg(std::span<const std::uint8_t> data, const JpegLimits& limits) {
  if (data.size() > limits.bytes) {
    refuse_file("more than the limit of " + std::to_string(limits.bytes) + " bytes");
  }
  PassLimit passes(limits.scans);
  Session<jpeg_decompress_struct> session;
  jpeg_decompress_struct& info = session.info;
  jvirt_barray_ptr* arrays = nullptr;
  guarded(session.errors, "decode_jpeg", [&] {
    jpeg_create_decompress(&info);
    info.progress = &passes;
    info.mem->max_memory_to_use = memory_for(limits.pixels);
    jpeg_mem_src(&info, data.data(), static_cast<unsigned long>(data.size()));
    jpeg_read_header(&info, TRUE);
  });
  if (info.jpeg_color_space != JCS_GRAYSCALE && info.jpeg_color_space != JCS_YCbCr) {
    refuse_file("the image is " + std::string(name_of(info.jpeg_color_space)) +
                ", not grayscale or YCbCr");
  }
  if (std::uint64_t{info.image_width} * info.image_height > limits.pixels) {
    refuse_file("an image of " + std::to_string(info.image_width) + " x " +
                std::to_string(info.image_height) + " pixels, more than the limit of " +
                std::to_string(limits.pixels));
  }
  guarded(session.errors, "decode_jpeg", [&] { arrays = jpeg_read_coefficients(&info); });

  QuantizedImage image;
  image.width = info.image_width;
  image.height = info.image_height;
  for (int c = 0; c < info.num_components; ++c) {
    if (info.comp_info[c].quant_table == nullptr) {
      refuse_file("component " + std::to_string(c) + " has no data");
    }
    take_component(session, c, arrays[c], image);
  }
  try {
    image.validate();
  } catch (const std::invalid_argument& fault) {
    refuse_file(std::string("damaged: ") + fault.what());
  }
  return image;
}

}  // namespace freqsynth
