// SPDX-License-Identifier: MIT
#include "picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "freqsynth/jpeg/display_encoding.h"

namespace {

std::string ending_of(const std::string& file) {
  return OIIO::Strutil::lower(OIIO::Filesystem::extension(file));
}

bool holds_linear(const std::string& file) {
  const std::array linear{".exr", ".pfm", ".hdr", ".tif", ".tiff"};
  return std::find(linear.begin(), linear.end(), ending_of(file)) != linear.end();
}

void write_bytes(const std::string& name, const std::vector<unsigned char>& bytes) {
  std::ofstream stream(name, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw std::runtime_error("cannot be written");
}

/// Portable float map: a header, then rows of floats from the bottom up. OpenImageIO 2.4 only reads
/// it.
void write_pfm(const std::string& name, const Picture& picture) {
  static_assert(std::endian::native == std::endian::little, "the scale in the header says so");
  std::ofstream stream(name, std::ios::binary);
  stream << (picture.channels == 1 ? "Pf" : "PF") << '\n'
         << picture.width << ' ' << picture.height << "\n-1.0\n";
  const std::size_t row = picture.width * picture.channels;
  for (std::size_t y = picture.height; y-- > 0;) {
    stream.write(reinterpret_cast<const char*>(picture.pixels.data() + y * row),
                 static_cast<std::streamsize>(row * sizeof(float)));
  }
  stream.close();
  if (!stream) throw std::runtime_error("cannot be written");
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

}  // namespace

void write_picture(const std::string& file, const Picture& picture, const JpegSettings& jpeg) {
  write_whole(file, [&](const std::string& name) {
    const bool linear = holds_linear(file);
    const std::vector<float> values = values_for(picture, linear);
    if (ending_of(file) == ".pfm") {
      write_pfm(name, {picture.width, picture.height, picture.channels, values});
      return;
    }
    // In memory where the format allows: writers of OpenImageIO 2.4 do not notice a full disk
    // (PNG), or end the program (JPEG).
    OIIO::Filesystem::IOVecOutput memory;
    const auto output = OIIO::ImageOutput::create(file);
    if (!output) throw std::runtime_error(OIIO::geterror());
    OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                         static_cast<int>(picture.channels),
                         linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    spec.attribute("CompressionQuality", jpeg.quality);
    spec.attribute("jpeg:subsampling",
                   jpeg.subsampling == freqsynth::Subsampling::both ? "4:2:0" : "4:4:4");
    const bool in_memory = output->supports("ioproxy") && output->set_ioproxy(&memory);
    const bool written =
        output->open(name, spec) && output->write_image(OIIO::TypeDesc::FLOAT, values.data());
    if (!written || !output->close()) {
      const std::string reason = output->geterror();
      throw std::runtime_error(reason.empty() ? "cannot be written" : reason);
    }
    if (in_memory) write_bytes(name, memory.buffer());
  });
}

void check_jpeg_size(const std::string& file, std::size_t width, std::size_t height) {
  constexpr std::size_t most = 65500;
  if (width <= most && height <= most) return;
  throw std::runtime_error(file + ": " + std::to_string(width) + " x " + std::to_string(height) +
                           " pixels; libjpeg writes no side above " + std::to_string(most));
}

void check_picture(const std::string& file, std::size_t width, std::size_t height) {
  const std::string ending = ending_of(file);
  if (ending == ".jpg" || ending == ".jpeg") check_jpeg_size(file, width, height);
  if (ending != ".pfm" && !OIIO::ImageOutput::create(file)) {
    throw std::runtime_error(file + ": " + OIIO::geterror());
  }
  check_writable(file);
}

void write_text(const std::string& file, const std::string& text) {
  write_whole(file, [&](const std::string& name) {
    std::ofstream stream(name);
    stream << text;
    stream.close();
    if (!stream) throw std::runtime_error("cannot be written");
  });
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
