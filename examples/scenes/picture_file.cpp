// SPDX-License-Identifier: MIT
#include "picture_file.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace scenes {
namespace {

/// Of one picture: 16384 x 16384. More is rather a damaged header than a picture.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

[[noreturn]] void fail(const std::string& file, const std::string& reason) {
  throw std::runtime_error(file + ": " + reason);
}

[[noreturn]] void fail_reading(const std::string& file, std::string reason) {
  while (!reason.empty() && reason.back() == '\n') reason.pop_back();
  fail(file, reason.empty() ? "cannot be read, or is cut short" : reason);
}

/// A device may have no end, and a pipe cannot be read twice.
void check_regular(const std::string& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(file, "not a regular file");
  }
}

std::string size_of(const OIIO::ImageSpec& spec) {
  return std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels";
}

void check_size(const std::string& file, const OIIO::ImageSpec& spec) {
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) {
    fail(file, "says that it has no pixels");
  }
  const auto width = static_cast<std::uint64_t>(spec.width);
  if (width * static_cast<std::uint64_t>(spec.height) > kMostPixels) {
    fail(file, "says that it has " + size_of(spec) + ", more than " + std::to_string(kMostPixels) +
                   "; damaged?");
  }
  if (spec.depth > 1 || spec.deep) fail(file, "is no flat picture");
}

bool is_encoded(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (OIIO::Strutil::iequals(space, "sRGB")) return true;
  const bool linear = OIIO::Strutil::iequals(space, "linear") || space == "scene_linear";
  return !spec.format.is_floating_point() && !linear;
}

/// The next marker of a JPEG file: a byte other than 0 and 0xff after 0xff. Negative: none.
int next_marker(std::istream& stream) {
  int byte = stream.get();
  while (stream) {
    while (stream && byte != 0xff) byte = stream.get();
    while (byte == 0xff) byte = stream.get();
    if (stream && byte != 0) return byte;
  }
  return -1;
}

/// Whether a JPEG file has its end. OpenImageIO reads one that is cut without a word and fills it
/// up with gray. A small picture within the file is passed over, and so is what follows the end.
bool jpeg_has_end(std::istream& stream) {
  constexpr int start_of_image = 0xd8, end_of_image = 0xd9, first_restart = 0xd0, temporary = 0x01;
  for (int marker = next_marker(stream); marker >= 0; marker = next_marker(stream)) {
    if (marker == end_of_image) return true;
    if (marker == temporary || (marker >= first_restart && marker <= start_of_image)) continue;
    const int length = stream.get() << 8;
    stream.ignore((length | stream.get()) - 2);  // coded data has no such markers
  }
  return false;
}

/// What OpenImageIO does not notice.
void check_not_cut(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 8> start{};
  stream.read(start.data(), start.size());
  const auto byte = [&](std::size_t i) {
    return std::uint64_t{static_cast<unsigned char>(start[i])};
  };
  bool cut = false;
  if (byte(0) == 0xff && byte(1) == 0xd8) {
    stream.clear();
    stream.seekg(0);
    cut = !jpeg_has_end(stream);
  } else if (std::string(start.data(), 4) == "FOR4") {  // IFF: the size of all that follows
    const std::uint64_t size = byte(4) << 24 | byte(5) << 16 | byte(6) << 8 | byte(7);
    cut = std::filesystem::file_size(file) < size + start.size();
  }
  if (cut) fail(file, "is cut short");
}

/// The picture as it is to be looked at, where the file says that it lies on its side.
PictureFile upright(const std::string& file, const OIIO::ImageSpec& spec, PictureFile stored) {
  if (spec.get_int_attribute("Orientation", 1) == 1) return stored;
  OIIO::ImageSpec wrapped(static_cast<int>(stored.width), static_cast<int>(stored.height),
                          static_cast<int>(stored.channels), OIIO::TypeDesc::FLOAT);
  wrapped.attribute("Orientation", spec.get_int_attribute("Orientation", 1));
  const OIIO::ImageBuf turned =
      OIIO::ImageBufAlgo::reorient(OIIO::ImageBuf(wrapped, stored.values.get()));
  const OIIO::ROI roi = turned.roi();
  PictureFile picture{static_cast<std::size_t>(roi.width()), static_cast<std::size_t>(roi.height()),
                      stored.channels, stored.encoded,
                      std::make_unique_for_overwrite<float[]>(stored.size())};
  if (picture.size() != stored.size() ||
      !turned.get_pixels(roi, OIIO::TypeDesc::FLOAT, picture.values.get())) {
    fail_reading(file, turned.geterror());
  }
  return picture;
}

}  // namespace

PictureFile read_picture_file(const std::string& file) {
  check_regular(file);
  // Without this hint the colours would be multiplied by the alpha that is to be ignored.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(file, &hints);
  if (!input) fail_reading(file, OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  check_size(file, spec);
  check_not_cut(file);
  try {
    PictureFile picture{static_cast<std::size_t>(spec.width),
                        static_cast<std::size_t>(spec.height),
                        spec.nchannels >= 3 ? std::size_t{3} : std::size_t{1},
                        is_encoded(spec),
                        {}};
    // Not filled with zeros: of a file without pixels no page is touched.
    picture.values = std::make_unique_for_overwrite<float[]>(picture.size());
    if (!input->read_image(0, 0, 0, static_cast<int>(picture.channels), OIIO::TypeDesc::FLOAT,
                           picture.values.get())) {
      fail_reading(file, input->geterror());
    }
    return upright(file, spec, std::move(picture));
  } catch (const std::bad_alloc&) {
    fail(file, size_of(spec) + " do not fit in memory");
  }
}

}  // namespace scenes
