// SPDX-License-Identifier: MIT
/// \file
/// In what unit the errors of blocks are compared where it is not the signal's own: relative to
/// what a block shows, or as a display shows them.
///
/// Both are functions g of the signal, which errors pass through: an error e at the value v is
/// seen as g'(v) e. A block shows many values, and its errors lie between them, at edges; so g' is
/// the slope of the chord of g over the block's mean plus and minus its standard deviation. A
/// residual R is then at most a quarter of the square of g's range, whatever the values are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/engine/seen_value.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// What a squared error of each block is worth in squared units of g.
class Steering {
 public:
  /// Steer::linear: errors are worth what they are, and nothing below is needed.
  Steering() = default;
  /// \param settings  in range
  /// \param noisy     the sampler returns Monte Carlo estimates: what their fit leaves over is
  ///                  noise, not values that the block shows
  /// \param weights   weight of each channel in the host's unit
  Steering(const PrioritySettings& settings, bool noisy, std::vector<float> weights,
           std::size_t blocks);

  /// Whether all is as it would be without steering.
  [[nodiscard]] bool linear() const { return steer_ == Steer::linear; }
  /// Whether anything is known: once every block has had a sample.
  [[nodiscard]] bool settled() const { return settled_; }

  /// A block has taken in `taken` >= 1 samples. \return whether they settled the steering: then all
  /// blocks are worth something else. Does not allocate.
  template <Refiner R>
  bool absorbed(const BlockStore<R>& blocks, std::uint32_t block, std::size_t taken = 1);

  /// The sampler turns out to return Monte Carlo estimates: as if it had been known.
  template <Refiner R>
  void notice_noise(const BlockStore<R>& blocks) {
    noisy_ = true;
    if (!settled_) return;
    for (std::uint32_t block = 0; block < blocks.size(); ++block) look_at(blocks, block);
  }

  /// A residual in squared units of g, weighted over the channels.
  /// \param residual  residual(c): that of a channel, in its unit
  template <Refiner R, class Residual>
  [[nodiscard]] float residual(const BlockStore<R>& blocks, std::uint32_t block,
                               Residual&& residual) const;
  /// The same of a squared change that is already weighted over the channels: it is taken to be
  /// spread over them as the residuals are.
  template <Refiner R>
  [[nodiscard]] float change(const BlockStore<R>& blocks, std::uint32_t block, float change) const;

  /// Variance of g over the image, weighted over the channels.
  [[nodiscard]] float variance() const { return variance_; }
  /// Residuals below this one are float's rounding.
  [[nodiscard]] float rounding() const { return 1e-12f * weight_; }
  /// Factor on the priority of a block that has so many samples per pixel. Evenly spread samples of
  /// a function without noise tell more than independent ones: where residuals are large, less is
  /// left to gain than they say, and the blocks that have the largest, at edges between bright and
  /// dark, would take what is seen elsewhere.
  [[nodiscard]] float gain(float samples_per_pixel) const {
    return noisy_ || samples_per_pixel <= 1 ? 1 : 1 / samples_per_pixel;
  }

 private:
  friend struct StateArchive;

  [[nodiscard]] double seen(double value, std::size_t channel) const {
    return detail::seen_value(steer_, value, levels_[channel], exposure_);
  }
  // The largest variance of g, of values of which half are at either end.
  [[nodiscard]] float most() const { return steer_ == Steer::display ? 0.25f * weight_ : 1e31f; }
  template <Refiner R>
  static double mean(const BlockStore<R>& blocks, std::size_t block, std::size_t channel,
                     std::array<float, max_terms>& coefficients);
  template <Refiner R>
  void settle(const BlockStore<R>& blocks);
  template <Refiner R>
  void set_level(const BlockStore<R>& blocks, std::size_t channel);
  template <Refiner R>
  double variance_of(const BlockStore<R>& blocks, std::size_t channel) const;
  template <Refiner R>
  void look_at(const BlockStore<R>& blocks, std::uint32_t block);

  Steer steer_ = Steer::linear;
  double exposure_ = 1;
  bool noisy_ = false;
  bool settled_ = false;
  std::vector<float> weights_;
  float weight_ = 0;             // of all channels
  std::vector<double> slopes_;   // g'^2 of each block and channel, in the host's unit
  std::vector<double> levels_;   // of each channel
  std::vector<double> medians_;  // room to find one
  float variance_ = 0;
};

// ------------------------------------------------------------------------------------ definitions

inline Steering::Steering(const PrioritySettings& settings, bool noisy, std::vector<float> weights,
                          std::size_t blocks)
    : steer_(settings.steer), exposure_(settings.exposure), noisy_(noisy) {
  if (linear()) return;
  weights_ = std::move(weights);
  for (const float weight : weights_) weight_ += weight;
  slopes_.resize(blocks * weights_.size());
  levels_.assign(weights_.size(), 1.0);
  medians_.resize(blocks);
}

template <Refiner R>
bool Steering::absorbed(const BlockStore<R>& blocks, std::uint32_t block, std::size_t taken) {
  if (!settled_) {
    if (blocks.untouched() != 0) return false;
    settle(blocks);
    return true;
  }
  // What a block shows changes little once it is known.
  const std::size_t samples = blocks.samples(block);
  const std::size_t step = samples < 16 ? 1 : samples < 64 ? 4 : 16;
  if (samples / step != (samples - taken) / step) look_at(blocks, block);
  return false;
}

/// Mean of a channel of a block in the host's unit; writes its coefficients.
template <Refiner R>
double Steering::mean(const BlockStore<R>& blocks, std::size_t block, std::size_t channel,
                      std::array<float, max_terms>& coefficients) {
  blocks.coefficients(block, channel, coefficients);
  return std::ldexp(double{coefficients[0]} / block_size, blocks.exponent(channel));
}

template <Refiner R>
void Steering::settle(const BlockStore<R>& blocks) {
  settled_ = true;
  double sum = 0;
  for (std::size_t c = 0; c < weights_.size(); ++c) {
    if (weights_[c] == 0) continue;
    if (steer_ == Steer::relative) set_level(blocks, c);
    sum += double{weights_[c]} * variance_of(blocks, c);
  }
  // Where no channel counts, the number of samples does.
  variance_ = weight_ > 0 ? static_cast<float>(sum) : 1.0f;
  for (std::uint32_t block = 0; block < blocks.size(); ++block) look_at(blocks, block);
}

/// Not the mean, which a single lamp may dominate.
template <Refiner R>
void Steering::set_level(const BlockStore<R>& blocks, std::size_t channel) {
  std::array<float, max_terms> coefficients;
  auto end = medians_.begin();
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const double size = std::abs(mean(blocks, block, channel, coefficients));
    if (size > 0) *end++ = size;
  }
  if (end == medians_.begin()) return;
  const auto middle = medians_.begin() + (end - medians_.begin()) / 2;
  std::nth_element(medians_.begin(), middle, end);
  levels_[channel] = *middle / detail::levels_of_median;
}

/// Of what the blocks' means are seen as.
template <Refiner R>
double Steering::variance_of(const BlockStore<R>& blocks, std::size_t channel) const {
  std::array<float, max_terms> coefficients;
  double values = 0, squares = 0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const double value = seen(mean(blocks, block, channel, coefficients), channel);
    values += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(blocks.size());
  const double square = squares / count;
  // A flat first impression leaves some doubt, see SignalStatistics.
  constexpr double doubt = 1e-6, least = 1e-24;
  return std::max({square - values / count * (values / count), doubt * square, least});
}

namespace detail {

/// Sum of the squares of all coefficients but F(0,0), in an order that compilers can vectorise.
inline float energy(const std::array<float, max_terms>& coefficients) {
  std::array<float, 8> sums{};
  for (std::size_t i = 8; i < max_terms; ++i) sums[i % 8] += coefficients[i] * coefficients[i];
  float sum = 0;
  for (std::size_t i = 1; i < 8; ++i) sum += coefficients[i] * coefficients[i];
  for (const float part : sums) sum += part;
  return sum;
}

}  // namespace detail

/// Sets the slopes of a block.
template <Refiner R>
void Steering::look_at(const BlockStore<R>& blocks, std::uint32_t block) {
  std::array<float, max_terms> coefficients;
  for (std::size_t c = 0; c < weights_.size(); ++c) {
    if (weights_[c] == 0) continue;
    const double middle = mean(blocks, block, c, coefficients);
    const double share = double{blocks.freedom(block)} / std::max(blocks.samples(block), 1u);
    double square = noisy_ ? 0 : double{blocks.residual(block, c)} * std::min(share, 1.0);
    square += double{detail::energy(coefficients)} / max_terms;
    const double reach = std::ldexp(std::sqrt(square), blocks.exponent(c));
    const double slope = detail::seen_slope(steer_, middle, reach, levels_[c], exposure_);
    slopes_[block * weights_.size() + c] = slope * slope;
  }
}

template <Refiner R, class Residual>
float Steering::residual(const BlockStore<R>& blocks, std::uint32_t block,
                         Residual&& residual) const {
  double sum = 0;
  for (std::size_t c = 0; c < weights_.size(); ++c) {
    if (weights_[c] == 0) continue;
    sum += double{weights_[c]} * slopes_[block * weights_.size() + c] *
           std::ldexp(double{residual(c)}, 2 * blocks.exponent(c));
  }
  // As of a sum of squares of all samples, over the degrees of freedom.
  const float share = static_cast<float>(blocks.samples(block)) / blocks.freedom(block);
  return static_cast<float>(std::min(sum, double{most() * share}));
}

template <Refiner R>
float Steering::change(const BlockStore<R>& blocks, std::uint32_t block, float change) const {
  double own = 0, weighted = 0;
  for (std::size_t c = 0; c < weights_.size(); ++c) {
    if (weights_[c] == 0) continue;
    const double residual = double{blocks.residual(block, c)} + 1e-24;
    own += double{blocks.refiner().weights()[c]} * residual;
    weighted += double{weights_[c]} * slopes_[block * weights_.size() + c] *
                std::ldexp(residual, 2 * blocks.exponent(c));
  }
  if (!(own > 0)) return 0;
  return static_cast<float>(std::min(double{change} * (weighted / own), double{most()}));
}

}  // namespace freqsynth
