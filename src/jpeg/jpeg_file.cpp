// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/jpeg_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "basis/file_access.h"
#include "freqsynth/basis/byte_stream.h"

namespace freqsynth {
namespace {

/// The bytes of a file: all of them, one more than `most`, or the first few of what is no JPEG, for
/// a device may have no end.
std::vector<std::uint8_t> read_all(const std::string& file, std::uint64_t most) {
  const detail::FileHandle input = detail::open_file(file, detail::FileMode::read);
  if (!input) detail::fail_file("read", file, detail::last_file_error().message());
  constexpr std::array<std::uint8_t, 2> start{0xff, 0xd8};
  std::vector<std::uint8_t> bytes;
  std::size_t used = 0;
  while (used == bytes.size() && used <= most) {
    const std::uint64_t room = used + used / 2 + (1 << 16);
    bytes.resize(static_cast<std::size_t>(room > most ? most + 1 : room));
    used += std::fread(bytes.data() + used, 1, bytes.size() - used, input.get());
    if (used < start.size() || !std::equal(start.begin(), start.end(), bytes.begin())) break;
  }
  if (std::ferror(input.get()) != 0) {
    detail::fail_file("read", file, detail::last_file_error().message());
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

void write_jpeg(const std::string& file, const QuantizedImage& image, const JpegOptions& options) {
  const std::vector<std::uint8_t> bytes = encode_jpeg(image, options);
  detail::write_file(
      file, [&](ByteSink sink) { sink(std::as_bytes(std::span(bytes))); }, false);
}

void write_jpeg(std::ostream& stream, const QuantizedImage& image, const JpegOptions& options) {
  const std::vector<std::uint8_t> bytes = encode_jpeg(image, options);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.flush();
  if (!stream) throw std::runtime_error("freqsynth: write_jpeg: the stream failed");
}

QuantizedImage read_jpeg(const std::string& file, const JpegLimits& limits) {
  const std::vector<std::uint8_t> bytes = read_all(file, limits.bytes);
  try {
    return decode_jpeg(bytes, limits);
  } catch (const std::runtime_error& error) {
    const std::string reason = std::string(error.what()).substr(std::string("freqsynth: ").size());
    detail::fail_file("read", file, reason);
  }
}

}  // namespace freqsynth
