// The part of the engine that decides which blocks deserve the next samples.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/block_neighbours.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth {

void Synthesizer::rescale() {
  double sum = 0;
  rounding_ = 0;
  const double count = static_cast<double>(std::max<std::uint64_t>(corners_, 1));
  for (std::size_t c = 0; c < settings_.channels; ++c) {
    const double mean = sums_[c] / count;
    const double mean_square = squares_[c] / count;
    // A flat first impression leaves some doubt, in proportion to the level, so that blocks stay in
    // order.
    const double least = std::max(1e-6 * mean_square, 1e-24);
    const double variance = std::max(mean_square - mean * mean, least);
    channel_variances_[c] = static_cast<float>(variance);
    sum += variance;
    rounding_ += static_cast<float>(1e-12 * mean_square) * refiner_.weights()[c];
  }
  variance_ = static_cast<float>(sum / static_cast<double>(settings_.channels));
  for (std::size_t b = 0; b < queue_.size(); ++b) {
    queue_.update(b, priority_of(static_cast<std::uint32_t>(b)));
  }
}

float Synthesizer::priority_of(std::uint32_t block) const {
  const std::uint32_t count = counts_[block];
  if (count == 0) return std::numeric_limits<float>::infinity();
  if (count >= settings_.max_samples_per_block) return BlockQueue::absent;
  if (settings_.quantization) {
    // The error falls with the number of samples; so it is worth error / samples to take one more.
    const float error = quantized_error_of(block);
    const auto allowed = static_cast<float>(settings_.quantization->allowed_error());
    const bool done = error <= allowed && count >= QuantizationTarget::least_samples;
    return done ? 0 : factors_[block] * std::max(error, allowed) / static_cast<float>(count);
  }
  if (settings_.priority.measure == PriorityMeasure::change) {
    return factors_[block] * metric_.priority(variations_[block], count, variance_);
  }
  const float residual = rounding_ + pooled(
                                         block, [&](std::uint32_t b) { return residuals_[b]; },
                                         static_cast<float>(settings_.priority.image));
  const std::size_t terms = refiner_.list().terms(count - 1);
  return factors_[block] * metric_.expected_change(residual, count, terms, variance_);
}

/// Tells the blocks beside those of the wave.
void Synthesizer::revise_neighbours() {
  const bool target = settings_.quantization.has_value();
  if (!target && settings_.priority.measure == PriorityMeasure::change) return;
  for (const std::uint32_t block : touched_) {
    // A block that gets samples hears of its neighbours then. Those that wait for long have to be
    // told when there is more to be found around them than they know.
    const float residual = residuals_[block];
    const bool more = residual > 1.25f * told_[block];
    const bool less = residual < 0.5f * told_[block];
    if (more || less) told_[block] = residual;
    if (!more && wave_size_ > 1) continue;
    neighbours().visit_beside(block, [&](std::uint32_t other) {
      // Of the blocks that meet a target only whether they still do is of interest.
      const bool revise = !target || queue_.priority(other) == 0;
      if (revise && in_wave_[other] == 0) queue_.update(other, priority_of(other));
    });
  }
}

/// Degrees of freedom of the residuals of a block.
float Synthesizer::freedom_of(std::uint32_t block) const {
  const std::uint32_t count = counts_[block];
  const std::size_t terms = count > 0 ? refiner_.list().terms(count - 1) : 0;
  return static_cast<float>(count > terms ? count - terms : 1);
}

float Synthesizer::residual_variance(std::uint32_t block, std::size_t channel) const {
  return refiner_.squared_residuals(state_of(block), channel) / freedom_of(block);
}

void Synthesizer::note_residual(std::uint32_t block) {
  float squares = 0;
  for (std::size_t c = 0; c < settings_.channels; ++c) {
    squares += refiner_.weights()[c] * refiner_.squared_residuals(state_of(block), c);
  }
  const float residual = squares / freedom_of(block);
  residual_sum_ += double{residual} - double{residuals_[block]};
  residuals_[block] = residual;
}

/// residual(block), a variance, pooled with that of the blocks beside it and, as `image` samples,
/// with that of all blocks.
template <class Residual>
float Synthesizer::pooled(std::uint32_t block, Residual&& residual, float image) const {
  float weight = freedom_of(block);
  float sum = weight * residual(block);
  float beside = 0, blocks = 0;
  neighbours().visit_beside(block, [&](std::uint32_t other) {
    beside += residual(other);
    ++blocks;
  });
  if (blocks > 0) {
    const auto neighbours = static_cast<float>(settings_.priority.neighbours);
    sum += neighbours * beside / blocks;
    weight += neighbours;
  }
  sum += image * static_cast<float>(residual_sum_ / static_cast<double>(queue_.size()));
  return sum / (weight + image);
}

float Synthesizer::quantized_error_of(std::uint32_t block) const {
  const std::uint32_t count = counts_[block];
  float error = 0;
  std::array<float, max_terms> coefficients;
  for (std::size_t c = 0; c < settings_.channels; ++c) {
    float residual = pooled(
        block, [&](std::uint32_t b) { return residual_variance(b, c); }, 0);
    if (!settings_.noisy) residual *= evenness(count);
    residual += metric_.uncertainty(count, channel_variances_[c]);
    refiner_.coefficients(state_of(block), count, c, coefficients);
    error += quantized_error(settings_.quantization->steps[c], coefficients,
                             refiner_.list().variances(count - 1), residual);
  }
  return error;
}

}  // namespace freqsynth
