// SPDX-License-Identifier: MIT
/// \file
/// The shared list of a prior: what the best linear estimator under a covariance (covariance.h)
/// makes of samples, which depends on their positions alone, and so is the same for all blocks,
/// channels and images.
///
/// With K = L L^T the covariance of the samples, the innovations
///   z_i = (f_i - sum_{j < i} L_ij z_j) / L_ii
/// are what each sample tells that those before it did not. Given these, the expected averages are
///   sum_i B_i z_i
/// with shared gains B_i; sum_i z_i^2 and sum_i ln L_ii^2 say how well the prior explains the
/// samples.
///
/// Nothing is known of the function's level: a constant of infinite variance is added to the prior,
/// exactly. Sample 0 tells it: L_00 = 1, L_i0 = 1 and B_0 = 1, so that z_0 = f_0 and the others are
/// differences from it. Row 0 has no part in the evidence, and after it alone every average is
/// expected to be f_0. A constant added to all samples changes z_0 by as much, and nothing else.
///
/// Rows are built in double and read in float. So subtract from values what is near their mean
/// first: z_0 is that much smaller, and all are that much more precise.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/basis/box_covariance.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

/// One row of an innovation list.
struct InnovationRow {
  std::span<const float> factor;  ///< L_i0 .. L_i,i-1; in memory zeros follow, to a multiple of 8
  std::span<const float> gains;   ///< B_i: one number per average, row by row
  float inverse_pivot = 0;        ///< 1 / L_ii; 0 for a sample that tells nothing
  /// Mean over the averages of their expected squared error after this sample, per unit of the
  /// process's variance.
  float variance = 0;
  double log_determinant = 0;  ///< sum of ln L_jj^2, 1 <= j <= i
};

/// The list: grown lazily, each row built once and never moved. All members may be called from
/// several threads; rows that exist are read without a lock.
///
/// Row i takes 4 i + 4 averages + 72 bytes: 240 kB for the 289 samples of a level and 64 averages.
/// While it grows it needs 8 n^2 / 2 + 8 n averages bytes more, and time like n^3: some
/// milliseconds for 289.
///
/// When memory runs out a member throws std::bad_alloc, and the list is as it was.
class FREQSYNTH_API InnovationList {
 public:
  /// Most positions of a list.
  static constexpr std::size_t max_positions = 2048;

  /// \param covariance  the prior, and the noise of samples
  /// \param positions   where the samples lie, in their order: 1 to max_positions points, each
  ///                    coordinate in -4..5. A point may be there twice: it tells nothing more, but
  ///                    for its noise
  /// \param grid        the boxes whose averages are asked for
  /// \throws std::invalid_argument naming the value when one is out of range.
  InnovationList(const Covariance& covariance, std::span<const UnitPoint> positions,
                 const AverageGrid& grid = {});
  ~InnovationList();
  InnovationList(const InnovationList&) = delete;
  InnovationList& operator=(const InnovationList&) = delete;

  /// The prior.
  [[nodiscard]] const Covariance& covariance() const { return boxes_.function().covariance(); }
  /// The boxes of the averages.
  [[nodiscard]] const AverageGrid& grid() const { return boxes_.grid(); }
  /// Where the samples lie.
  [[nodiscard]] std::span<const UnitPoint> positions() const { return positions_; }
  /// Number of rows built so far.
  [[nodiscard]] std::size_t size() const { return size_.load(std::memory_order_acquire); }
  /// Builds all rows below `count`. \throws std::invalid_argument above positions().size().
  void reserve(std::size_t count) const;
  /// Row `index`, built if need be. \throws std::invalid_argument unless below positions().size().
  [[nodiscard]] const InnovationRow& row(std::size_t index) const;
  /// Expected squared error of each average after the first sample, per unit of the process's
  /// variance. After sample i it is less by the squares of B_1 .. B_i.
  [[nodiscard]] std::span<const double> first_variances() const { return first_variances_; }
  /// Bytes that the rows built so far take.
  [[nodiscard]] std::size_t memory() const;

 private:
  struct Growth;
  struct Factorization;

  void grow(std::size_t count) const;

  detail::BoxCovariance boxes_;
  std::vector<UnitPoint> positions_;
  std::vector<double> first_variances_;
  // Growing on demand is invisible to the reader; hence a const list may grow.
  mutable std::atomic<std::size_t> size_{0};
  mutable std::vector<InnovationRow> rows_;  // as many as positions, of which size_ are built
  Growth* growth_ = nullptr;
};

/// The first `count` positions of a sequence, as points.
/// \throws std::invalid_argument above SampleSequence::max_size.
[[nodiscard]] FREQSYNTH_API std::vector<UnitPoint> sequence_points(SampleSequence& sequence,
                                                                   std::size_t count);

// ------------------------------------------------------------------------------------ definitions

[[gnu::always_inline]] inline const InnovationRow& InnovationList::row(std::size_t index) const {
  if (index >= size()) [[unlikely]] {
    grow(index + 1);
  }
  return rows_[index];
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/innovation_list.inl"
#endif
