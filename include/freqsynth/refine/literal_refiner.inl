// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/refine/literal_refiner.h"

namespace freqsynth {

FREQSYNTH_INLINE void LiteralRefiner::absorb(double value) {
  const SequencePosition& position = list_->position(samples_);
  double a[max_terms];
  evaluate_terms(position.s, position.t, a);
  for (std::size_t i = 0; i < max_terms; ++i) y_[i] += value * a[i];
  terms_ = list_->terms(samples_);
  const double* row = list_->inverse(samples_).data();
  for (std::size_t i = 0; i < terms_; ++i) {
    // One triangle serves both halves of the product.
    double sum = 0;
    for (std::size_t j = 0; j < i; ++j) {
      sum += row[j] * y_[j];
      x_[j] += row[j] * y_[i];
    }
    x_[i] = sum + row[i] * y_[i];
    row += i + 1;
  }
  ++samples_;
}

}  // namespace freqsynth
