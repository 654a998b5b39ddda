// SPDX-License-Identifier: MIT
/// \file
/// The estimator that steers samples over nodes of a tree: kriging with one rough covariance.
///
/// The model of a channel is an unknown level, a Gaussian process with an exponential covariance,
/// whose spectrum is that of edges, and white noise. The innovation z_n of a sample
/// (basis/innovation_list.h) is what it says beyond all earlier ones, in standard deviations of a
/// process of unit scale. The mean of z_n^2 estimates the square of the scale sigma; v_n, the mean
/// variance of the averages of the node's pixels that is left after n samples, is shared by all
/// nodes. So the squared error to expect is sigma^2 v_n.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/innovation_list.h"
#include "freqsynth/basis/node_positions.h"

namespace freqsynth {

/// What the earlier samples say of the one that a row of a list is for, relative to the first one:
/// sum L_ij z_j over 0 < j < i.
/// \param innovations  of the earlier samples, 0 for the first; in memory zeros follow, to a
///                     multiple of 8
[[nodiscard]] FREQSYNTH_API float predicted_by(const InnovationRow& row, const float* innovations);

/// The innovation of that sample, from its difference to the first one.
[[nodiscard]] inline float innovation_of(const InnovationRow& row, const float* innovations,
                                         float difference) {
  return (difference - predicted_by(row, innovations)) * row.inverse_pivot;
}

/// Estimates the scale of nodes; the nodes themselves belong to the caller. Lists are
/// shared with all others of the process that need the same (shared_innovations()).
class FREQSYNTH_API KrigingRefiner {
 public:
  /// Length of the covariance, in edges of the node.
  static constexpr double length = 0.7;
  /// Variance of the noise of samples of a function without noise: what is finer than the samples.
  static constexpr double noise_of_detail = 0.003;
  /// The same of samples that are Monte Carlo estimates.
  static constexpr double noise_of_estimates = 0.3;
  /// How many samples of the node's own the scale of the nodes beside it counts for.
  static constexpr double beside = 8;

  /// \param weights  of each channel in the scale, not negative
  /// \throws std::invalid_argument when noise is not in 0..1e6.
  KrigingRefiner(const NodePositions& positions, std::vector<float> weights,
                 double noise = noise_of_detail);

  /// Values per sample.
  [[nodiscard]] std::size_t channels() const { return weights_.size(); }
  /// Weight of each channel.
  [[nodiscard]] std::span<const float> weights() const { return weights_; }
  /// The list of a class of nodes, with averages of their pixels.
  [[nodiscard]] const InnovationList& list(std::size_t of) const { return *lists_[of]; }

  /// See predicted_by(), for sample `index` of a node of a class. Builds its row, if need be.
  [[nodiscard]] float prediction(std::size_t of, std::size_t index,
                                 const float* innovations) const {
    return predicted_by(lists_[of]->row(index), innovations);
  }
  /// See innovation_of(), likewise.
  [[nodiscard]] float innovation(std::size_t of, std::size_t index, const float* innovations,
                                 float difference) const {
    return innovation_of(lists_[of]->row(index), innovations, difference);
  }
  /// v_n: mean variance of the averages of the node's pixels after n >= 1 samples, for a process of
  /// unit scale.
  [[nodiscard]] float variance(std::size_t of, std::size_t samples) const {
    return lists_[of]->row(samples - 1).variance;
  }

  /// sigma^2, the square of the scale.
  /// \param squares  sum of the squared innovations of n samples but the first, weighted
  /// \param around   mean of the scales' squares of the nodes beside it
  [[nodiscard]] static double scale(double squares, std::size_t samples, double around) {
    return (squares + beside * around) / (static_cast<double>(samples) - 1 + beside);
  }

 private:
  std::vector<float> weights_;
  std::vector<std::shared_ptr<const InnovationList>> lists_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/kriging_refiner.inl"
#endif
