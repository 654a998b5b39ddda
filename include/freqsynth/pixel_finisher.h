/// \file
/// From the fit of a block to finished pixels: beyond the paper, what the fit leaves over is not
/// thrown away.
///
/// A band-limited function cannot hold an edge, so the error of the paper's estimate stops falling
/// at a few samples per pixel. Here the fit is a control variate: a pixel's mean is the exact mean
/// of the filtered fit plus the average of (sample - fit) over the pixel's own samples, shrunk
/// while they are few. That converges to the true mean.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/butterworth.h"
#include "freqsynth/config.h"
#include "freqsynth/inverse_list.h"

namespace freqsynth {

struct FinishSettings {
  ButterworthSettings butterworth = {};
  bool residuals = true;  ///< false: the paper's estimate, the mean of the filtered fit alone
  /// A pixel's residuals with a total weight of w samples count w / (w + doubt). Finite and >= 0.
  double doubt = 0.5;

  /// \throws std::invalid_argument naming the field and the value when out of range.
  void validate() const;
};

/// Finishes blocks, those with fewer samples first. What depends on positions alone, the sum over
/// each pixel's samples of every term, is shared by all blocks with the same number of samples.
class PixelFinisher {
 public:
  /// \throws std::invalid_argument when a setting is out of range or the list is null.
  PixelFinisher(std::shared_ptr<const InverseList> list, const FinishSettings& settings);

  /// Goes on to blocks with `samples` samples; not less than before.
  void advance(std::size_t samples);

  /// Coefficients of finished pixels (CoefficientMeaning::pixel_average).
  /// \param coefficients  of the fit, F in zig-zag order
  /// \param pixel_sums    LeastSquaresRefiner::pixel_sums() of the same block
  void finish(std::span<const float, max_terms> coefficients,
              std::span<const float, max_terms> pixel_sums, std::span<float, max_terms> out) const;

 private:
  std::shared_ptr<const InverseList> list_;
  FinishSettings settings_;
  std::size_t samples_ = 0;
  std::array<float, max_terms> box_;      // mean over a pixel of each term, relative to its centre
  std::array<float, max_terms> filter_;   // Butterworth factors
  std::array<float, max_terms> weights_;  // samples of each pixel
  alignas(32) std::array<float, max_terms> shares_;  // 1 / (weight + doubt), 0 without samples
  struct alignas(32) Row {
    float values[max_terms];
  };
  std::vector<Row>
      sums_;  // [pixel][row-major term]: weighted sum of the term over the pixel's samples
};

}  // namespace freqsynth
