// SPDX-License-Identifier: MIT
/// \file
/// Files that are replaced as a whole, and faults that name the file. Not installed: for the
/// sources of the compiled libraries alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>

#include "freqsynth/basis/byte_stream.h"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#else
#include <fcntl.h>
#include <unistd.h>
#endif

#include <array>
#include <cerrno>
#include <random>
#include <utility>

namespace freqsynth::detail {

/// \throws std::runtime_error "freqsynth: cannot <action> <file>: <reason>", always.
[[noreturn]] inline void fail_file(const char* action, const std::filesystem::path& file,
                                   const std::string& reason) {
  throw std::runtime_error("freqsynth: cannot " + std::string(action) + " " + file.string() + ": " +
                           reason);
}

/// The reason of a failed call of the C library.
inline std::error_code last_file_error() {
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

enum class FileMode { read, write, update };

/// Opens a file, as std::fopen() does, for bytes. Names are wide on Windows.
inline FileHandle open_file(const std::filesystem::path& file, FileMode mode) {
  errno = 0;
#if defined(_WIN32)
  constexpr std::array modes{L"rb", L"wb", L"r+b"};
  return FileHandle{_wfopen(file.c_str(), modes[static_cast<std::size_t>(mode)])};
#else
  constexpr std::array modes{"rb", "wb", "r+b"};
  return FileHandle{std::fopen(file.c_str(), modes[static_cast<std::size_t>(mode)])};
#endif
}

/// Makes a file that must not exist yet, and opens it.
inline FileHandle create_file(const std::filesystem::path& file) {
  errno = 0;
#if defined(_WIN32)
  // The C library of Windows does not know the mode x.
  const int made =
      _wopen(file.c_str(), _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY, _S_IREAD | _S_IWRITE);
  return FileHandle{made < 0 ? nullptr : _fdopen(made, "wb")};
#else
  return FileHandle{std::fopen(file.c_str(), "wbx")};
#endif
}

/// Creates a file that did not exist, beside `file`.
inline FileHandle create_file_beside(const std::filesystem::path& file,
                                     std::filesystem::path& created) {
  std::random_device random;
  for (int attempt = 0; attempt < 100; ++attempt) {
    created = file.parent_path() / (".freqsynth-" + std::to_string(random()) + ".tmp");
    if (FileHandle made = create_file(created)) return made;
    if (errno != EEXIST) break;
  }
  fail_file("write", file, last_file_error().message());
}

/// Whether all that was written is on the disk: a crash of the system loses none of it.
inline bool flush_to_disk(std::FILE* file) {
  if (std::fflush(file) != 0) return false;
#if defined(_WIN32)
  return _commit(_fileno(file)) == 0;
#else
  // Some file systems cannot; that is no fault of the file.
  return ::fsync(fileno(file)) == 0 || errno == EINVAL || errno == ENOTSUP;
#endif
}

/// Writes what write(sink) hands over and closes the file, which may be what fails.
/// \param durable  flush_to_disk(), too
/// \throws std::runtime_error naming `name`, and what `write` throws.
template <class Write>
void write_and_close(FileHandle file, const std::filesystem::path& name, Write&& write,
                     bool durable) {
  const auto require = [&](bool good) {
    if (!good) fail_file("write", name, last_file_error().message());
  };
  const auto put = [&](std::span<const std::byte> bytes) {
    errno = 0;
    require(std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size());
  };
  write(ByteSink(put));
  errno = 0;
  require(!durable || flush_to_disk(file.get()));
  require(std::fclose(file.release()) == 0);
}

/// All of the new content or, on failure, all of the old.
template <class Write>
void replace_file(const std::filesystem::path& file, bool exists, Write&& write, bool durable) {
  namespace fs = std::filesystem;
  // A file that may not be written must not be replaced either.
  if (exists && !open_file(file, FileMode::update)) {
    fail_file("write", file, last_file_error().message());
  }
  fs::path temporary;
  FileHandle made = create_file_beside(file, temporary);
  std::error_code error;
  try {
    write_and_close(std::move(made), file, write, durable);
    std::error_code ignored;
    if (exists) fs::permissions(temporary, fs::status(file).permissions(), ignored);
    fs::rename(temporary, file, error);
    if (error) fail_file("write", file, error.message());
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

/// Writes what write(sink) hands over into a file. One of that name is replaced when all is
/// written, and keeps its content until then and on any failure; devices and pipes are written
/// directly.
/// \param durable  a crash of the system leaves either file, too
template <class Write>
void write_file(const std::string& file, Write&& write, bool durable) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path target = file;
  const fs::file_status own = fs::symlink_status(target, error);
  if (own.type() == fs::file_type::not_found) return replace_file(target, false, write, durable);
  // A link stays, what it names is replaced.
  if (own.type() == fs::file_type::symlink) {
    const fs::path named = fs::canonical(target, error);
    if (!error) target = named;
  }
  if (fs::is_regular_file(target, error)) return replace_file(target, true, write, durable);
  FileHandle device = open_file(target, FileMode::write);
  if (!device) fail_file("write", file, last_file_error().message());
  write_and_close(std::move(device), file, write, false);
}

/// Calls read(source), whose std::runtime_error "freqsynth: <reason>" then names the file.
template <class Read>
auto read_file(const std::string& file, Read&& read) {
  const FileHandle input = open_file(file, FileMode::read);
  if (!input) fail_file("read", file, last_file_error().message());
  const auto get = [&](std::span<std::byte> bytes) {
    errno = 0;
    const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), input.get());
    if (std::ferror(input.get()) != 0) {
      throw std::runtime_error("freqsynth: " + last_file_error().message());
    }
    return count;
  };
  try {
    return read(ByteSource(get));
  } catch (const std::runtime_error& error) {
    const std::string what = error.what(), start = "freqsynth: ";
    fail_file("read", file, what.starts_with(start) ? what.substr(start.size()) : what);
  }
}

}  // namespace freqsynth::detail
