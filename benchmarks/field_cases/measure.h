// SPDX-License-Identifier: MIT
/// \file
/// Pictures of a function by this library, by the same engine with equal samples everywhere, and by
/// jittered samples; and how wrong they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "field.h"
#include "freqsynth/freqsynth.h"

namespace field_cases {

/// Writes the channels of the sample `id` at (x, y).
using Sampler = std::function<void(double x, double y, std::uint64_t id, std::span<float> values)>;

/// A sampler for the function of a field.
[[nodiscard]] Sampler sampler_of(const Field& field);

/// A picture and what it took.
struct Picture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 1;
  std::vector<float> pixels;  ///< row by row, channels interleaved
  std::uint64_t samples = 0;  ///< calls of the sampler

  /// A pixel of the first channel.
  [[nodiscard]] double at(std::size_t i, std::size_t j) const {
    return pixels[(j * width + i) * channels];
  }
  /// Samples per pixel.
  [[nodiscard]] double rate() const {
    return static_cast<double>(samples) / static_cast<double>(width * height);
  }
};

/// The settings that the cases start from: one channel, the defaults.
[[nodiscard]] freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height);

/// The same engine with equal samples in every block.
[[nodiscard]] freqsynth::SynthesisSettings uniform_settings(freqsynth::SynthesisSettings settings);

/// Errors are compared as a display in sRGB shows them.
[[nodiscard]] freqsynth::SynthesisSettings display_settings(freqsynth::SynthesisSettings settings);

/// Samples until `rate` samples per pixel (infinite: no limit, which needs a quantization target)
/// and returns the engine's finished image. `settings.list.seed` is set to `seed`.
[[nodiscard]] freqsynth::FrequencyImage synthesize_image(const Sampler& sampler,
                                                         freqsynth::SynthesisSettings settings,
                                                         double rate, std::uint64_t seed,
                                                         std::uint64_t* samples = nullptr);

/// The pixels of synthesize_image().
[[nodiscard]] Picture synthesize(const Sampler& sampler,
                                 const freqsynth::SynthesisSettings& settings, double rate,
                                 std::uint64_t seed);

/// `samples` jittered samples in strata of equal areas (each pixel has its own when their number is
/// a whole multiple of that of the pixels). A pixel is the mean of the samples in it, those that
/// are not numbers left out; without any it is the sample of the stratum at its centre.
[[nodiscard]] Picture jittered(const Sampler& sampler, std::size_t width, std::size_t height,
                               std::size_t channels, std::uint64_t samples, std::uint64_t seed);

/// The whole number of samples at that rate.
[[nodiscard]] std::uint64_t samples_at(double rate, std::size_t width, std::size_t height);

/// Runs with different random numbers that are averaged.
inline constexpr std::uint64_t synthesis_seeds = 3;
inline constexpr std::uint64_t jittered_seeds = 8;

/// A part of the columns of a picture: from .. to - 1.
struct Columns {
  std::size_t from = 0;
  std::size_t to = static_cast<std::size_t>(-1);
};

/// Mean squared error of the first channel.
[[nodiscard]] double squared_error(const Picture& picture, std::span<const double> right,
                                   const Columns& columns = {});

/// Mean of the first channel.
[[nodiscard]] double mean(const Picture& picture);

/// What is measured of a picture, such as squared_error().
using Measure = std::function<double(const Picture&)>;

/// The mean of a measure over seeds 1 .. synthesis_seeds.
[[nodiscard]] double over_seeds(const Sampler& sampler,
                                const freqsynth::SynthesisSettings& settings, double rate,
                                const Measure& measure, std::uint64_t seeds = synthesis_seeds);

/// The mean of a measure over jittered pictures.
[[nodiscard]] double over_jittered(const Sampler& sampler, std::size_t width, std::size_t height,
                                   std::size_t channels, double rate, const Measure& measure,
                                   std::uint64_t seeds = jittered_seeds);

/// sRGB encoding, 0..1 to 0..1, clamped.
[[nodiscard]] double display(double linear);

}  // namespace field_cases
