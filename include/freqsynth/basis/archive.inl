// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "freqsynth/basis/archive.h"

namespace freqsynth::detail {

/// As the signature of PNG: bytes that no text has, and line ends that text modes change.
inline constexpr std::array<std::uint8_t, 8> archive_magic{0x89, 'F',  'S',  'Y',
                                                           0x0d, 0x0a, 0x1a, 0x0a};

/// table[k][b]: CRC-32C of byte b with k zeros behind it, so that eight bytes are done at once.
using CrcTable = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTable crc_table() {
  constexpr std::uint32_t polynomial = 0x82f63b78u;  // Castagnoli, reflected
  CrcTable table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? polynomial : 0);
    table[0][byte] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = table[k - 1][byte];
      table[k][byte] = (crc >> 8) ^ table[0][crc & 0xff];
    }
  }
  return table;
}

FREQSYNTH_INLINE std::uint32_t crc32c(std::uint32_t before, std::span<const std::byte> bytes) {
  static constexpr CrcTable table = crc_table();
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
  std::uint32_t crc = ~before;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    const std::uint32_t low = crc ^ (at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24);
    crc = table[7][low & 0xff] ^ table[6][low >> 8 & 0xff] ^ table[5][low >> 16 & 0xff] ^
          table[4][low >> 24] ^ table[3][at(4)] ^ table[2][at(5)] ^ table[1][at(6)] ^
          table[0][at(7)];
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) crc = (crc >> 8) ^ table[0][(crc ^ at(i)) & 0xff];
  return ~crc;
}

// ------------------------------------------------------------------------------------- StateWriter

FREQSYNTH_INLINE StateWriter::StateWriter(const ByteSink& sink, const ArchiveKind& kind)
    : sink_(sink), buffer_(buffer_size) {
  array(archive_magic);
  put(std::span<const char>(kind.tag, 4));
  number(kind.version);
  put_check();
}

FREQSYNTH_INLINE void StateWriter::open(const char* tag) {
  const std::uint64_t length = length_;
  put(std::span<const char>(tag, 4));
  number(length);
  put_check();
}

FREQSYNTH_INLINE void StateWriter::flush() {
  const std::span<const std::byte> bytes(buffer_.data(), used_);
  crc_ = crc32c(crc_, bytes);
  used_ = 0;
  if (!bytes.empty()) sink_(bytes);
}

FREQSYNTH_INLINE void StateWriter::put_check() {
  flush();
  std::array<std::byte, sizeof crc_> bytes;
  encode(std::span<const std::uint32_t>(&crc_, 1), bytes.data());
  sink_(bytes);
}

FREQSYNTH_INLINE void StateWriter::finish() {
  section("END ", [] {});
}

// ------------------------------------------------------------------------------------- StateReader

FREQSYNTH_INLINE StateReader::StateReader(const ByteSource& source, const ArchiveKind& kind)
    : source_(source), name_(kind.name), buffer_(buffer_size) {
  const auto same = [](const std::byte* bytes, const auto& wanted, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::to_integer<std::uint8_t>(bytes[i]) != static_cast<std::uint8_t>(wanted[i])) {
        return false;
      }
    }
    return true;
  };
  const std::size_t magic = source_(std::span(buffer_).first(archive_magic.size()));
  if (!same(buffer_.data(), archive_magic, magic)) {
    throw std::runtime_error("freqsynth: this is no " + name_);
  }
  if (magic < archive_magic.size()) refuse_short();
  crc_ = crc32c(0, std::span(buffer_).first(magic));
  const std::byte* rest = read(8);
  std::uint32_t version = 0;
  decode(rest + 4, std::span(&version, 1));
  const bool own = same(rest, kind.tag, 4);
  if (!check_value_fits()) refuse_damaged();
  if (!own) {
    std::string what = "freqsynth: this is no " + name_;
    for (const ArchiveKind& other : {synthesis_kind, image_kind}) {
      if (same(rest, other.tag, 4)) what += std::string(", but a ") + other.name;
    }
    throw std::runtime_error(what);
  }
  if (version != kind.version) {
    refuse("is of format " + std::to_string(version) +
           (version > kind.version ? ", newer than format " : ", older than format ") +
           std::to_string(kind.version) + ", which is read");
  }
}

FREQSYNTH_INLINE void StateReader::refuse(const std::string& what) const {
  throw std::runtime_error("freqsynth: " + name_ + " " + what);
}

FREQSYNTH_INLINE void StateReader::refuse_damaged() const {
  refuse("is damaged in " + (section_.empty() ? "its header" : "section " + section_) +
         ": a check value is wrong");
}

FREQSYNTH_INLINE void StateReader::refuse_short() const {
  refuse("ends too early, in " + (section_.empty() ? "its header" : "section " + section_));
}

FREQSYNTH_INLINE const std::byte* StateReader::read(std::size_t count) {
  const std::span<std::byte> bytes = std::span(buffer_).first(count);
  if (source_(bytes) != count) refuse_short();
  crc_ = crc32c(crc_, bytes);
  return buffer_.data();
}

FREQSYNTH_INLINE bool StateReader::check_value_fits() {
  std::array<std::byte, sizeof crc_> bytes;
  if (source_(bytes) != bytes.size()) refuse_short();
  std::uint32_t wanted = 0;
  decode(bytes.data(), std::span(&wanted, 1));
  return wanted == crc_;
}

FREQSYNTH_INLINE void StateReader::open(const char* tag) {
  section_.assign(tag, 4);
  while (section_.back() == ' ') section_.pop_back();
  used_ = filled_ = 0;
  const std::byte* header = read(12);
  decode(header + 4, std::span(&remaining_, 1));
  const bool own = std::memcmp(header, tag, 4) == 0;
  if (!check_value_fits()) refuse_damaged();
  if (!own) refuse("has another section where " + section_ + " belongs");
}

FREQSYNTH_INLINE void StateReader::close() {
  if (remaining() != 0) fail_section("is too long");
  if (!check_value_fits()) refuse_damaged();
}

FREQSYNTH_INLINE void StateReader::fill(std::size_t least) {
  const std::size_t kept = filled_ - used_;
  if (kept + remaining_ < least) fail_section("is too short");
  if (kept > 0) std::memmove(buffer_.data(), buffer_.data() + used_, kept);
  used_ = 0;
  filled_ = kept;
  const std::size_t room = buffer_size - kept;
  const auto more = static_cast<std::size_t>(remaining_ < room ? remaining_ : room);
  const std::span<std::byte> bytes = std::span(buffer_).subspan(kept, more);
  if (source_(bytes) != more) refuse_short();
  crc_ = crc32c(crc_, bytes);
  filled_ += more;
  remaining_ -= more;
}

/// What is wrong may be no more than a consequence: the whole section is looked at first.
FREQSYNTH_INLINE void StateReader::fail(const std::string& what) {
  used_ = filled_ = 0;
  while (remaining_ > 0) {
    fill(1);
    used_ = filled_;
  }
  if (!check_value_fits()) refuse_damaged();
  refuse(what);
}

FREQSYNTH_INLINE void StateReader::count(std::size_t& count) {
  std::uint64_t wide = 0;
  number(wide);
  check(wide <= std::numeric_limits<std::size_t>::max());
  count = static_cast<std::size_t>(wide);
}

FREQSYNTH_INLINE void StateReader::finish() {
  section("END ", [] {});
  if (source_.left() > 0) refuse("goes on after its end");
}

}  // namespace freqsynth::detail
