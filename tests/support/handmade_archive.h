// SPDX-License-Identifier: MIT
// Saved bytes made by hand, byte by byte, as basis/archive.h describes them: with check values that
// are right, whatever the content is.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace freqsynth::testing_support {

using Bytes = std::vector<std::byte>;

/// CRC-32C, a bit at a time.
inline std::uint32_t slow_crc32c(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0x82f63b78u : 0u);
  }
  return ~crc;
}

class HandmadeArchive {
 public:
  explicit HandmadeArchive(const std::string& kind, std::uint32_t version = 1) {
    for (const int byte : {0x89, 0x46, 0x53, 0x59, 0x0d, 0x0a, 0x1a, 0x0a}) u8(byte);
    text(kind);
    u32(version);
    check_value();
  }

  HandmadeArchive& u8(int value) {
    section_.push_back(static_cast<std::byte>(value));
    return *this;
  }
  HandmadeArchive& u32(std::uint32_t value) {
    for (int i = 0; i < 4; ++i) u8(static_cast<int>(value >> (8 * i) & 0xffu));
    return *this;
  }
  HandmadeArchive& u64(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) u8(static_cast<int>(value >> (8 * i) & 0xffu));
    return *this;
  }
  HandmadeArchive& f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
  HandmadeArchive& text(const std::string& letters) {
    for (const char letter : letters) u8(letter);
    return *this;
  }
  HandmadeArchive& raw(std::span<const std::byte> bytes) {
    section_.insert(section_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  /// Ends a section, which is what was written since the last one.
  HandmadeArchive& section(const std::string& tag) { return section(tag, section_.size()); }
  /// The same with a length of one's choice.
  HandmadeArchive& section(const std::string& tag, std::uint64_t length) {
    const Bytes content = std::move(section_);
    section_.clear();
    text(tag);
    u64(length);
    check_value();
    raw(content);
    check_value();
    return *this;
  }
  [[nodiscard]] const Bytes& bytes() const { return all_; }

 private:
  void check_value() {
    checked_.insert(checked_.end(), section_.begin(), section_.end());
    u32(slow_crc32c(checked_));
    all_.insert(all_.end(), section_.begin(), section_.end());
    section_.clear();
  }

  Bytes section_, checked_, all_;
};

/// Bytes whose sections are the same but whose check values are right again, as far as the lengths
/// of its sections make sense.
inline Bytes with_right_checks(Bytes bytes) {
  Bytes checked;
  std::size_t at = 0;
  const auto part = [&](std::size_t length) {
    if (length > bytes.size() - at || bytes.size() - at - length < 4) return false;
    checked.insert(checked.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                   bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
    at += length;
    const std::uint32_t crc = slow_crc32c(checked);
    for (std::size_t i = 0; i < 4; ++i)
      bytes[at++] = static_cast<std::byte>(crc >> (8 * i) & 0xffu);
    return true;
  };
  if (!part(16)) return bytes;
  while (at < bytes.size()) {
    if (!part(12)) return bytes;
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      length |= std::to_integer<std::uint64_t>(bytes[at - 12 + i]) << (8 * i);
    }
    if (length > bytes.size() || !part(static_cast<std::size_t>(length))) return bytes;
  }
  return bytes;
}

}  // namespace freqsynth::testing_support
