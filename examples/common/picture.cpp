// SPDX-License-Identifier: MIT
#include "picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "freqsynth/jpeg/display_encoding.h"

namespace {

std::string ending_of(const std::string& file) {
  return OIIO::Strutil::lower(OIIO::Filesystem::extension(file));
}

bool holds_linear(const std::string& file) {
  const std::array linear{".exr", ".pfm", ".hdr", ".tif", ".tiff"};
  return std::find(linear.begin(), linear.end(), ending_of(file)) != linear.end();
}

/// Portable float map: a header, then rows of floats from the bottom up. OpenImageIO 2.4 only reads
/// it.
std::string pfm_of(const Picture& picture, const std::vector<float>& values) {
  static_assert(std::endian::native == std::endian::little, "the scale in the header says so");
  std::string file = (picture.channels == 1 ? "Pf\n" : "PF\n") + std::to_string(picture.width) +
                     ' ' + std::to_string(picture.height) + "\n-1.0\n";
  const std::size_t row = picture.width * picture.channels;
  for (std::size_t y = picture.height; y-- > 0;) {
    file.append(reinterpret_cast<const char*>(values.data() + y * row), row * sizeof(float));
  }
  return file;
}

/// Within 0..1, also what is not finite: a picture is shown all the same.
float shown(float value) { return std::clamp(std::isnan(value) ? 0.0f : value, 0.0f, 1.0f); }

float encoded(float linear) { return freqsynth::DisplayEncoding{}.encode(shown(linear)) / 255; }
float decoded(float encoded) { return freqsynth::DisplayEncoding{}.decode(255 * shown(encoded)); }

/// The values of a file of linear values, or of 0..1 for one of 8 bits.
std::vector<float> values_for(const Picture& picture, bool linear) {
  std::vector<float> values = picture.pixels;
  if (picture.encoded && linear) {
    std::transform(values.begin(), values.end(), values.begin(), decoded);
  } else if (!picture.encoded && !linear) {
    std::transform(values.begin(), values.end(), values.begin(), encoded);
  }
  return values;
}

/// A writer of OpenImageIO's. \throws std::runtime_error for an ending that it does not know.
std::unique_ptr<OIIO::ImageOutput> output_of(const std::string& file) {
  auto output = OIIO::ImageOutput::create(file);
  if (!output) throw std::runtime_error(OIIO::geterror());
  return output;
}

[[noreturn]] void fail_writing(const OIIO::ImageOutput& output) {
  const std::string reason = output.geterror();
  throw std::runtime_error(reason.empty() ? "cannot be written" : reason);
}

/// How a picture of that size is stored.
OIIO::ImageSpec spec_of(const std::string& file, std::size_t width, std::size_t height,
                        std::size_t channels, const JpegSettings& jpeg) {
  const bool linear = holds_linear(file);
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height),
                       static_cast<int>(channels),
                       linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
  spec.attribute("CompressionQuality", jpeg.quality);
  spec.attribute("jpeg:subsampling",
                 jpeg.subsampling == freqsynth::Subsampling::both ? "4:2:0" : "4:4:4");
  return spec;
}

/// Reads a file again, whose writer may not have noticed that the disk is full.
void check_written(const std::string& name, const Picture& picture) {
  const auto input = OIIO::ImageInput::open(name);
  std::vector<unsigned char> pixels(picture.pixels.size());
  const bool whole = input && input->spec().width == static_cast<int>(picture.width) &&
                     input->spec().height == static_cast<int>(picture.height) &&
                     input->read_image(0, 0, 0, static_cast<int>(picture.channels),
                                       OIIO::TypeDesc::UINT8, pixels.data());
  if (!whole) throw std::runtime_error("cannot be written: what was written cannot be read");
}

struct Limit {
  std::string_view ending, format;
  std::size_t most;  ///< pixels of a side
};

/// What writers say only after the work, or never.
constexpr std::array limits{Limit{".jpg", "JPEG", 65500},  Limit{".jpeg", "JPEG", 65500},
                            Limit{".png", "PNG", 1000000}, Limit{".webp", "WebP", 16383},
                            Limit{".gif", "GIF", 65535},   Limit{".tga", "TGA", 65535},
                            Limit{".tpic", "TGA", 65535},  Limit{".iff", "IFF", 65535}};

void check_sides(const std::string& file, std::string_view ending, std::size_t width,
                 std::size_t height) {
  const auto* const limit = std::ranges::find(limits, ending, &Limit::ending);
  if (limit == limits.end() || (width <= limit->most && height <= limit->most)) return;
  throw std::runtime_error(file + ": " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels; " + std::string(limit->format) +
                           " is written with no side above " + std::to_string(limit->most));
}

}  // namespace

void write_picture(const std::string& file, const Picture& picture, const JpegSettings& jpeg) {
  write_whole(file, [&](const std::string& name) {
    const std::vector<float> values = values_for(picture, holds_linear(file));
    if (ending_of(file) == ".pfm") return write_bytes(name, pfm_of(picture, values));
    // In memory where the format allows: writers of OpenImageIO 2.4 do not notice a full disk
    // (PNG), or end the program (JPEG).
    OIIO::Filesystem::IOVecOutput memory;
    const auto output = output_of(file);
    const bool in_memory = output->supports("ioproxy") && output->set_ioproxy(&memory);
    const bool written =
        output->open(name, spec_of(file, picture.width, picture.height, picture.channels, jpeg)) &&
        output->write_image(OIIO::TypeDesc::FLOAT, values.data());
    if (!written || !output->close()) fail_writing(*output);
    if (in_memory) {
      const std::vector<unsigned char>& bytes = memory.buffer();
      write_bytes(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    } else if (name != file) {  // no device
      check_written(name, picture);
    }
  });
}

void check_jpeg_size(const std::string& file, std::size_t width, std::size_t height) {
  check_sides(file, ".jpg", width, height);
}

void check_picture(const std::string& file, std::size_t width, std::size_t height,
                   std::size_t channels) {
  check_sides(file, ending_of(file), width, height);
  if (ending_of(file) == ".pfm") return check_writable(file);
  try {
    (void)output_of(file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
  check_writable(file, [&](const std::string& name) {
    // The other formats begin in memory, and say nothing of the disk.
    const auto output = output_of(file);
    if (output->supports("ioproxy")) return;
    if (!output->open(name, spec_of(file, width, height, channels, {}))) fail_writing(*output);
  });
}

void write_text(const std::string& file, const std::string& text) {
  write_whole(file, [&](const std::string& name) { write_bytes(name, text); });
}

Picture contact_sheet(const std::vector<Picture>& pictures, std::size_t columns) {
  const Picture& first = pictures.front();
  const std::size_t gap = std::max<std::size_t>(2, first.width / 64);
  const std::size_t rows = (pictures.size() + columns - 1) / columns;
  Picture sheet{columns * first.width + (columns + 1) * gap,
                rows * first.height + (rows + 1) * gap,
                first.channels,
                {},
                first.encoded};
  sheet.pixels.assign(sheet.width * sheet.height * sheet.channels, 1.0f);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::size_t left = gap + i % columns * (first.width + gap);
    const std::size_t top = gap + i / columns * (first.height + gap);
    for (std::size_t y = 0; y < first.height; ++y) {
      const auto line = pictures[i].pixels.begin() +
                        static_cast<std::ptrdiff_t>(y * first.width * first.channels);
      std::copy_n(line, first.width * first.channels,
                  sheet.pixels.begin() + static_cast<std::ptrdiff_t>(
                                             ((top + y) * sheet.width + left) * first.channels));
    }
  }
  return sheet;
}
