// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/jpeg_file.h"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace freqsynth {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* action, const fs::path& file, const std::error_code& reason) {
  throw std::runtime_error("freqsynth: cannot " + std::string(action) + " " + file.string() + ": " +
                           reason.message());
}

/// The reason of a failed call of the C library.
std::error_code last_error() { return {errno != 0 ? errno : EIO, std::generic_category()}; }

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

enum class Mode { read, write, update };

/// Opens a file, as std::fopen() does, for bytes. Names are wide on Windows.
File open(const fs::path& file, Mode mode) {
  errno = 0;
#if defined(_WIN32)
  constexpr std::array modes{L"rb", L"wb", L"r+b"};
  return File{_wfopen(file.c_str(), modes[static_cast<std::size_t>(mode)])};
#else
  constexpr std::array modes{"rb", "wb", "r+b"};
  return File{std::fopen(file.c_str(), modes[static_cast<std::size_t>(mode)])};
#endif
}

/// Makes a file that must not exist yet, and opens it.
File create(const fs::path& file) {
  errno = 0;
#if defined(_WIN32)
  // The C library of Windows does not know the mode x.
  const int made =
      _wopen(file.c_str(), _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY, _S_IREAD | _S_IWRITE);
  return File{made < 0 ? nullptr : _fdopen(made, "wb")};
#else
  return File{std::fopen(file.c_str(), "wbx")};
#endif
}

/// Writes all bytes and closes the file, which may be what fails.
std::error_code write_and_close(File file, std::span<const std::uint8_t> bytes) {
  errno = 0;
  std::error_code error;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) error = last_error();
  if (std::fclose(file.release()) != 0 && !error) error = last_error();
  return error;
}

/// Creates a file that did not exist, beside `file`.
File create_beside(const fs::path& file, fs::path& created) {
  std::random_device random;
  for (int attempt = 0; attempt < 100; ++attempt) {
    created = file.parent_path() / (".freqsynth-" + std::to_string(random()) + ".tmp");
    if (File made = create(created)) return made;
    if (errno != EEXIST) break;
  }
  fail("write", file, last_error());
}

/// All of the new content or, on failure, all of the old.
void replace(const fs::path& file, bool exists, std::span<const std::uint8_t> bytes) {
  // A file that may not be written must not be replaced either.
  if (exists && !open(file, Mode::update)) fail("write", file, last_error());
  fs::path temporary;
  std::error_code error = write_and_close(create_beside(file, temporary), bytes);
  if (!error && exists) {
    std::error_code ignored;
    fs::permissions(temporary, fs::status(file).permissions(), ignored);
  }
  if (!error) fs::rename(temporary, file, error);
  if (error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail("write", file, error);
  }
}

/// The bytes of a file: all of them, one more than `most`, or the first few of what is no JPEG, for
/// a device may have no end.
std::vector<std::uint8_t> read_all(const std::string& file, std::uint64_t most) {
  const File input = open(file, Mode::read);
  if (!input) fail("read", file, last_error());
  constexpr std::array<std::uint8_t, 2> start{0xff, 0xd8};
  std::vector<std::uint8_t> bytes;
  std::size_t used = 0;
  while (used == bytes.size() && used <= most) {
    const std::uint64_t room = used + used / 2 + (1 << 16);
    bytes.resize(static_cast<std::size_t>(room > most ? most + 1 : room));
    used += std::fread(bytes.data() + used, 1, bytes.size() - used, input.get());
    if (used < start.size() || !std::equal(start.begin(), start.end(), bytes.begin())) break;
  }
  if (std::ferror(input.get()) != 0) fail("read", file, last_error());
  bytes.resize(used);
  return bytes;
}

}  // namespace

void write_jpeg(const std::string& file, const QuantizedImage& image, const JpegOptions& options) {
  const std::vector<std::uint8_t> bytes = encode_jpeg(image, options);
  std::error_code error;
  fs::path target = file;
  const fs::file_status own = fs::symlink_status(target, error);
  if (own.type() == fs::file_type::not_found) return replace(target, false, bytes);
  // A link stays, what it names is replaced.
  if (own.type() == fs::file_type::symlink) {
    const fs::path named = fs::canonical(target, error);
    if (!error) target = named;
  }
  if (fs::is_regular_file(target, error)) return replace(target, true, bytes);
  File device = open(target, Mode::write);
  if (!device) fail("write", file, last_error());
  error = write_and_close(std::move(device), bytes);
  if (error) fail("write", file, error);
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
    throw std::runtime_error("freqsynth: cannot read " + file + ": " + reason);
  }
}

}  // namespace freqsynth
