// SPDX-License-Identifier: MIT
/// \file
/// Requests and values as bytes: those that a sampler needs, and no more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "freqsynth/sampler.h"

namespace farm {

/// What a sampler wants to know of a request beside its position.
struct Fields {
  bool ordinal = false;  ///< 4 bytes; the pixel follows from the position and costs none
  bool seed = false;     ///< 8 bytes
  bool id = false;       ///< 8 bytes
  bool spacing = false;  ///< 4 bytes
};

/// The form of the packets of a picture.
struct PacketFormat {
  std::size_t width = 0;   ///< pixels of the picture
  std::size_t height = 0;  ///< pixels
  std::size_t channels = 3;
  Fields fields = {};

  /// Bytes of a request.
  [[nodiscard]] std::size_t request_bytes() const;
  /// Bytes of its values.
  [[nodiscard]] std::size_t value_bytes() const { return channels * sizeof(float); }
  /// Requests at the end of a letter.
  void encode(std::span<const freqsynth::Request> requests, std::vector<std::byte>& bytes) const;
  /// The requests that a letter consists of. What is not sent is 0.
  void decode(std::span<const std::byte> bytes, std::vector<freqsynth::Request>& requests) const;
};

/// What an answer begins with. Behind it come the values, or an error as text.
struct AnswerHeader {
  static constexpr std::uint64_t failure = ~std::uint64_t{0};

  std::uint64_t count;  ///< samples, or `failure`
  double seconds;       ///< that it took to trace them
};

/// An answer that tells an error, and its text behind the header.
void put_error(std::vector<std::byte>& answer, std::string_view text);
[[nodiscard]] std::string text_of(std::span<const std::byte> bytes);

}  // namespace farm
