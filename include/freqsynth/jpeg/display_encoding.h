/// \file
/// Display encoding: linear radiance to the signal of a JPEG file, and samplers that do it.
///
/// JPEG codes YCbCr of gamma-encoded values, so a fit of linear radiance does not give its
/// coefficients. There are two ways. Encode the *samples* (DisplaySampler): the fit is the JPEG's
/// signal, no pixel is ever made, and edges are averaged in display space, as the paper does. Or
/// encode the *pixels* (encode_pixels): light is averaged linearly, which is what a camera does,
/// and bright edges come out wider and brighter.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

struct DisplayEncoding {
  float exposure = 1;  ///< factor on linear values; finite and > 0

  /// \throws std::invalid_argument naming the value when out of range.
  void validate() const;

  /// Linear value to display value: times the exposure, clamped to 0..1, the transfer function of
  /// sRGB (IEC 61966-2-1), scaled to 0..255. Not a number when `linear` is not finite, so that the
  /// fault is counted and not hidden.
  [[nodiscard]] float encode(float linear) const;

  /// The inverse of encode() for values in 0..255; others are clamped. Not a number for what is
  /// none.
  [[nodiscard]] float decode(float encoded) const;

  /// Linear RGB to Y in 0..255 and Cb, Cr in -127.5..127.5: BT.601 over the full range, as JFIF has
  /// it.
  [[nodiscard]] std::array<float, 3> encode(const std::array<float, 3>& rgb) const;
};

/// Display RGB in 0..255 (not clamped) of Y, Cb, Cr.
[[nodiscard]] std::array<float, 3> display_rgb(const std::array<float, 3>& ycc);

/// A batch sampler that encodes the values of another sampler of either form, with 1 or 3 channels.
template <Sampler S>
class DisplaySampler {
 public:
  /// \param channels  1 (a linear luminance) or 3 (linear RGB)
  /// \throws std::invalid_argument when channels or the encoding is out of range, or the sampler
  ///         returns another number of values.
  DisplaySampler(S sampler, std::size_t channels, const DisplayEncoding& encoding = {});

  void operator()(std::span<const Request> requests, std::span<float> values);

 private:
  S sampler_;
  std::size_t channels_;
  DisplayEncoding encoding_;
};

/// The image with pixels encoded after reconstruction: finished pixels with the signal of a JPEG
/// file.
/// \param linear  1 channel, or 3: RGB
/// \throws std::invalid_argument when the number of channels or a setting is out of range.
[[nodiscard]] FrequencyImage encode_pixels(const FrequencyImage& linear,
                                           const DisplayEncoding& encoding = {},
                                           const ReconstructionSettings& settings = {});

// ------------------------------------------------------------------------------------ definitions

namespace detail {

/// \throws std::invalid_argument unless channels is 1 or 3 and the sampler returns as many.
void check_display_channels(std::size_t channels, std::size_t sampler_channels);

}  // namespace detail

inline float DisplayEncoding::encode(float linear) const {
  if (!std::isfinite(linear)) return std::numeric_limits<float>::quiet_NaN();
  const float x = std::fmin(std::fmax(linear * exposure, 0.0f), 1.0f);
  const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return 255 * encoded;
}

inline float DisplayEncoding::decode(float encoded) const {
  if (std::isnan(encoded)) return encoded;
  const float x = std::fmin(std::fmax(encoded / 255, 0.0f), 1.0f);
  return (x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f)) / exposure;
}

inline std::array<float, 3> DisplayEncoding::encode(const std::array<float, 3>& rgb) const {
  const float r = encode(rgb[0]);
  const float g = encode(rgb[1]);
  const float b = encode(rgb[2]);
  const float y = 0.299f * r + 0.587f * g + 0.114f * b;
  return {y, (b - y) / 1.772f, (r - y) / 1.402f};
}

inline std::array<float, 3> display_rgb(const std::array<float, 3>& ycc) {
  const float r = ycc[0] + 1.402f * ycc[2];
  const float b = ycc[0] + 1.772f * ycc[1];
  const float g = (ycc[0] - 0.299f * r - 0.114f * b) / 0.587f;
  return {r, g, b};
}

template <Sampler S>
DisplaySampler<S>::DisplaySampler(S sampler, std::size_t channels, const DisplayEncoding& encoding)
    : sampler_(std::move(sampler)), channels_(channels), encoding_(encoding) {
  detail::check_display_channels(channels, detail::sampler_channels<S>(channels));
  encoding.validate();
}

template <Sampler S>
void DisplaySampler<S>::operator()(std::span<const Request> requests, std::span<float> values) {
  std::size_t done = 0;
  detail::call_sampler(sampler_, requests, values, done);
  if (channels_ == 1) {
    for (float& value : values) value = encoding_.encode(value);
    return;
  }
  for (std::size_t i = 0; i + 3 <= values.size(); i += 3) {
    const auto ycc = encoding_.encode(std::array{values[i], values[i + 1], values[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) values[i + c] = ycc[c];
  }
}

}  // namespace freqsynth
