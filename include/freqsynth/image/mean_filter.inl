// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "freqsynth/image/mean_filter.h"

namespace freqsynth::detail {

/// Weights of averages in one filtered pixel.
///
/// The sum of the averages m up to a place is a cubic spline with second derivatives M at the knots
/// between pixels: M_{i-1} + 4 M_i + M_{i+1} = 6 (m_i - m_{i-1}), and 0 at both ends. The function,
/// its derivative, is m_i + M_i (1 - 3 (1 - t)^2) / 6 + M_{i+1} (3 t^2 - 1) / 6 in pixel i, with t
/// from 0 to 1. So a filtered pixel is a sum of m and M, and M a sum of m.
class MeanWeights {
 public:
  /// \param begin   first pixel that the filter reaches
  /// \param end     behind the last one
  /// \param centre  of the filter, and `scale` pixels of the output per pixel
  void compute(std::size_t size, std::size_t begin, std::size_t end, double centre, double scale,
               const FilterKernel& kernel) {
    // M tells of pixels far away, with a factor of -0.27 for each step.
    constexpr std::size_t far = 28;
    first_ = begin > far ? begin - far : 0;
    const std::size_t last = std::min(size, end + far);
    weights_.assign(last - first_, 0);
    knots_.assign(last - first_ + 1, 0);
    for (std::size_t i = begin; i < end; ++i) {
      const auto left = static_cast<double>(i);
      kernel.visit_nodes((left - centre) * scale, (left + 1 - centre) * scale, 0,
                         [&](double at, double weight) {
                           const double t = at / scale + centre - left;
                           weights_[i - first_] += weight;
                           knots_[i - first_] += weight * (1 - 3 * (1 - t) * (1 - t)) / 6;
                           knots_[i + 1 - first_] += weight * (3 * t * t - 1) / 6;
                         });
    }
    solve();
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      weights_[i] += 6 * (knots_[i] - knots_[i + 1]);
      sum += weights_[i];
    }
    for (double& weight : weights_) weight /= sum;
    trim();
  }

  [[nodiscard]] std::size_t first() const { return first_; }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }

 private:
  /// Solves y_{i-1} + 4 y_i + y_{i+1} = knots_[i] between both ends, where y is 0.
  void solve() {
    const std::size_t end = knots_.size() - 1;
    factors_.assign(end + 1, 0);
    knots_[0] = knots_[end] = 0;
    for (std::size_t i = 1; i < end; ++i) {
      factors_[i] = 1 / (4 - factors_[i - 1]);
      knots_[i] = (knots_[i] - knots_[i - 1]) * factors_[i];
    }
    for (std::size_t i = end; i-- > 1;) knots_[i] -= factors_[i] * knots_[i + 1];
  }

  void trim() {
    const auto counts = [](double weight) { return std::abs(weight) >= 1e-8; };
    const auto begin = std::find_if(weights_.begin(), weights_.end(), counts);
    first_ += static_cast<std::size_t>(begin - weights_.begin());
    weights_.erase(weights_.begin(), begin);
    while (!counts(weights_.back())) weights_.pop_back();
  }

  std::size_t first_ = 0;
  std::vector<double> weights_, knots_, factors_;
};

FREQSYNTH_INLINE MeanAxis make_mean_axis(std::size_t size, std::size_t out,
                                         const FilterKernel& kernel) {
  const double scale = static_cast<double>(out) / static_cast<double>(size);
  const auto clamped = [&](double at) {
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  std::vector<std::vector<double>> weights(out);
  MeanWeights one;
  MeanAxis axis;
  for (std::size_t p = 0; p < out; ++p) {
    const double centre = (static_cast<double>(p) + 0.5) / scale;
    // What is reached by a rounding error only is not reached.
    const auto around = [&](double radius) {
      const std::size_t first = clamped(std::floor(centre - radius + 1e-9));
      return std::pair(first, std::max(first + 1, clamped(std::ceil(centre + radius - 1e-9))));
    };
    const double radius = kernel.radius() / scale;
    const auto reached = around(radius);
    const auto range = around(std::max(1.0, radius));
    one.compute(size, reached.first, reached.second, centre, scale, kernel);
    weights[p] = one.weights();
    axis.pixels.push_back(
        {one.first(), weights[p].size(), range.first, range.second - range.first});
    axis.stride = std::max(axis.stride, (weights[p].size() + 7) / 8 * 8);
  }
  axis.weights.assign(out * axis.stride, 0);
  for (std::size_t p = 0; p < out; ++p) {
    std::transform(weights[p].begin(), weights[p].end(), axis.weights.data() + p * axis.stride,
                   [](double weight) { return static_cast<float>(weight); });
  }
  return axis;
}

/// A line of averages that have been filtered along the other axis, and their range.
struct MeanLine {
  std::vector<float> sums, least, most;

  void compute(const float* means, std::size_t width, const MeanAxis::Reach& reach,
               const float* weights, bool bounded) {
    std::fill(sums.begin(), sums.end(), 0.0f);
    for (std::size_t k = 0; k < reach.count; ++k) {
      const float* const row = means + (reach.first + k) * width;
      const float weight = weights[k];
      for (std::size_t x = 0; x < width; ++x) sums[x] += weight * row[x];
    }
    if (!bounded) return;
    const float* const first = means + reach.range_first * width;
    std::copy(first, first + width, least.begin());
    most = least;
    for (std::size_t k = 1; k < reach.range_count; ++k) {
      const float* const row = first + k * width;
      for (std::size_t x = 0; x < width; ++x) least[x] = std::min(least[x], row[x]);
      for (std::size_t x = 0; x < width; ++x) most[x] = std::max(most[x], row[x]);
    }
  }
};

/// Eight sums side by side, in an order that does not depend on the instruction set.
inline float weighted_sum(const float* values, const float* weights, std::size_t count) {
  float sums[8] = {};
  for (std::size_t k = 0; k < count; k += 8) {
    for (std::size_t lane = 0; lane < 8; ++lane) {
      sums[lane] += values[k + lane] * weights[k + lane];
    }
  }
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

FREQSYNTH_INLINE void filter_means(const float* means, std::size_t width, const MeanAxis& columns,
                                   const MeanAxis& rows, bool bounded, const PixelView& out) {
  MeanLine line;
  line.sums.resize(width + columns.stride);  // weights of 0 may lie beyond the last average
  line.least.resize(bounded ? width : 0);
  line.most.resize(bounded ? width : 0);
  for (std::size_t y = 0; y < out.height; ++y) {
    line.compute(means, width, rows.pixels[y], rows.weights.data() + y * rows.stride, bounded);
    float* to = out.data + static_cast<std::ptrdiff_t>(y) * out.row_stride;
    for (std::size_t x = 0; x < out.width; ++x, to += out.pixel_stride) {
      const MeanAxis::Reach& reach = columns.pixels[x];
      float value = weighted_sum(line.sums.data() + reach.first,
                                 columns.weights.data() + x * columns.stride, columns.stride);
      if (bounded) {
        const auto from = static_cast<std::ptrdiff_t>(reach.range_first);
        const auto end = static_cast<std::ptrdiff_t>(reach.range_first + reach.range_count);
        const float least = *std::min_element(line.least.begin() + from, line.least.begin() + end);
        const float most = *std::max_element(line.most.begin() + from, line.most.begin() + end);
        value = std::min(std::max(value, least), most);
      }
      *to = value;
    }
  }
}

}  // namespace freqsynth::detail
