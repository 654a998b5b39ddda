// SPDX-License-Identifier: MIT
/// \file
/// What a sampler may return: a number, a std::array of numbers or another type with a size and an
/// index, a struct of nothing but floats or nothing but doubles, or whatever a host describes by a
/// SampleTraits.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Specialise it for a type of your own, so that samplers may return it:
///
///     template <>
///     struct freqsynth::SampleTraits<Colour> {
///       static constexpr std::size_t channels = 3;
///       static float value(const Colour& colour, std::size_t channel) { return colour.at(channel);
///       }
///     };
template <class T>
struct SampleTraits {};

namespace detail {

/// Whether a host has said what is in a T, right or wrong.
template <class T>
concept HasSampleTraits = requires {
  SampleTraits<T>::channels;
}
|| requires { &SampleTraits<T>::value; };

/// Whether it is right.
template <class T>
concept DescribedSample = requires(const T& sample, std::size_t channel) {
  requires std::bool_constant<(SampleTraits<T>::channels > 0)>::value;
  static_cast<float>(SampleTraits<T>::value(sample, channel));
};

/// A std::array of numbers, or what looks like one: std::tuple_size and [].
template <class T>
concept IndexedSample = requires(const T& sample, std::size_t channel) {
  requires std::bool_constant<(std::tuple_size<T>::value > 0)>::value;
  requires std::is_arithmetic_v<std::remove_cvref_t<decltype(sample[channel])>>;
};

/// Becomes a number of one type and no other.
template <class Number>
struct Only {
  template <class T>
  requires std::same_as<T, Number>
  operator T() const;
};

template <class T, class Number, std::size_t... I>
constexpr bool takes_numbers(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), Only<Number>{})...}; };
}

/// Whether a struct holds as many numbers of that type as fit into it, and nothing else.
template <class T, class Number>
constexpr bool consists_of() {
  if constexpr (std::is_class_v<T> && std::is_aggregate_v<T> && std::is_trivially_copyable_v<T>) {
    constexpr std::size_t count = sizeof(T) / sizeof(Number);
    if constexpr (sizeof(T) == count * sizeof(Number) && count <= 64 && !std::is_empty_v<T>) {
      return takes_numbers<T, Number>(std::make_index_sequence<count>());
    }
  }
  return false;
}

template <class T>
concept PlainSample = consists_of<T, float>() || consists_of<T, double>();

/// How the numbers of a T are read. One that is described is read as it is described.
template <class T>
struct SampleAccess {
  static constexpr bool valid = false;
};

template <DescribedSample T>
struct SampleAccess<T> {
  static constexpr bool valid = true;
  static constexpr std::size_t channels = SampleTraits<T>::channels;
  static void store(const T& sample, float* out) {
    for (std::size_t c = 0; c < channels; ++c) {
      out[c] = static_cast<float>(SampleTraits<T>::value(sample, c));
    }
  }
};

template <class T>
requires(std::is_arithmetic_v<T> && !HasSampleTraits<T>) struct SampleAccess<T> {
  static constexpr bool valid = true;
  static constexpr std::size_t channels = 1;
  static void store(const T& sample, float* out) { *out = static_cast<float>(sample); }
};

template <class T>
requires(IndexedSample<T> && !HasSampleTraits<T>) struct SampleAccess<T> {
  static constexpr bool valid = true;
  static constexpr std::size_t channels = std::tuple_size<T>::value;
  static void store(const T& sample, float* out) {
    for (std::size_t c = 0; c < channels; ++c) out[c] = static_cast<float>(sample[c]);
  }
};

template <class T>
requires(PlainSample<T> && !IndexedSample<T> && !HasSampleTraits<T>) struct SampleAccess<T> {
  using Number = std::conditional_t<consists_of<T, float>(), float, double>;
  static constexpr bool valid = true;
  static constexpr std::size_t channels = sizeof(T) / sizeof(Number);
  static void store(const T& sample, float* out) {
    const auto numbers = std::bit_cast<std::array<Number, channels>>(sample);
    for (std::size_t c = 0; c < channels; ++c) out[c] = static_cast<float>(numbers[c]);
  }
};

/// That of what a function returns.
template <class F, class... Arguments>
using SampleAccessOf = SampleAccess<std::remove_cvref_t<std::invoke_result_t<F&, Arguments...>>>;

}  // namespace detail
}  // namespace freqsynth
