// SPDX-License-Identifier: MIT
/// \file
/// What the fuzzing targets share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/archive.h"

namespace fuzz {

/// Bytes of an archive with check values that fit, as far as the lengths of its sections make
/// sense: else no change would get beyond them.
inline std::vector<std::byte> with_right_checks(std::span<const std::byte> from) {
  std::vector<std::byte> bytes(from.begin(), from.end());
  std::uint32_t crc = 0;
  std::size_t at = 0;
  const auto part = [&](std::uint64_t length) {
    if (length > bytes.size() - at || bytes.size() - at - length < 4) return false;
    const auto size = static_cast<std::size_t>(length);
    crc = freqsynth::detail::crc32c(crc, std::span(bytes).subspan(at, size));
    freqsynth::detail::encode(std::span<const std::uint32_t>(&crc, 1), bytes.data() + at + size);
    at += size + 4;
    return true;
  };
  bool more = part(16);
  while (more && at < bytes.size()) {
    const std::size_t header = at;
    more = part(12);
    std::uint64_t length = 0;
    if (more) freqsynth::detail::decode(bytes.data() + header + 4, std::span(&length, 1));
    more = more && part(length);
  }
  return bytes;
}

/// An archive of the input's bytes but the first one, which tells in its highest bit whether the
/// check values are to fit.
inline std::vector<std::byte> archive_of(std::span<const std::uint8_t> input) {
  const auto bytes = std::as_bytes(input.subspan(1));
  if ((input[0] & 0x80u) != 0) return with_right_checks(bytes);
  return {bytes.begin(), bytes.end()};
}

/// Fails unless a condition holds.
inline void require(bool good) {
  if (!good) __builtin_trap();
}

}  // namespace fuzz
