// SPDX-License-Identifier: MIT
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
#include <cstddef>
#include <span>
#include <utility>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// The encoding of sRGB, from linear values to 0..255 and back.
struct DisplayEncoding {
  float exposure = 1;  ///< factor on linear values; finite and > 0

  /// \throws std::invalid_argument naming the value when out of range.
  FREQSYNTH_API void validate() const;

  /// Linear value to display value: times the exposure, clamped to 0..1, the transfer function of
  /// sRGB (IEC 61966-2-1), scaled to 0..255. Not a number when `linear` is not finite, so that the
  /// fault is counted and not hidden.
  [[nodiscard]] FREQSYNTH_API float encode(float linear) const;

  /// The inverse of encode() for values in 0..255; others are clamped. Not a number for what is
  /// none.
  [[nodiscard]] FREQSYNTH_API float decode(float encoded) const;

  /// Linear RGB to Y in 0..255 and Cb, Cr in -127.5..127.5: BT.601 over the full range, as JFIF has
  /// it.
  [[nodiscard]] FREQSYNTH_API std::array<float, 3> encode(const std::array<float, 3>& rgb) const;

  /// encode() of many values in place: linear ones of 1 channel, or of 3, RGB to Y, Cb, Cr. A value
  /// that is not finite makes all of its pixel not a number. Unlike a call with a number that is
  /// none, this is right also where the caller is compiled with -ffast-math.
  FREQSYNTH_API void encode(std::span<float> values, std::size_t channels) const;
};

/// Display RGB in 0..255 (not clamped) of Y, Cb, Cr.
[[nodiscard]] FREQSYNTH_API std::array<float, 3> display_rgb(const std::array<float, 3>& ycc);

namespace detail {

/// \throws std::invalid_argument unless channels is 1 or 3 and the sampler returns as many.
FREQSYNTH_API void check_display_channels(std::size_t channels, std::size_t sampler_channels);

}  // namespace detail

/// A batch sampler that encodes the values of another sampler of either form, with 1 or 3 channels.
template <Sampler S>
class DisplaySampler {
  static_assert(!detail::is_strided<std::remove_cv_t<S>>,
                "freqsynth: a DisplaySampler takes no strided() sampler");

 public:
  /// \param channels  1 (a linear luminance) or 3 (linear RGB)
  /// \throws std::invalid_argument when channels or the encoding is out of range, or the sampler
  ///         returns another number of values.
  DisplaySampler(S sampler, std::size_t channels, const DisplayEncoding& encoding = {})
      : sampler_(std::move(sampler)), channels_(channels), encoding_(encoding) {
    detail::check_display_channels(channels, detail::sampler_channels<S>(channels));
    encoding.validate();
  }

  /// A BatchSampler: calls the other sampler and encodes what it returns.
  void operator()(std::span<const Request> requests, std::span<float> values) {
    std::size_t done = 0;
    detail::call_sampler(sampler_, requests, values, done);
    encoding_.encode(values, channels_);
  }

 private:
  S sampler_;
  std::size_t channels_;
  DisplayEncoding encoding_;
};

/// The image with pixels encoded after reconstruction: finished pixels with the signal of a JPEG
/// file.
/// \param linear  1 channel, or 3: RGB
/// \throws std::invalid_argument when the number of channels or a setting is out of range.
[[nodiscard]] FREQSYNTH_API FrequencyImage
encode_pixels(const FrequencyImage& linear, const DisplayEncoding& encoding = {},
              const ReconstructionSettings& settings = {});

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/jpeg/display_encoding.inl"
#endif
