// SPDX-License-Identifier: MIT
/// \file
/// The hot kernels, compiled once per instruction set; which of them the processor can run is found
/// out once, at run time. Every version adds in the same order and none fuses multiply and add, so
/// all give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "freqsynth/basis/config.h"

namespace freqsynth::detail {

/// Shared data to add one term to a block's state (eq. 37), rounded to float for the hot path.
struct alignas(64) BorderRow {
  float b[max_terms] = {};     ///< B of eq. 36, zero beyond the terms in the fit
  float step[max_terms] = {};  ///< amplitudes per unit of the new one: -J^-1 B, 1
  float inverse_delta = 0;     ///< 1 / Delta of eq. 37
  float change = 0;            ///< mean squared pixel change caused by `step`
  float cross = 0;             ///< mean product of the pixel changes caused by `gain` and by `step`
  /// Delta of eq. 37: what the new term's square takes off the squared residuals.
  float delta = 0;
};

/// Shared data to absorb the sample of one sequence index, rounded to float for the hot path.
struct alignas(64) SampleRow {
  float fit[max_terms] = {};  ///< term values at the position (eq. 28), zero beyond the fit
  /// What a state gains: within the fit k = J^-1 A, per unit of the innovation; beyond it the term
  /// values, per unit of the sample.
  float gain[max_terms] = {};
  const BorderRow* border = nullptr;  ///< not null when a term is added after this sample
  std::uint32_t terms = 0;            ///< terms in the fit while the sample is absorbed
  float change = 0;                   ///< mean squared pixel change caused by `gain`
  float residual = 0;                 ///< 1 - A . k: share of the innovation that remains
  float pixel_weights[4] = {};   ///< share of the sample that each of its pixels gets, 0 for none
  std::uint8_t pixel_count = 0;  ///< pixels of the block that get a share of the sample, up to 4
  std::uint8_t pixels[4] = {};   ///< those pixels, row by row; beyond them any
  /// The pixel that the sample lies in; none on the border between pixels.
  std::uint8_t own_pixel = no_pixel;
  float own_share = 0;  ///< 1 / number of the earlier samples with the same own pixel, 0 for none

  /// No pixel.
  static constexpr std::uint8_t no_pixel = max_terms;

  /// Value of a term at the position.
  [[nodiscard]] float term(std::size_t i) const { return i < terms ? fit[i] : gain[i]; }
};

/// Absorbs samples that follow each other into the states of all channels of a block.
///
/// A state is 64 floats, aligned to 32 bytes: the amplitudes X of the terms in the fit and, beyond
/// them, the right-hand sides Y (eq. 23) of the terms that are not yet in it.
/// \param rows      `count` of them
/// \param states    channels x 64 floats
/// \param sums      channels x 128 floats: for each pixel the weighted sum of its samples, and then
///                  for each pixel the sum of those that are its own
/// \param residuals channels x 2 floats, kept up to date: the sum of squared residuals of the fit,
///                  and the greatest difference between a sample and the mean of the earlier ones
///                  that its pixel owns
/// \param values    count x channels finite values; null to absorb the block's own predictions
///                  instead
/// \param weights   per channel: its weight in the result
/// \param changes   receives for each sample the weighted sum over channels of the mean squared
///                  change of the block's pixels
using AbsorbSamples = void(const SampleRow* rows, std::size_t count, float* states, float* sums,
                           float* residuals, const float* values, const float* weights,
                           std::size_t channels, float* changes);

/// Powell's rank-one update, eqs. 29 and 33, of row-major matrices with a row stride of 64, aligned
/// to 64 bytes. The leading terms x terms part of `inverse` is updated, and the leading
/// normal_terms x normal_terms part of `normal`. Entries of `inverse` beyond `terms` must be zero,
/// and those of `normal` beyond `normal_terms` finite. `a` holds normal_terms values;
/// 1 <= terms <= normal_terms <= 64.
using RankOneUpdate = void(double* inverse, double* normal, const double* a, std::size_t terms,
                           std::size_t normal_terms);

/// M += scale x x^T for the leading terms x terms part of a row-major matrix with a row stride of
/// 64, aligned to 32 bytes. x is aligned to 32 bytes and padded with zeros to a multiple of 4
/// values.
using AddOuterProduct = void(double* matrix, const double* x, double scale, std::size_t terms);

/// out = M x for the leading terms x terms part of a row-major matrix with a row stride of 64,
/// aligned to 32 bytes, entries beyond `terms` zero. terms is 1..64.
using Multiply = void(const double* matrix, const double* x, std::size_t terms, double* out);

/// out(j) = (sums(j) - row j of `matrix` . amplitudes) * shares(j) for 64 rows of 64 floats.
/// Rows of 16 amplitudes at the end that are all zero take no time. All arrays but `sums` are
/// aligned to 64 bytes.
using ResidualMeans = void(const float* matrix, const float* amplitudes, const float* sums,
                           const float* shares, float* out);

/// Separable evaluation of a block: pixels(r, c) = sum_v wy(r, v) sum_u amplitudes(v, u) wx(u, c).
/// \param amplitudes 8 x 8, row-major (v, u), aligned to 32 bytes
/// \param wx    8 rows (u) of `wx_stride` floats, aligned to 32 bytes; columns is a multiple of 8
/// \param wy    `rows` rows of 8 floats (v)
/// \param out   rows x columns floats with a row stride of `out_stride`, aligned to 32 bytes
using EvaluateSeparable = void(const float* amplitudes, const float* wx, std::size_t wx_stride,
                               std::size_t columns, const float* wy, std::size_t rows, float* out,
                               std::size_t out_stride);

/// A number for each pixel of a block, with room around each row.
struct alignas(64) PaddedBlock {
  /// Greater than any number of a pixel.
  static constexpr float none = 3.402823466e+38f;
  static constexpr std::size_t first = 8;    ///< place of the first pixel
  static constexpr std::size_t stride = 16;  ///< from a row to the next

  float values[first + block_size * stride];  ///< in each row pixels 0 .. 7, and on both sides one
};

/// sums(i) += factor * values(i), anywhere in memory.
using AddScaled = void(const double* values, double factor, std::size_t count, double* sums);

/// Solves four symmetric positive definite systems at once by Cholesky's factors, in place. Each
/// number is there four times, side by side, once for each system.
/// \param matrix    n x n numbers, of which the lower triangle counts; aligned to 32 bytes, like all
/// \param right     n rows of `sides` numbers: the right sides, which become the solutions
/// \param definite  receives 1 for each system that is positive definite, 0 for others, whose
///                  solutions are none
using SolveFour = void(double* matrix, double* right, std::size_t n, std::size_t sides,
                       double* definite);

/// Eq. 1: pixels, row by row, to coefficients, row-major (v, u), in double.
/// \param cosines  cos(pi u (x + 1/2) / 8), row-major (x, u), aligned to 64 bytes like `scales`
/// \param scales   factor of each coefficient, row-major (v, u)
using ForwardTransform = void(const float* pixels, const double* cosines, const double* scales,
                              float* out);

// What PixelFinisher does with 64 numbers; all but coefficients and variances are aligned to 32
// bytes.

/// out = coefficient * filter * max(0, 1 - scale * variance / coefficient^2).
using ShrinkTerms = void(const float* coefficients, const float* filter, const float* variances,
                         float scale, float* out);
/// pixel += mean * weight / (weight + doubt), where there is weight.
using AddMeans = void(const float* means, const float* weights, float doubt, float* pixels);
/// sum * share where share is not 0. Elsewhere, and around: greater than any number in `low`, less
/// than any in `high`.
using KnownMeans = void(const float* sums, const float* shares, PaddedBlock& low,
                        PaddedBlock& high);
/// sum / count where count is not 0, PaddedBlock::none elsewhere; and into `ends` the least and the
/// greatest of these quotients, PaddedBlock::none and its negative without any.
using OwnedMeans = void(const float* sums, const float* counts, float* out, float* ends);
/// Writes the least of `low` and the greatest of `high`.
using LeastAndMost = void(const PaddedBlock& low, const PaddedBlock& high, float* out);
/// The value that `rank` of the 64 are less than, or equal to it and before it; between least and
/// most.
using ValueOfRank = float(const PaddedBlock& values, std::size_t rank, float least, float most);
/// Writes for each pixel the least of `low` and the greatest of `high` among it and its neighbours.
/// \return whether any pixel lies outside
using ExtremesAround = bool(const PaddedBlock& low, const PaddedBlock& high, const float* pixels,
                            float* least, float* most);
/// Clamps pixels that lie outside to that range, widened on each side by `slack` times the distance
/// from the median; where `counts`, how many are known of each 3 x 3, is less than 4, to `whole`.
using ClampAround = void(const PaddedBlock& low, const float* least, const float* most,
                         const float* counts, float slack, const float* whole, float* pixels);
/// See OwnMeans::hold(). `means` are 10 rows; they and the pixels lie anywhere in memory.
/// \param alike     greatest difference of means that are the same
/// \param most_off  greatest difference of a pixel that is held if not all around are the same
using HoldFlat = void(const float* means, std::size_t stride, float alike, float most_off,
                      float* pixels);

// Blocks side by side: number i of each of 48 is at i * lane_count + lane, aligned to 64 bytes.

/// Lanes of the two kernels below.
inline constexpr std::size_t lane_count = 48;
/// Innovation `count` of each lane (basis/innovation_list.h) from its value and the innovations
/// before it, behind which it is written:
/// z_count = (value - sum_j factor(j) z_j) * inverse_pivot, added from the first to the last.
using InnovateLanes = void(const float* factor, std::size_t count, float inverse_pivot,
                           const float* values, float* innovations);
/// sums(p) += weights(p) * value, for `count` sums of each lane.
using AddLanes = void(const float* weights, std::size_t count, const float* values, float* sums);

/// exp(-x) of each of `count` numbers from 0 on, exp_minus() to the bit; `out` may be `x`.
using Exponentials = void(const double* x, std::size_t count, double* out);
/// cos_turns() of each of `count` numbers below 2^30, to the bit; `out` may be `turns`.
using Cosines = void(const double* turns, std::size_t count, double* out);
/// Terms of the series below.
inline constexpr std::size_t flux_series = 16;
/// The integral of a covariance over the disc of radius q (box_covariance.h), by 2 pi q^2, for
/// `count` distances q. Below 0.7 it is sum series(k) q^k.
/// \param rough  whether the covariance is exp(-q), and not (1 + q) exp(-q)
using FluxDensities = void(const double* distances, std::size_t count, const double* series,
                           bool rough, double* out);

/// One version of all kernels.
struct Kernels {
  const char* name;  ///< "plain", "avx2" or "avx512"
  AbsorbSamples* absorb_samples;
  RankOneUpdate* rank_one_update;
  AddOuterProduct* add_outer_product;
  Multiply* multiply;
  ResidualMeans* residual_means;
  EvaluateSeparable* evaluate_separable;
  AddScaled* add_scaled;
  SolveFour* solve_four;
  ForwardTransform* forward_transform;
  ShrinkTerms* shrink_terms;
  AddMeans* add_means;
  KnownMeans* known_means;
  OwnedMeans* owned_means;
  LeastAndMost* least_and_most;
  ValueOfRank* value_of_rank;
  ExtremesAround* extremes_around;
  ClampAround* clamp_around;
  HoldFlat* hold_flat;
  InnovateLanes* innovate_lanes;
  AddLanes* add_lanes;
  Exponentials* exponentials;
  Cosines* cosines;
  FluxDensities* flux_densities;
};

/// The versions that this processor can run, from the plain one, which all can, to the best.
[[nodiscard]] FREQSYNTH_API std::span<const Kernels* const> runnable_kernels();

/// The best of them, found at the first call; the functions below are its.
[[nodiscard]] FREQSYNTH_API const Kernels& chosen_kernels();

FREQSYNTH_API AbsorbSamples absorb_samples;
FREQSYNTH_API RankOneUpdate rank_one_update;
FREQSYNTH_API AddOuterProduct add_outer_product;
FREQSYNTH_API Multiply multiply;
FREQSYNTH_API ResidualMeans residual_means;
FREQSYNTH_API EvaluateSeparable evaluate_separable;
FREQSYNTH_API AddScaled add_scaled;
FREQSYNTH_API SolveFour solve_four;
FREQSYNTH_API ForwardTransform forward_transform;
FREQSYNTH_API ShrinkTerms shrink_terms;
FREQSYNTH_API AddMeans add_means;
FREQSYNTH_API KnownMeans known_means;
FREQSYNTH_API OwnedMeans owned_means;
FREQSYNTH_API LeastAndMost least_and_most;
FREQSYNTH_API ValueOfRank value_of_rank;
FREQSYNTH_API ExtremesAround extremes_around;
FREQSYNTH_API ClampAround clamp_around;
FREQSYNTH_API HoldFlat hold_flat;
FREQSYNTH_API InnovateLanes innovate_lanes;
FREQSYNTH_API AddLanes add_lanes;
FREQSYNTH_API Exponentials exponentials;
FREQSYNTH_API Cosines cosines;
FREQSYNTH_API FluxDensities flux_densities;

}  // namespace freqsynth::detail

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/kernels.inl"
#endif
