// SPDX-License-Identifier: MIT
#include "packet.h"

#include <algorithm>

#include "bytes.h"

namespace farm {

std::size_t PacketFormat::request_bytes() const {
  return 2 * sizeof(double) + (fields.ordinal ? sizeof(std::uint32_t) : 0) +
         (fields.seed ? sizeof(std::uint64_t) : 0) + (fields.id ? sizeof(std::uint64_t) : 0) +
         (fields.spacing ? sizeof(float) : 0);
}

void PacketFormat::encode(std::span<const freqsynth::Request> requests,
                          std::vector<std::byte>& bytes) const {
  bytes.reserve(bytes.size() + requests.size() * request_bytes());
  for (const freqsynth::Request& request : requests) {
    put(bytes, request.x);
    put(bytes, request.y);
    if (fields.ordinal) put(bytes, request.ordinal);
    if (fields.seed) put(bytes, request.seed);
    if (fields.id) put(bytes, request.id);
    if (fields.spacing) put(bytes, request.spacing);
  }
}

void PacketFormat::decode(std::span<const std::byte> bytes,
                          std::vector<freqsynth::Request>& requests) const {
  requests.assign(bytes.size() / request_bytes(), {});
  for (freqsynth::Request& request : requests) {
    request.x = take<double>(bytes);
    request.y = take<double>(bytes);
    if (fields.ordinal) {
      request.ordinal = take<std::uint32_t>(bytes);
      // The right and the bottom border belong to the last pixels.
      const auto x = std::min(static_cast<std::size_t>(request.x), width - 1);
      const auto y = std::min(static_cast<std::size_t>(request.y), height - 1);
      request.pixel = std::uint64_t{y} * width + x;
    }
    if (fields.seed) request.seed = take<std::uint64_t>(bytes);
    if (fields.id) request.id = take<std::uint64_t>(bytes);
    if (fields.spacing) request.spacing = take<float>(bytes);
  }
}

void put_error(std::vector<std::byte>& answer, std::string_view text) {
  put(answer, AnswerHeader{AnswerHeader::failure, 0});
  const auto bytes = std::as_bytes(std::span(text));
  answer.insert(answer.end(), bytes.begin(), bytes.end());
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace farm
