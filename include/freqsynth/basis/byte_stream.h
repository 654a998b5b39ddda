// SPDX-License-Identifier: MIT
/// \file
/// Where saved bytes go to and come from: memory, or functions of the host's, so that the library
/// knows no file and no stream.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// A reference to a callable `void(std::span<const std::byte>)` that takes bytes, some at a time,
/// all of which it has to keep; when it cannot, it throws. Must not outlive it.
class ByteSink {
 public:
  /// Refers to `function`, which must live as long.
  template <class F>
  requires(std::invocable<F&, std::span<const std::byte>> &&
           !std::same_as<std::remove_cvref_t<F>, ByteSink>)
      ByteSink(F&& function)  // NOLINT: hosts pass their lambdas
      : object_(const_cast<void*>(static_cast<const void*>(&function))),
        call_(&call<std::remove_reference_t<F>>) {}

  /// Hands over bytes.
  void operator()(std::span<const std::byte> bytes) const { call_(object_, bytes); }

 private:
  template <class F>
  static void call(void* object, std::span<const std::byte> bytes) {
    (*static_cast<F*>(object))(bytes);
  }

  void* object_;
  void (*call_)(void*, std::span<const std::byte>);
};

/// Bytes in memory, or a reference to a callable `std::size_t(std::span<std::byte>)` that fills in
/// as many as it can and returns how many: 0 when there are no more. Must not outlive either.
class ByteSource {
 public:
  /// Bytes in memory, such as a std::vector of them.
  template <class B>
  requires(std::convertible_to<const B&, std::span<const std::byte>> &&
           !std::same_as<std::remove_cvref_t<B>, ByteSource>)
      ByteSource(const B& bytes)  // NOLINT: as a span
      : memory_(bytes) {}
  /// Refers to `function`, which must live as long.
  template <class F>
  requires(std::invocable<F&, std::span<std::byte>> &&
           !std::convertible_to<const F&, std::span<const std::byte>> &&
           !std::same_as<std::remove_cvref_t<F>, ByteSource>)
      ByteSource(F&& function)  // NOLINT: hosts pass their lambdas
      : object_(const_cast<void*>(static_cast<const void*>(&function))),
        call_(&call<std::remove_reference_t<F>>) {}

  /// Fills in bytes. \return how many; fewer than asked for when there are no more
  std::size_t operator()(std::span<std::byte> bytes) {
    std::size_t count = 0;
    while (count < bytes.size()) {
      const std::size_t more = next(bytes.subspan(count));
      if (more == 0) break;
      count += more;
    }
    return count;
  }

  /// Bytes in memory that are left; 0 for a function, which does not say.
  [[nodiscard]] std::size_t left() const { return memory_.size(); }

 private:
  template <class F>
  static std::size_t call(void* object, std::span<std::byte> bytes) {
    return (*static_cast<F*>(object))(bytes);
  }

  std::size_t next(std::span<std::byte> bytes) {
    if (call_ != nullptr) {
      const std::size_t count = call_(object_, bytes);
      return count < bytes.size() ? count : bytes.size();
    }
    const std::size_t count = memory_.size() < bytes.size() ? memory_.size() : bytes.size();
    if (count > 0) std::memcpy(bytes.data(), memory_.data(), count);
    memory_ = memory_.subspan(count);
    return count;
  }

  std::span<const std::byte> memory_;
  void* object_ = nullptr;
  std::size_t (*call_)(void*, std::span<std::byte>) = nullptr;
};

}  // namespace freqsynth
