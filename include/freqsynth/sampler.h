// SPDX-License-Identifier: MIT
/// \file
/// What the library asks of a host, and in which form: requests and the sampler concepts.
///
/// A host's radiance function comes in one of three forms:
///  - scalar: `f(x, y)` returns a float (or double) for one channel, or several: a std::array, a
///    struct of floats, or a type of the host's, see sample_traits.h;
///  - by request: `f(request)` does the same for a `const Request&`, which has more than the
///    position: a seed for random numbers, the sample's ordinal in its pixel, the distance to other
///    samples, a number for the thread's own memory;
///  - batch: `f(std::span<const Request>, std::span<float>)` writes `channels` values per request,
///    those of request i at [i * channels, (i + 1) * channels). strided() moves them further apart.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "freqsynth/basis/config.h"
#include "freqsynth/sample_traits.h"

namespace freqsynth {

/// One position the engine wants a value for.
struct Request {
  double x = 0;  ///< continuous pixels to the right, in [0, width]; pixel i is centred at i + 0.5
  double y = 0;  ///< continuous pixels downwards, in [0, height]
  /// Names the request: the same for the same point whatever the batch size, the wave size or the
  /// number of threads, and no two requests of an image share one. A point that is asked for a
  /// second time, so that noise is noticed, has another one then. Neighbours have similar ones.
  std::uint64_t id = 0;
  /// Distance in pixels to the nearest earlier samples of the block, a footprint for texture
  /// filters. In a block of less than 8 pixels in width or height, the last of its row or column,
  /// it is told along the shorter side.
  float spacing = 0;
  std::uint32_t slot = 0;  ///< the engine's own note; hand it back unchanged
  /// A seed for the host's random numbers: all bits of `id` and of SynthesisSettings::seed, well
  /// mixed. No two requests of an image share one; pictures of other settings' seeds have others.
  std::uint64_t seed = 0;
  /// The pixel that contains the point, row * width + column. The image's right and bottom border
  /// belong to the last pixels.
  std::uint64_t pixel = 0;
  /// The samples of a pixel are numbered 0, 1, 2, ... in the order in which the engine chooses
  /// them: the place in a sequence for the pixel, such as that of OwenSobol (basis/owen_sobol.h).
  /// Like the id it is the same whatever the batch size, the number of threads and the order of
  /// delivery. It depends on the values delivered before, and on the wave size, as which points are
  /// chosen does.
  std::uint32_t ordinal = 0;
  /// Within Synthesizer::run(), no two calls of the sampler at the same time have the same number
  /// here, which is below the executor's concurrency(): for memory or a generator that calls must
  /// not share. In a loop of the host's own 0.
  std::uint32_t thread = 0;
  /// Whether the point is asked for a second time, so that noise is noticed. Answer it like any
  /// other.
  bool again = false;
};

/// What request() does while all positions of a wave are out and owed.
enum class Wait {
  no,              ///< it returns 0
  until_available  ///< it waits, without using a processor, and returns 0 at the end only
};

/// Largest magnitude that is usable: the coefficients of such values, eight times as large, and
/// what is added up of them, are within what a float can hold.
inline constexpr float max_sample_magnitude = 1e36f;

/// False for a value that is too large, infinite or not a number. Told from the bits, so that it is
/// right in a caller that is compiled for finite numbers only (-ffast-math), too.
[[nodiscard]] constexpr bool is_usable_sample(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7fffffffu) <=
         std::bit_cast<std::uint32_t>(max_sample_magnitude);
}

namespace detail {

/// Functions of whole numbers, which would cut off the fractions of a position. Braces accept no
/// narrowing, so that a character, the smallest of integers, initialises nothing but an integer.
template <class F>
concept TakesIntegers = requires(F& f, signed char c, double d) {
  f({c}, d);
}
|| requires(F& f, unsigned char c, double d) { f({c}, d); }
|| requires(F& f, signed char c, double d) { f(d, {c}); }
|| requires(F& f, unsigned char c, double d) { f(d, {c}); };

}  // namespace detail

/// A function of a position (x, y) in pixels that returns a number or several, see SampleTraits.
template <class F>
concept ScalarSampler = std::invocable<F&, double, double> && !detail::TakesIntegers<F> &&
                        detail::SampleAccessOf<F, double, double>::valid;

/// A function of a request that returns the same.
template <class F>
concept RequestSampler =
    std::invocable<F&, const Request&> && detail::SampleAccessOf<F, const Request&>::valid;

/// A function that fills in the values of many requests at once. Until it does they are NaN, so
/// that a value that was forgotten counts as a bad sample.
template <class F>
concept BatchSampler = !std::invocable<F&, double, double> &&
                       std::invocable<F&, std::span<const Request>, std::span<float>>;

/// One of the forms.
template <class F>
concept Sampler = ScalarSampler<F> || RequestSampler<F> || BatchSampler<F>;

/// See strided().
template <class F>
struct Strided {
  std::size_t stride = 0;  ///< floats from a sample's first value to that of the next
  F function;              ///< a batch sampler

  /// Calls the function, for requests.size() * stride values.
  void operator()(std::span<const Request> requests, std::span<float> values) {
    function(requests, values);
  }
  /// The same.
  void operator()(std::span<const Request> requests, std::span<float> values)
      const requires std::invocable<const F&, std::span<const Request>, std::span<float>> {
    function(requests, values);
  }
};

/// A batch sampler that writes the values of request i at [i * stride, i * stride + channels): for
/// vectors of four floats, say, stride is 4. Memory starts at a multiple of 16 bytes, at one of 32
/// where stride is a multiple of 8, of 64 for one of 16. What lies between is not read.
/// \param stride  at least the number of channels; 0: packed
template <class F>
[[nodiscard]] Strided<std::remove_cvref_t<F>> strided(std::size_t stride, F&& function) {
  static_assert(BatchSampler<F>,
                "freqsynth: only a batch sampler, a function (std::span<const Request>, "
                "std::span<float>), has a stride");
  return {stride, static_cast<F&&>(function)};
}

namespace detail {

template <class S>
inline constexpr bool is_strided = false;
template <class F>
inline constexpr bool is_strided<Strided<F>> = true;

template <class F, class... Arguments>
constexpr bool returns_sample() {
  if constexpr (std::invocable<F&, Arguments...>) {
    return SampleAccessOf<F, Arguments...>::valid;
  } else {
    return true;
  }
}

template <class F, class... Arguments>
constexpr bool returns_wrongly_described() {
  if constexpr (std::invocable<F&, Arguments...>) {
    using T = std::remove_cvref_t<std::invoke_result_t<F&, Arguments...>>;
    return HasSampleTraits<T> && !DescribedSample<T>;
  } else {
    return false;
  }
}

/// Refuses, with a sentence, what is no sampler.
template <class F>
constexpr void check_sampler() {
  static_assert(!TakesIntegers<F>,
                "freqsynth: the sampler takes whole numbers, but positions are fractions of "
                "pixels: let it take (double x, double y)");
  if constexpr (!TakesIntegers<F> && !Sampler<F>) {
    constexpr bool described = !returns_wrongly_described<F, double, double>() &&
                               !returns_wrongly_described<F, const Request&>();
    constexpr bool sample =
        returns_sample<F, double, double>() && returns_sample<F, const Request&>();
    static_assert(described,
                  "freqsynth: a SampleTraits has static constexpr std::size_t channels, at least "
                  "1, and static float value(const T& sample, std::size_t channel)");
    static_assert(sample || !described,
                  "freqsynth: the sampler returns no sample: let it return a number, a std::array "
                  "of numbers or a struct of floats, or specialise freqsynth::SampleTraits for its "
                  "type");
    static_assert(!sample || !described,
                  "freqsynth: a sampler is a function (double x, double y) or (const Request&) "
                  "that returns numbers, or a function (std::span<const Request>, "
                  "std::span<float>) that writes them");
  }
}

/// Number of values that a sampler returns, or `unknown` for a batch sampler, which does not say.
template <Sampler S>
constexpr std::size_t sampler_channels(std::size_t unknown) {
  if constexpr (ScalarSampler<S>) {
    return SampleAccessOf<S, double, double>::channels;
  } else if constexpr (RequestSampler<S>) {
    return SampleAccessOf<S, const Request&>::channels;
  } else {
    return unknown;
  }
}

/// Floats from a sample to the next, in the memory that a sampler writes to. 0: packed.
template <class S>
std::size_t sampler_stride(const S& sampler) {
  if constexpr (is_strided<S>) {
    return sampler.stride;
  } else {
    return 0;
  }
}

/// Calls a sampler of any form for a run of requests. `done` counts the requests whose values are
/// complete, also when the sampler throws.
template <class S>
void call_sampler(S& sampler, std::span<const Request> requests, std::span<float> values,
                  std::size_t& done) {
  if constexpr (ScalarSampler<S>) {
    using Access = SampleAccessOf<S, double, double>;
    for (const Request& request : requests) {
      Access::store(sampler(request.x, request.y), values.data() + done * Access::channels);
      ++done;
    }
  } else if constexpr (RequestSampler<S>) {
    using Access = SampleAccessOf<S, const Request&>;
    for (const Request& request : requests) {
      Access::store(sampler(request), values.data() + done * Access::channels);
      ++done;
    }
  } else {
    // A NaN by its bits, which no compiler takes for impossible.
    for (float& value : values) value = std::bit_cast<float>(0x7fc00000u);
    sampler(requests, values);
    done = requests.size();
  }
}

}  // namespace detail

}  // namespace freqsynth
