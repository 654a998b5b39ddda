// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
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

/// How many of each pixel and of those around it have a weight.
inline void count_around(const AlignedBlock& weights, AlignedBlock& counts) {
  constexpr std::size_t side = block_size;
  std::array<float, max_terms> rows;  // of each pixel and those beside it
  const auto add_line = [](const float* from, std::size_t step, float* to) {
    for (std::size_t i = 0; i < side; ++i) {
      to[i * step] = from[i * step] + (i > 0 ? from[(i - 1) * step] : 0) +
                     (i + 1 < side ? from[(i + 1) * step] : 0);
    }
  };
  std::array<float, max_terms> known;
  for (std::size_t i = 0; i < max_terms; ++i) known[i] = weights[i] > 0 ? 1 : 0;
  for (std::size_t y = 0; y < side; ++y) add_line(&known[y * side], 1, &rows[y * side]);
  for (std::size_t x = 0; x < side; ++x) add_line(&rows[x], side, &counts[x]);
}

/// Whether a pixel lies outside of what is known around it, and that is too little.
inline bool any_lonely(const AlignedBlock& counts, const AlignedBlock& least,
                       const AlignedBlock& most, std::span<const float, max_terms> pixels) {
  constexpr float few = 4;
  int any = 0;
  for (std::size_t i = 0; i < max_terms; ++i) {
    const int outside = (pixels[i] < least[i] ? 1 : 0) | (pixels[i] > most[i] ? 1 : 0);
    any |= outside & (counts[i] < few ? 1 : 0);
  }
  return any != 0;
}

}  // namespace detail

FREQSYNTH_INLINE PixelFinisher::PixelFinisher(SharedInverseList list,
                                              const FinishSettings& settings,
                                              const detail::ButterworthFilters* filters)
    : list_(std::move(list)), filters_(filters), settings_(settings), sums_(max_terms * max_terms) {
  settings.validate();
  if (!list_) detail::refuse("there is no inverse list");
  for (std::size_t i = 0; i < max_terms; ++i) {
    box_[detail::zigzag_to_row_major[i]] = static_cast<float>(pixel_mean_of_term(i));
  }
  restart();
}

FREQSYNTH_INLINE void PixelFinisher::restart() {
  samples_ = 0;
  owned_ = {};
  border_ = {};
  weights_.fill(0);
  std::fill(sums_.begin(), sums_.end(), 0.0f);
  weigh();
  filter_ = butterworth_factors(settings_.butterworth, 0);
}

/// After the weights have changed.
FREQSYNTH_INLINE void PixelFinisher::weigh() {
  sampled_ = 0;
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    sampled_ += weights_[pixel] > 0 ? 1 : 0;
    inverse_weights_[pixel] = weights_[pixel] > 0 ? 1 / weights_[pixel] : 0;
  }
  detail::count_around(weights_, counts_);
}

FREQSYNTH_INLINE void PixelFinisher::advance(std::size_t samples) {
  FREQSYNTH_ASSERT(samples >= samples_);
  if (samples == samples_) return;
  for (; samples_ < samples; ++samples_) {
    const detail::SampleRow& row = list_->row(samples_);
    owned_.add(row);
    border_.add(list_->position(samples_), row);
    add_terms(row, 1);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      weights_[row.pixels[p]] += row.pixel_weights[p];
    }
  }
  filter_ = filters_ ? filters_->of(static_cast<std::uint32_t>(samples))
                     : butterworth_factors(settings_.butterworth, samples);
  weigh();
}

/// Adds the terms of a sample to the sums of its pixels, `sign` times.
FREQSYNTH_INLINE void PixelFinisher::add_terms(const detail::SampleRow& row, float sign) {
  std::array<float, max_terms> terms;
  for (std::size_t i = 0; i < max_terms; ++i) {
    terms[detail::zigzag_to_row_major[i]] = row.term(i);
  }
  for (std::size_t p = 0; p < row.pixel_count; ++p) {
    float* sums = sums_.data() + row.pixels[p] * max_terms;
    const float weight = sign * row.pixel_weights[p];
    for (std::size_t i = 0; i < max_terms; ++i) sums[i] += weight * terms[i];
  }
}

/// The filtered fit.
FREQSYNTH_INLINE void PixelFinisher::filter(const BlockFit& fit,
                                            std::span<float, max_terms> filtered) const {
  if (!settings_.residuals || samples_ == 0) {
    for (std::size_t i = 0; i < max_terms; ++i) filtered[i] = fit.coefficients[i] * filter_[i];
    return;
  }
  const float scale = static_cast<float>(settings_.shrinkage) * fit.residual;
  detail::shrink_terms(fit.coefficients.data(), filter_.data(),
                       list_->variances(samples_ - 1).data(), scale, filtered.data());
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

/// Means of the samples that lie in pixels, which are flat: pixels do not leave their spread.
/// \return how many pixels have some
FREQSYNTH_INLINE std::size_t PixelFinisher::flat_means(const BlockFit& fit,
                                                       std::span<float, max_terms> pixels,
                                                       Means& means) const {
  std::size_t count = 0;
  detail::AlignedBlock shares, sums;
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    const bool any = owned_.any(pixel);
    shares[pixel] = any ? 1 : 0;
    sums[pixel] = any ? owned_.mean(fit.own_sums, pixel) : 0;
    if (!any) continue;
    ++count;
    pixels[pixel] = std::clamp(pixels[pixel], sums[pixel] - fit.spread, sums[pixel] + fit.spread);
  }
  detail::known_means(sums.data(), shares.data(), means.low, means.high);
  detail::count_around(shares, means.counts);
  return count;
}

/// Holds pixels within what the samples around have shown.
FREQSYNTH_INLINE void PixelFinisher::bound(const BlockFit& fit, std::span<float, max_terms> pixels,
                                           const PixelEvidence& evidence) const {
  Means means;
  std::size_t known = sampled_;
  if (evidence.constant_pixels) {
    known = flat_means(fit, pixels, means);
  } else {
    detail::known_means(fit.pixel_sums.data(), inverse_weights_.data(), means.low, means.high);
    means.counts = counts_;
  }
  if (known == 0) return;
  std::array<float, 2> ends;
  detail::least_and_most(means.low, means.high, ends.data());
  const auto [low, high] = ends;
  const auto slack = static_cast<float>(settings_.slack);
  // A fit that leaves nothing over does not ring; it knows peaks that lie between samples.
  constexpr float share = 0.01f;
  const float visible = share * (high - low) * (1 + slack);
  if (fit.residual <= visible * visible) return;
  detail::AlignedBlock least, most;
  // Most are within what is shown around, which is cheaper to know than the medians there.
  if (detail::extremes_around(means.low, means.high, pixels.data(), least.data(), most.data())) {
    std::array<float, 2> whole = ends;
    if (detail::any_lonely(means.counts, least, most, pixels)) {
      // The slack on each side is in proportion to the distance from the median, so that a few
      // bright pixels beside many dark ones widen the range of the bright only.
      const float middle = detail::value_of_rank(means.low, known / 2, low, high);
      whole = {low - slack * (middle - low), high + slack * (high - middle)};
    }
    detail::clamp_around(means.low, least.data(), most.data(), means.counts.data(), slack,
                         whole.data(), pixels.data());
  }
  if (settings_.ringing == 0) return;
  OwnMeans(evidence.own_means).hold(pixels, high - low, static_cast<float>(settings_.ringing));
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
  detail::AlignedBlock good = weights_;
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
                                                         detail::AlignedBlock& out,
                                                         const PixelEvidence& evidence) const {
  PixelFinisher others(*this);
  std::array<float, max_terms> pixel_sums;
  std::copy(fit.pixel_sums.begin(), fit.pixel_sums.end(), pixel_sums.begin());
  leave_out(fit.gaps, others.weights_, pixel_sums);
  for (const Gap& gap : fit.gaps) others.add_terms(list_->row(gap.sample), -1);
  others.samples_ -= fit.gaps.size();
  others.filter_ = butterworth_factors(settings_.butterworth, others.samples_);
  for (float& weight : others.weights_) {
    if (weight < detail::least_weight) weight = 0;
  }
  others.weigh();
  others.finish_rows({fit.coefficients, pixel_sums, fit.residual}, out, evidence);
}

FREQSYNTH_INLINE std::vector<Gap> PixelFinisher::foreign_samples(
    const BlockFit& fit, const PixelEvidence& evidence) const {
  if (!settings_.residuals || evidence.constant_pixels || !fit.gaps.empty()) return {};
  return border_.foreign(fit, evidence.own_means, *list_);
}

FREQSYNTH_INLINE void PixelFinisher::finish(const BlockFit& fit, std::span<float, max_terms> out,
                                            const PixelEvidence& evidence) const {
  detail::AlignedBlock rows;
  finish_rows(fit, rows, evidence);
  detail::to_zigzag(rows, out);
}

FREQSYNTH_INLINE void PixelFinisher::finish_rows(const BlockFit& fit, detail::AlignedBlock& out,
                                                 const PixelEvidence& evidence) const {
  if (!fit.gaps.empty()) return finish_without_gaps(fit, out, evidence);
  detail::AlignedBlock filtered, rows;
  filter(fit, filtered);
  detail::to_row_major(filtered, rows);
  for (std::size_t i = 0; i < max_terms; ++i) out[i] = rows[i] * box_[i];
  if (!settings_.residuals || samples_ == 0) return;

  const auto& scale = detail::row_major_amplitudes;
  detail::AlignedBlock amplitudes, means, pixels;
  for (std::size_t i = 0; i < max_terms; ++i) amplitudes[i] = rows[i] * scale[i];
  detail::residual_means(sums_.data(), amplitudes.data(), fit.pixel_sums.data(),
                         inverse_weights_.data(), means.data());
  const bool noisy = settings_.noise == Noise::present;
  const bool measure = noisy && settings_.measure_doubt && samples_ >= max_terms;
  const double usual = noisy ? settings_.noisy_doubt : settings_.doubt;
  const auto doubt = static_cast<float>(measure ? measured_doubt(fit, filtered, means) : usual);
  for (std::size_t i = 0; i < max_terms; ++i) amplitudes[i] = out[i] * scale[i];
  detail::evaluate_rows(amplitudes, pixels);
  detail::add_means(means.data(), weights_.data(), doubt, pixels.data());
  if (detail::is_finite(settings_.slack)) bound(fit, pixels, evidence);
  if (settings_.keep_positive && evidence.positive) detail::lift_negative(pixels);
  detail::transform_to_rows(pixels, out);
}

}  // namespace freqsynth
