/// \file
/// What the library asks of a host, and in which form: requests and the sampler concepts.
///
/// A host's radiance function comes in one of two forms:
///  - scalar: `f(x, y)` returns a float (or double) for one channel, or a std::array of them;
///  - batch: `f(std::span<const Request>, std::span<float>)` writes `channels` values per request,
///    those of request i at [i * channels, (i + 1) * channels).
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace freqsynth {

/// One position the engine wants a value for.
struct Request {
  double x = 0;  ///< continuous pixels to the right, in [0, width]; pixel i is centred at i + 0.5
  double y = 0;  ///< continuous pixels downwards, in [0, height]
  /// Names the point: the same for the same point whatever the batch size, the wave size or the
  /// number of threads, and no two points of an image share one. Good as a seed for the host's
  /// random numbers.
  std::uint64_t id = 0;
  /// Distance in pixels to the nearest earlier samples of the block, a footprint for texture
  /// filters.
  float spacing = 0;
  std::uint32_t slot = 0;  ///< the engine's own note; hand it back unchanged
};

namespace detail {

template <class T>
struct SampleTraits {
  static constexpr bool valid = false;
};

template <class T>
requires std::is_arithmetic_v<T>
struct SampleTraits<T> {
  static constexpr bool valid = true;
  static constexpr std::size_t channels = 1;
  static void store(const T& value, float* out) { *out = static_cast<float>(value); }
};

template <class T, std::size_t N>
requires std::is_arithmetic_v<T>
struct SampleTraits<std::array<T, N>> {
  static constexpr bool valid = N > 0;
  static constexpr std::size_t channels = N;
  static void store(const std::array<T, N>& value, float* out) {
    for (std::size_t c = 0; c < N; ++c) out[c] = static_cast<float>(value[c]);
  }
};

}  // namespace detail

/// A function of a position (x, y) in pixels that returns one number or a std::array of numbers.
template <class F>
concept ScalarSampler = std::invocable<F&, double, double> &&
    detail::SampleTraits<std::remove_cvref_t<std::invoke_result_t<F&, double, double>>>::valid;

/// A function that fills in the values of many requests at once.
template <class F>
concept BatchSampler = std::invocable<F&, std::span<const Request>, std::span<float>>;

/// Either form.
template <class F>
concept Sampler = ScalarSampler<F> || BatchSampler<F>;

namespace detail {

/// Number of values that a sampler returns, or `unknown` for a batch sampler, which does not say.
template <Sampler S>
constexpr std::size_t sampler_channels(std::size_t unknown) {
  if constexpr (BatchSampler<S>) {
    return unknown;
  } else {
    return SampleTraits<std::remove_cvref_t<std::invoke_result_t<S&, double, double>>>::channels;
  }
}

/// Calls a sampler of either form for a run of requests. `done` counts the requests whose values
/// are complete, also when the sampler throws.
template <class S>
void call_sampler(S& sampler, std::span<const Request> requests, std::span<float> values,
                  std::size_t& done) {
  if constexpr (BatchSampler<S>) {
    sampler(requests, values);
    done = requests.size();
  } else {
    using Traits = SampleTraits<std::remove_cvref_t<std::invoke_result_t<S&, double, double>>>;
    for (const Request& request : requests) {
      Traits::store(sampler(request.x, request.y), values.data() + done * Traits::channels);
      ++done;
    }
  }
}

}  // namespace detail

}  // namespace freqsynth
