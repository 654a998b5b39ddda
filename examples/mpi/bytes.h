// SPDX-License-Identifier: MIT
/// \file
/// Numbers in letters. All ranks are machines of one kind.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace farm {

/// A number, or a structure of them, at the end of a letter.
template <class T>
requires std::is_trivially_copyable_v<T>
void put(std::vector<std::byte>& bytes, const T& value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof(T));
}

/// The one that a letter begins with, which it loses.
template <class T>
requires std::is_trivially_copyable_v<T> T take(std::span<const std::byte>& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes = bytes.subspan(sizeof(T));
  return value;
}

}  // namespace farm
