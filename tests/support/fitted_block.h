// SPDX-License-Identifier: MIT
/// \file
/// One block that has been fit, and its finished pixels.
#pragma once

#include <array>
#include <cstddef>
#include <functional>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/refine/least_squares_refiner.h"

namespace freqsynth::helpers {

/// A hard edge across the block, which no band-limited function holds.
inline double edge(double s, double t) { return s + 0.37 * t < 0.61 ? 1.0 : 0.0; }

/// How much a sample counts for a pixel: half on a border of the pixel, half of that on one of the
/// block.
inline double weight_in_pixel(const SequencePosition& p, std::size_t pixel) {
  const auto share = [](double x, std::size_t at) {
    const auto low = static_cast<double>(at);
    return x < low || x > low + 1 ? 0.0 : x == low || x == low + 1 ? 0.5 : 1.0;
  };
  const bool border = p.s == 0 || p.s == 1 || p.t == 0 || p.t == 1;
  return share(8 * p.s, pixel % 8) * share(8 * p.t, pixel / 8) * (border ? 0.5 : 1);
}

/// A block after `samples` samples of edge(), or of another function of position and number.
struct FittedBlock {
  explicit FittedBlock(
      std::size_t samples,
      const std::function<double(const SequencePosition&, std::size_t)>& function =
          [](const SequencePosition& p, std::size_t) { return edge(p.s, p.t); })
      : refiner(list, 1), state(refiner.state_size()) {
    refiner.reset(state.data());
    for (std::size_t n = 0; n < samples; ++n) {
      const auto value = static_cast<float>(function(list->position(n), n));
      refiner.absorb(state.data(), n, &value);
    }
    refiner.coefficients(state.data(), samples, 0, coefficients);
    const std::size_t terms = list->terms(samples - 1);
    residual = refiner.squared_residuals(state.data(), 0) /
               static_cast<float>(samples > terms ? samples - terms : 1);
  }

  /// Finished pixels.
  [[nodiscard]] std::array<float, max_terms> finished(std::size_t samples,
                                                      const FinishSettings& settings,
                                                      const PixelEvidence& evidence = {}) const {
    PixelFinisher finisher(list, settings);
    finisher.advance(samples);
    std::array<float, max_terms> out{}, pixels{};
    finisher.finish({coefficients, refiner.pixel_sums(state.data(), 0), residual}, out, evidence);
    inverse_dct(out, pixels);
    return pixels;
  }

  SharedInverseList list = SharedInverseList({.positions = SamplePositions::lattice});
  LeastSquaresRefiner refiner;
  detail::AlignedVector<float> state;
  std::array<float, max_terms> coefficients{};
  float residual = 0;
};

}  // namespace freqsynth::helpers
