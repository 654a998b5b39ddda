// SPDX-License-Identifier: MIT
/// \file
/// Priors of what a block may look like: stationary covariances of its values at two points.
///
/// A function is thought of as a level of which nothing is known, plus a stationary Gaussian
/// process of variance 1 (its scale is found from the samples), plus white noise. The exponential
/// covariance, whose spectrum falls like 1 / frequency^3, stands for edges; Matern's are smoother;
/// one that reaches farther along a direction than across it stands for an edge or for stripes that
/// run that way; one that oscillates for what repeats; one with noise for Monte Carlo estimates.
///
/// Lengths are in edges of the node, whose unit square (s, t) a block or a part of one is. So each
/// covariance serves nodes of all sizes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/config.h"

namespace freqsynth {

/// A point of a node's unit square, or of its surroundings.
struct UnitPoint {
  double s = 0;  ///< to the right; 0 and 1 are the node's borders
  double t = 0;  ///< downwards
};

/// How a covariance falls with the distance r, in units of the lengths.
enum class CovarianceShape : std::uint8_t {
  exponential,         ///< exp(-r)
  matern32,            ///< (1 + q) exp(-q), q = sqrt(3) r
  matern52,            ///< (1 + q + q^2 / 3) exp(-q), q = sqrt(5) r
  squared_exponential  ///< exp(-r^2 / 2)
};

/// A covariance, of variance 1, and the noise of samples.
struct Covariance {
  CovarianceShape shape = CovarianceShape::exponential;  ///< how it falls
  double along = 0.7;   ///< length along the direction, 0.01 to 1000
  double across = 0.7;  ///< length across it, 0.01 to 1000
  double angle = 0;     ///< of the direction, in radians from s towards t, -100 to 100
  /// Waves per unit across the direction, 0 to 16: the covariance is multiplied by the cosine of
  /// so many turns. More than 0 for matern52 and squared_exponential only.
  double frequency = 0;
  double noise = 0;  ///< variance of white noise in each sample, 0 to 1e6

  /// The same in all directions.
  static constexpr Covariance isotropic(CovarianceShape shape, double length, double noise) {
    return {shape, length, length, 0, 0, noise};
  }
  /// Longer along a direction.
  static constexpr Covariance oriented(CovarianceShape shape, double along, double across,
                                       double angle, double noise) {
    return {shape, along, across, angle, 0, noise};
  }
  /// A wave across a direction, with an envelope that is the same in all.
  static constexpr Covariance oscillating(CovarianceShape shape, double length, double frequency,
                                          double angle, double noise) {
    return {shape, length, length, angle, frequency, noise};
  }

  friend bool operator==(const Covariance&, const Covariance&) = default;
};

namespace detail {

/// exp(-x) for x >= 0, to 2 units in the last place; the same bits on all machines.
[[nodiscard]] FREQSYNTH_API double exp_minus(double x);
/// ln x for a normal x > 0, to 3 units in the last place or 1e-16; the same bits on all machines.
[[nodiscard]] FREQSYNTH_API double log_of(double x);
/// The cosine of so many turns, to 2e-16; the same bits on all machines.
[[nodiscard]] FREQSYNTH_API double cos_turns(double turns);

/// A covariance as it is evaluated: coordinates are turned and scaled so that what is left depends
/// on the distance, but for the wave.
class FREQSYNTH_API CovarianceFunction {
 public:
  /// \throws std::invalid_argument naming the field and the value when one is out of range.
  explicit CovarianceFunction(const Covariance& covariance);

  /// What it was made from.
  [[nodiscard]] const Covariance& covariance() const { return covariance_; }
  /// Covariance, without noise, of the values at two points that are `d` apart: at most 1, which it
  /// is for the same point.
  [[nodiscard]] double operator()(UnitPoint d) const;
  /// The same, to the bit, for `count` differences of points (s, t), many times faster.
  void values(const double* s, const double* t, std::size_t count, double* out) const;
  /// A difference of points in coordinates along and across, scaled such that exp(-q) is in the
  /// shape, or exp(-q^2 / 2), with q the length of the result.
  [[nodiscard]] UnitPoint scaled(UnitPoint d) const;

 private:
  Covariance covariance_;
  double cosine_, sine_;           // of the angle
  double per_along_, per_across_;  // factors of the coordinates
};

}  // namespace detail
}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/covariance.inl"
#endif
