#include "freqsynth/pixel_finisher.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "freqsynth/dct.h"
#include "freqsynth/detail/kernels.h"

namespace freqsynth {

void FinishSettings::validate() const {
  butterworth.validate();
  if (!(doubt >= 0 && std::isfinite(doubt))) {
    throw std::invalid_argument("freqsynth: doubt is " + std::to_string(doubt) +
                                ", not a finite number >= 0");
  }
}

PixelFinisher::PixelFinisher(std::shared_ptr<const InverseList> list,
                             const FinishSettings& settings)
    : list_(std::move(list)), settings_(settings), sums_(max_terms) {
  settings.validate();
  if (!list_) throw std::invalid_argument("freqsynth: the inverse list is null");
  for (std::size_t i = 0; i < max_terms; ++i) {
    box_[i] = static_cast<float>(pixel_mean_of_term(i));
    weights_[i] = shares_[i] = 0;
  }
  for (Row& row : sums_) std::fill_n(row.values, max_terms, 0.0f);
  filter_ = butterworth_factors(settings_.butterworth, 0);
}

void PixelFinisher::advance(std::size_t samples) {
  FREQSYNTH_ASSERT(samples >= samples_);
  if (samples == samples_) return;
  for (; samples_ < samples; ++samples_) {
    const detail::SampleRow& row = list_->row(samples_);
    for (std::size_t p = 0; p < row.pixel_count; ++p) {
      const std::size_t pixel = row.pixels[p];
      weights_[pixel] += row.pixel_weight;
      float* sums = sums_[pixel].values;
      for (std::size_t i = 0; i < max_terms; ++i) {
        sums[detail::zigzag_to_row_major[i]] += row.pixel_weight * (row.fit[i] + row.rest[i]);
      }
    }
  }
  filter_ = butterworth_factors(settings_.butterworth, samples);
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    const float weight = weights_[pixel];
    shares_[pixel] = weight > 0 ? 1 / (weight + static_cast<float>(settings_.doubt)) : 0;
  }
}

void PixelFinisher::finish(std::span<const float, max_terms> coefficients,
                           std::span<const float, max_terms> pixel_sums,
                           std::span<float, max_terms> out) const {
  std::array<float, max_terms> filtered;
  for (std::size_t i = 0; i < max_terms; ++i) filtered[i] = coefficients[i] * filter_[i];
  if (!settings_.residuals) {
    for (std::size_t i = 0; i < max_terms; ++i) out[i] = filtered[i] * box_[i];
    return;
  }
  Row amplitudes, residuals, sums;
  for (std::size_t i = 0; i < max_terms; ++i) {
    amplitudes.values[detail::zigzag_to_row_major[i]] =
        filtered[i] * static_cast<float>(amplitude_of_coefficient(i));
    sums.values[i] = pixel_sums[i];
  }
  detail::residual_means(sums_[0].values, amplitudes.values, sums.values, shares_.data(),
                         residuals.values);
  forward_dct(residuals.values, out);
  for (std::size_t i = 0; i < max_terms; ++i) out[i] += filtered[i] * box_[i];
}

}  // namespace freqsynth
