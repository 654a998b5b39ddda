// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/image/lift_negative.h"
#include "freqsynth/image/pixel_finisher.h"

namespace freqsynth {
namespace detail {

/// Where all samples of a pixel fell away, rounding is left; and where hardly anything is, mostly
/// rounding.
inline constexpr float least_weight = 1e-3f;

/// Of each pixel the least and the greatest of the values in it and in those around it.
struct Extremes {
  std::array<float, max_terms> least, most;
};

/// Values count where there are some.
inline Extremes extremes_around(const std::array<float, max_terms>& values,
                                const std::array<bool, max_terms>& known) {
  constexpr std::size_t side = block_size;
  constexpr float none = std::numeric_limits<float>::max();
  Extremes lines, around;
  for (std::size_t y = 0; y < max_terms; y += side) {
    std::array<float, side + 2> low, high;
    low.front() = low.back() = none;
    high.front() = high.back() = -none;
    for (std::size_t x = 0; x < side; ++x) {
      low[x + 1] = known[y + x] ? values[y + x] : none;
      high[x + 1] = known[y + x] ? values[y + x] : -none;
    }
    for (std::size_t x = 0; x < side; ++x) {
      lines.least[y + x] = std::min(std::min(low[x], low[x + 1]), low[x + 2]);
      lines.most[y + x] = std::max(std::max(high[x], high[x + 1]), high[x + 2]);
    }
  }
  for (std::size_t y = 0; y < max_terms; y += side) {
    const std::size_t above = y > 0 ? y - side : 0;
    const std::size_t below = std::min(y + side, max_terms - side);
    for (std::size_t x = 0; x < side; ++x) {
      const auto& [least, most] = lines;
      around.least[y + x] = std::min(std::min(least[above + x], least[y + x]), least[below + x]);
      around.most[y + x] = std::max(std::max(most[above + x], most[y + x]), most[below + x]);
    }
  }
  return around;
}

}  // namespace detail

FREQSYNTH_INLINE PixelFinisher::PixelFinisher(SharedInverseList list,
                                              const FinishSettings& settings)
    : list_(std::move(list)), settings_(settings), sums_(max_terms * max_terms) {
  settings.validate();
  if (!list_) detail::refuse("there is no inverse list");
  for (std::size_t i = 0; i < max_terms; ++i) box_[i] = static_cast<float>(pixel_mean_of_term(i));
  weights_.fill(0);
  inverse_weights_.fill(0);
  filter_ = butterworth_factors(settings_.butterworth, 0);
}

FREQSYNTH_INLINE void PixelFinisher::advance(std::size_t samples) {
  FREQSYNTH_ASSERT(samples >= samples_);
  if (samples == samples_) return;
  for (; samples_ < samples; ++samples_) {
    const detail::SampleRow& row = list_->row(samples_);
    owned_.add(row);
    border_.add(list_->position(samples_), row);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      const std::size_t pixel = row.pixels[p];
      weights_[pixel] += row.pixel_weights[p];
      float* sums = sums_.data() + pixel * max_terms;
      for (std::size_t i = 0; i < max_terms; ++i) {
        sums[detail::zigzag_to_row_major[i]] += row.pixel_weights[p] * (row.fit[i] + row.rest[i]);
      }
    }
  }
  filter_ = butterworth_factors(settings_.butterworth, samples);
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    inverse_weights_[pixel] = weights_[pixel] > 0 ? 1 / weights_[pixel] : 0;
  }
}

/// The filtered fit.
FREQSYNTH_INLINE void PixelFinisher::filter(const BlockFit& fit,
                                            std::span<float, max_terms> filtered) const {
  const std::array<float, max_terms>& coefficients = fit.coefficients;
  for (std::size_t i = 0; i < max_terms; ++i) filtered[i] = coefficients[i] * filter_[i];
  if (!settings_.residuals || samples_ == 0) return;
  const std::span<const float, max_terms> variances = list_->variances(samples_ - 1);
  const float scale = static_cast<float>(settings_.shrinkage) * fit.residual;
  for (std::size_t i = 0; i < max_terms; ++i) {
    const float square = coefficients[i] * coefficients[i];
    const float error = scale * variances[i];
    filtered[i] *= square > error ? 1 - error / square : 0;
  }
}

/// Variance of the residuals within a pixel over the variance of their true means.
/// \param means  average residual in each pixel
FREQSYNTH_INLINE double PixelFinisher::measured_doubt(const BlockFit& fit,
                                                      std::span<const float, max_terms> filtered,
                                                      const detail::AlignedBlock& means) const {
  constexpr double least = 0.1, most = 64;
  // Analysis of variance: E[between] = pixels * within + samples * (variance of the means).
  double between = 0, pixels = 0;
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    between += double{weights_[pixel]} * double{means[pixel]} * double{means[pixel]};
    pixels += weights_[pixel] > 0 ? 1 : 0;
  }
  // The residuals are those of the fit; of the filtered fit they are larger by what it lost.
  const std::size_t terms = list_->terms(samples_ - 1);
  double lost = 0;
  for (std::size_t i = 0; i < terms; ++i) {
    lost += std::pow(double{fit.coefficients[i]} - double{filtered[i]}, 2);
  }
  const auto samples = static_cast<double>(samples_);
  const double freedom = std::max(1.0, samples - static_cast<double>(terms));
  const double total = double{fit.residual} * freedom + samples * lost / max_terms;
  const double within = std::max(0.0, (total - between) / std::max(1.0, samples - pixels));
  const double means_variance = (between - pixels * within) / samples;
  return means_variance > 0 ? std::clamp(within / means_variance, least, most) : most;
}

/// Holds pixels within what the samples around have shown.
FREQSYNTH_INLINE void PixelFinisher::bound(const BlockFit& fit, std::span<float, max_terms> pixels,
                                           const PixelEvidence& evidence) const {
  constexpr int side = block_size;
  constexpr int enough = 4;
  std::array<float, max_terms> means;
  std::array<bool, max_terms> sampled;
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    sampled[pixel] = evidence.constant_pixels ? owned_.any(pixel) : weights_[pixel] > 0;
    means[pixel] = fit.pixel_sums[pixel] * inverse_weights_[pixel];
    if (!evidence.constant_pixels || !sampled[pixel]) continue;
    means[pixel] = owned_.mean(fit.own_sums, pixel);
    pixels[pixel] = std::clamp(pixels[pixel], means[pixel] - fit.spread, means[pixel] + fit.spread);
  }
  struct Range {
    float low = 0, high = 0;
    int known = 0;
  };
  // The slack on each side is in proportion to the distance from the median, so that a few bright
  // pixels beside many dark ones widen the range of the bright only.
  const auto range_of = [&](int left, int top, int right, int bottom) {
    std::array<float, max_terms> values;
    Range range;
    for (int y = std::max(top, 0); y <= std::min(bottom, side - 1); ++y) {
      for (int x = std::max(left, 0); x <= std::min(right, side - 1); ++x) {
        const auto pixel = static_cast<std::size_t>(y * side + x);
        if (sampled[pixel]) values[static_cast<std::size_t>(range.known++)] = means[pixel];
      }
    }
    if (range.known == 0) return range;
    const auto end = values.begin() + range.known;
    const auto middle = values.begin() + range.known / 2;
    std::nth_element(values.begin(), middle, end);
    const float low = *std::min_element(values.begin(), middle + 1);
    const float high = *std::max_element(middle, end);
    range.low = low - static_cast<float>(settings_.slack) * (*middle - low);
    range.high = high + static_cast<float>(settings_.slack) * (high - *middle);
    return range;
  };
  const Range whole = range_of(0, 0, side - 1, side - 1);
  // A fit that leaves nothing over does not ring; it knows peaks that lie between samples.
  const float visible = 0.01f * (whole.high - whole.low);
  if (whole.known == 0 || fit.residual <= visible * visible) return;
  const auto [least, most] = detail::extremes_around(means, sampled);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const auto at = static_cast<std::size_t>(y * side + x);
      // Most are within what is shown around, which is cheaper to know than the median.
      if (pixels[at] >= least[at] && pixels[at] <= most[at]) continue;
      const Range around = range_of(x - 1, y - 1, x + 1, y + 1);
      const Range& range = around.known < enough ? whole : around;
      pixels[at] = std::clamp(pixels[at], range.low, range.high);
    }
  }
  if (settings_.ringing == 0) return;
  const float range = (whole.high - whole.low) / (1 + static_cast<float>(settings_.slack));
  OwnMeans(evidence.own_means).hold(pixels, range, static_cast<float>(settings_.ringing));
}

/// Takes samples out of the number of samples of each pixel and of their sums.
FREQSYNTH_INLINE void PixelFinisher::leave_out(std::span<const Gap> gaps,
                                               std::span<float, max_terms> weights,
                                               std::span<float, max_terms> sums) const {
  for (const Gap& gap : gaps) {
    const detail::SampleRow& row = list_->row(gap.sample);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      weights[row.pixels[p]] -= row.pixel_weights[p];
      sums[row.pixels[p]] -= gap.value * row.pixel_weights[p];
    }
  }
}

FREQSYNTH_INLINE void PixelFinisher::pixel_samples(const BlockFit& fit,
                                                   std::span<const float, max_terms> otherwise,
                                                   std::span<float, max_terms> weights,
                                                   std::span<float, max_terms> sums) const {
  std::array<float, max_terms> good = weights_;
  std::copy(fit.pixel_sums.begin(), fit.pixel_sums.end(), sums.begin());
  leave_out(fit.gaps, good, sums);
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    weights[pixel] = weights_[pixel];
    if (fit.gaps.empty()) continue;
    const bool any = good[pixel] > detail::least_weight;
    sums[pixel] = weights_[pixel] * (any ? sums[pixel] / good[pixel] : otherwise[pixel]);
  }
}

/// As if the samples that are gaps had not been taken.
FREQSYNTH_INLINE void PixelFinisher::finish_without_gaps(const BlockFit& fit,
                                                         std::span<float, max_terms> out,
                                                         const PixelEvidence& evidence) const {
  PixelFinisher others(*this);
  std::array<float, max_terms> pixel_sums;
  std::copy(fit.pixel_sums.begin(), fit.pixel_sums.end(), pixel_sums.begin());
  leave_out(fit.gaps, others.weights_, pixel_sums);
  for (const Gap& gap : fit.gaps) {
    const detail::SampleRow& row = list_->row(gap.sample);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      float* sums = others.sums_.data() + row.pixels[p] * max_terms;
      for (std::size_t i = 0; i < max_terms; ++i) {
        sums[detail::zigzag_to_row_major[i]] -= row.pixel_weights[p] * (row.fit[i] + row.rest[i]);
      }
    }
  }
  others.samples_ -= fit.gaps.size();
  others.filter_ = butterworth_factors(settings_.butterworth, others.samples_);
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    float& weight = others.weights_[pixel];
    if (weight < detail::least_weight) weight = 0;
    others.inverse_weights_[pixel] = weight > 0 ? 1 / weight : 0;
  }
  others.finish({fit.coefficients, pixel_sums, fit.residual}, out, evidence);
}

FREQSYNTH_INLINE std::vector<Gap> PixelFinisher::foreign_samples(
    const BlockFit& fit, const PixelEvidence& evidence) const {
  if (!settings_.residuals || evidence.constant_pixels || !fit.gaps.empty()) return {};
  return border_.foreign(fit, evidence.own_means, *list_);
}

FREQSYNTH_INLINE void PixelFinisher::finish(const BlockFit& fit, std::span<float, max_terms> out,
                                            const PixelEvidence& evidence) const {
  if (!fit.gaps.empty()) return finish_without_gaps(fit, out, evidence);
  std::array<float, max_terms> filtered;
  filter(fit, filtered);
  for (std::size_t i = 0; i < max_terms; ++i) out[i] = filtered[i] * box_[i];
  if (!settings_.residuals || samples_ == 0) return;

  detail::AlignedBlock amplitudes, means, sums;
  for (std::size_t i = 0; i < max_terms; ++i) {
    amplitudes[detail::zigzag_to_row_major[i]] =
        filtered[i] * static_cast<float>(amplitude_of_coefficient(i));
    sums[i] = fit.pixel_sums[i];
  }
  detail::residual_means(sums_.data(), amplitudes.data(), sums.data(), inverse_weights_.data(),
                         means.data());
  const bool noisy = settings_.noise == Noise::present;
  const bool measure = noisy && settings_.measure_doubt && samples_ >= max_terms;
  const double usual = noisy ? settings_.noisy_doubt : settings_.doubt;
  const auto doubt = static_cast<float>(measure ? measured_doubt(fit, filtered, means) : usual);
  std::array<float, max_terms> pixels;
  inverse_dct(out, pixels);
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    if (weights_[pixel] == 0) continue;
    pixels[pixel] += means[pixel] * weights_[pixel] / (weights_[pixel] + doubt);
  }
  if (detail::is_finite(settings_.slack)) bound(fit, pixels, evidence);
  if (settings_.keep_positive && evidence.positive) detail::lift_negative(pixels);
  forward_dct(pixels, out);
}

}  // namespace freqsynth
