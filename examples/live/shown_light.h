// SPDX-License-Identifier: MIT
/// \file
/// Light as it is fit so that a slider for the exposure needs neither pixels nor new samples.
///
/// JPEG holds Y, Cb and Cr of s(E L), with an exposure E, light L and the curve of sRGB, which is
/// s(L) = 1.055 L^(1 / 2.4) - 0.055 but for the darkest. So with p = 1.055 L^(1 / 2.4),
///
///     s(E L) = E^(1 / 2.4) p - 0.055:
///
/// when p is fit, any exposure of it is a factor on all coefficients, and a term of the constant
/// one. It differs from sRGB by less than 3 levels of 255, where light is below 0.0031.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "freqsynth/freqsynth.h"

namespace live {

/// Channels of a sample: Y, Cb and Cr of what is shown steer; red, green and blue ride along, for
/// files of linear light.
inline constexpr std::size_t shown_channels = 3;
inline constexpr std::size_t channels = 6;

/// Brighter light is shown as if it were this bright. A picture without a limit would ring around
/// lamps, and one that is cut off at white could not be shown darker.
inline constexpr float most_shown = 4;

/// The channels of a sample. What is no number stays so, and is counted by the engine.
[[nodiscard]] std::array<float, channels> sample_of(std::span<const float, 3> rgb);

/// Settings of an engine for such samples.
[[nodiscard]] freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height,
                                                       bool noisy);

/// E^(1 / 2.4), which errors of what is shown are multiplied by as well.
/// \param stops  log2 of the exposure
[[nodiscard]] float exposure_factor(double stops);

/// The signal of a JPEG file, Y, Cb and Cr, of an image of such channels.
[[nodiscard]] freqsynth::FrequencyImage exposed(const freqsynth::FrequencyImage& image,
                                                double stops);

/// The others, red, green and blue.
[[nodiscard]] freqsynth::FrequencyImage linear_light(const freqsynth::FrequencyImage& image);

}  // namespace live
