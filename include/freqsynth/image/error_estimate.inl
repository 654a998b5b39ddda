// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "freqsynth/basis/dct.h"
#include "freqsynth/image/error_estimate.h"

namespace freqsynth {
namespace detail {

inline constexpr std::array<float, max_terms> all_ones() {
  std::array<float, max_terms> ones{};
  for (float& one : ones) one = 1;
  return ones;
}

/// Samples per pixel.
inline double samples_per_pixel(const ErrorEstimate::Known& known) {
  return static_cast<double>(known.samples) / (max_terms * double{known.area});
}

/// Mean energy of a term of the highest frequencies in a fit, as the mean square of the pixels.
inline double highest_energy(const BlockFit& fit, std::size_t terms) {
  constexpr double from = 0.6;  // of the frequency of the last terms
  constexpr double pi = 3.14159265358979323846;
  const double least = from * from * static_cast<double>(terms) * 4 / pi;
  double energy = 0, count = 0;
  for (std::size_t i = 1; i < terms; ++i) {
    const Frequency f = frequency_of_term(i);
    if (f.u * f.u + f.v * f.v < least) continue;
    energy += double{fit.coefficients[i]} * double{fit.coefficients[i]} / max_terms;
    count += 1;
  }
  return count > 0 ? energy / count : 0;
}

/// Expected squared error of the pixels without noise, per unit of the residuals' variance, and
/// which share of it is at edges.
inline BlockError error_of_detail(const BlockFit& fit, const ErrorEstimate::Known& known) {
  constexpr double at_first = 0.95, rate = 1.75, power = 1.35;
  constexpr double most = 0.5;     // of what samples leave that are not evenly spread
  constexpr double sooner = 2.5;   // samples per pixel: from then on smooth functions profit
  constexpr double texture = 0.4;  // power
  constexpr double edges = 1.33;   // residuals of edges, in the energy of highest terms, per term
  constexpr double least_ratio = 0.1, most_ratio = 8;
  const double w = samples_per_pixel(known);
  const double variance = double{fit.residual};
  double ratio = 1;
  if (variance > 0) {
    const double edge = edges * static_cast<double>(known.terms) * highest_energy(fit, known.terms);
    ratio = variance < most_ratio * edge ? std::max(variance / edge, least_ratio) : most_ratio;
  }
  const double factor = std::pow(ratio, ratio < 1 ? w / (w + sooner) : texture);
  const double share =
      std::min(at_first * std::pow(1 + rate * w, -power) * factor, most / std::max(w, 1.0));
  const double at_edges = std::min(ratio, 1.0);
  return {0, (1 - at_edges) * share, at_edges * share};
}

}  // namespace detail

FREQSYNTH_INLINE ErrorEstimate::ErrorEstimate(const FinishSettings& settings)
    : settings_(settings), filter_(settings.butterworth, detail::all_ones()) {
  settings.validate();
  for (std::size_t i = 0; i < max_terms; ++i) box_[i] = pixel_mean_of_term(i);
}

/// Where samples are estimates.
FREQSYNTH_INLINE BlockError ErrorEstimate::of_noise(const BlockFit& fit, const Known& known) {
  constexpr double least = 0.08;                    // of the noise of pixels' means is always left
  constexpr double smoothed = 0.3;                  // of it is smoothed to half
  constexpr double edges = 1.33, most_edges = 0.6;  // as above, per sample
  constexpr double most_doubt = 64;                 // where PixelFinisher measures it
  const auto samples = static_cast<double>(known.samples);
  const double noise = double{fit.residual} * max_terms / samples;  // variance of a coefficient
  const std::array<float, max_terms>& kept = filter_.of(static_cast<std::uint32_t>(known.samples));
  double risk = 0;  // of all, in units of that
  for (std::size_t i = 0; i < known.terms && noise > 0; ++i) {
    // Of F max(0, 1 - 2 e / F^2) with the variance e (Stein 1981).
    const double square = double{fit.coefficients[i]} * double{fit.coefficients[i]} / noise;
    const double in_pixels = double{kept[i]} * box_[i];
    risk += in_pixels * in_pixels * (square > 2 ? 1 + 8 / square : square - 1);
  }
  // Residuals within pixels bring back some of it.
  const double w = detail::samples_per_pixel(known);
  const bool measured = settings_.measure_doubt && known.samples >= max_terms;
  const double doubt = measured ? most_doubt : settings_.noisy_doubt;
  const double back = settings_.residuals ? w / (w + doubt) : 0;
  double left = std::clamp(risk / max_terms + back * back * std::min(w, 1.0), least, 1.5);
  if (settings_.smooth_noise) left *= left / (left + smoothed);
  // The energy of the highest terms is that of noise, or more.
  const double high = samples * detail::highest_energy(fit, known.terms);
  const double all_noise = high > 0 ? double{fit.residual} / high : 1;
  const double no_noise = std::min(edges * static_cast<double>(known.terms) / samples, most_edges);
  const double share = std::clamp((all_noise - no_noise) / (1 - no_noise), 0.0, 1.0);
  BlockError error = detail::error_of_detail(fit, known);
  error.detail_share *= 1 - share;
  error.even_share = (1 - share) * error.even_share + share * left / w;
  return error;
}

FREQSYNTH_INLINE BlockError ErrorEstimate::of(const BlockFit& fit, const Known& known) {
  if (settings_.noise == Noise::present) return of_noise(fit, known);
  constexpr double missed = 0.3;  // of a surprise is in a pixel of its own
  BlockError error = detail::error_of_detail(fit, known);
  // What the filter takes away, residuals bring back where there are samples.
  const double w = detail::samples_per_pixel(known);
  const double back = settings_.residuals ? w / (w + settings_.doubt) * std::min(w, 1.0) : 0;
  const std::array<float, max_terms>& kept = filter_.of(static_cast<std::uint32_t>(known.samples));
  double taken = 0;
  for (std::size_t i = 0; i < known.terms; ++i) {
    const double lost = double{fit.coefficients[i]} * (1 - double{kept[i]}) * (1 - back);
    taken += lost * lost / max_terms;
  }
  error.even = taken + missed * known.surprise / (1 + w);
  return error;
}

FREQSYNTH_INLINE void ErrorEstimate::spread(const BlockFit& fit,
                                            std::span<float, max_terms> factors) {
  constexpr std::size_t side = block_size;
  constexpr float everywhere = 0.2f;  // of the mean, in each pixel
  std::array<float, max_terms> pixels;
  inverse_dct(fit.coefficients, pixels);
  float sum = 0;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const float own = pixels[y * side + x];
      float step = 0;
      for (std::size_t v = std::max<std::size_t>(y, 1) - 1; v < std::min(y + 2, side); ++v) {
        for (std::size_t u = std::max<std::size_t>(x, 1) - 1; u < std::min(x + 2, side); ++u) {
          step = std::max(step, std::abs(pixels[v * side + u] - own));
        }
      }
      factors[y * side + x] = step * step;
      sum += step * step;
    }
  }
  const float mean = sum / max_terms;
  if (!(mean > 0)) {
    std::fill(factors.begin(), factors.end(), 1.0f);
    return;
  }
  for (float& factor : factors) factor = (factor / mean + everywhere) / (1 + everywhere);
}

}  // namespace freqsynth
