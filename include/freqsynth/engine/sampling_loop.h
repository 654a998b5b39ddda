// SPDX-License-Identifier: MIT
/// \file
/// The loop that takes requests from an engine and lets a sampler answer them: what
/// Synthesizer::run() does once it no longer needs to know the types of sampler, executor and
/// callback.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/stop_rule.h"
#include "freqsynth/sampler.h"

namespace freqsynth::detail {

/// What a reference can be taken of: a function's pointer, and anything else itself.
template <class T>
constexpr decltype(auto) as_object(T& callable) {
  if constexpr (std::is_function_v<T>) {
    return &callable;
  } else {
    return (callable);
  }
}

/// A reference to a sampler; must not outlive it.
class SamplerRef {
 public:
  /// \param channels  of the image
  template <class S>
  SamplerRef(S& sampler, std::size_t channels)
      : sampler_(const_cast<void*>(static_cast<const void*>(&sampler))),
        call_(&call<S>),
        channels_(sampler_channels<S>(channels)),
        stride_(sampler_stride(sampler)) {}

  /// See call_sampler().
  void operator()(std::span<const Request> requests, std::span<float> values,
                  std::size_t& done) const {
    call_(sampler_, requests, values, done);
  }
  /// Values per sample.
  [[nodiscard]] std::size_t channels() const { return channels_; }
  /// See sampler_stride().
  [[nodiscard]] std::size_t stride() const { return stride_; }

 private:
  template <class S>
  static void call(void* sampler, std::span<const Request> requests, std::span<float> values,
                   std::size_t& done) {
    call_sampler(*static_cast<S*>(sampler), requests, values, done);
  }

  void* sampler_;
  void (*call_)(void*, std::span<const Request>, std::span<float>, std::size_t&);
  std::size_t channels_, stride_;
};

}  // namespace freqsynth::detail

namespace freqsynth {

/// A progress callback that never cancels.
struct KeepGoing {
  /// Go on.
  bool operator()(double) const { return true; }
};

/// A function of the Progress, or of its fraction alone, that returns whether to go on.
template <class P>
concept ProgressCallback =
    std::is_invocable_r_v<bool, P&, double> || std::is_invocable_r_v<bool, P&, const Progress&>;

namespace detail {

/// A reference to a progress callback.
class ProgressRef {
 public:
  template <ProgressCallback P>
  explicit ProgressRef(P& progress)
      : progress_(const_cast<void*>(static_cast<const void*>(&progress))),
        call_([](void* object, const Progress& now) -> bool {
          // One that would take anything takes the fraction.
          if constexpr (std::is_invocable_r_v<bool, P&, double>) {
            return (*static_cast<P*>(object))(now.fraction);
          } else {
            return (*static_cast<P*>(object))(now);
          }
        }),
        listens_(!std::is_same_v<P, const KeepGoing> && !std::is_same_v<P, KeepGoing>) {}

  /// Whether it makes a difference to call it.
  [[nodiscard]] bool listens() const { return listens_; }
  /// Whether to go on.
  bool operator()(const Progress& now) const { return call_(progress_, now); }

 private:
  void* progress_;
  bool (*call_)(void*, const Progress&);
  bool listens_;
};

}  // namespace detail
}  // namespace freqsynth
