// SPDX-License-Identifier: MIT
/// \file
/// The shared list (paper, section 4.3): for every index of the sample sequence the position, the
/// number of terms, J^-1, and the gain and bordering vectors that are derived from it.
///
/// It depends on positions alone, so that one list serves all blocks, all channels and, if shared,
/// many images.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/basis/list_settings.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

/// The list: grown lazily, each entry built once in double and never moved. All members may be
/// called from several threads; entries that exist are read without a lock.
///
/// Each entry keeps what a synthesis reads, 0.9 kB. J^-1 and the vectors in double, up to 18
/// kB, are computed when they are asked for, and kept.
///
/// When memory runs out a member throws std::bad_alloc, and the list is as it was: it can be asked
/// again.
class FREQSYNTH_API InverseList {
 public:
  /// \throws std::invalid_argument naming the field and the value when a setting is out of range.
  explicit InverseList(const InverseListSettings& settings = {});
  ~InverseList();
  InverseList(const InverseList&) = delete;
  InverseList& operator=(const InverseList&) = delete;

  /// What the list was made from.
  [[nodiscard]] const InverseListSettings& settings() const { return settings_; }
  /// Number of entries built so far.
  [[nodiscard]] std::size_t size() const { return size_.load(std::memory_order_acquire); }
  /// Builds all entries below `count`. \throws std::invalid_argument above
  /// SampleSequence::max_size.
  void reserve(std::size_t count) const;

  // All of these build the entry when it does not exist yet; `index` is below
  // SampleSequence::max_size, else std::invalid_argument is thrown. "After index n" means after n +
  // 1 samples, and after the term that is added then, if any.

  /// Where sample `index` of every block lies.
  [[nodiscard]] const SequencePosition& position(std::size_t index) const;
  /// Number of terms T after `index`.
  [[nodiscard]] std::size_t terms(std::size_t index) const;
  /// Expected squared error of each coefficient F after `index`, per unit of residual variance: for
  /// terms in the fit (J^-1)(i, i) in the scale of F; for the others what they may hold, when the
  /// energy that the fit leaves over is spread like that of edges, 1 / frequency^3.
  [[nodiscard]] std::span<const float, max_terms> variances(std::size_t index) const;
  /// What the hot path reads: gains rounded to float.
  [[nodiscard]] const detail::SampleRow& row(std::size_t index) const;
  /// The same of `index` and those after it, side by side: as many as lie there, at most `most`,
  /// which is at least 1.
  [[nodiscard]] std::span<const detail::SampleRow> rows(std::size_t index, std::size_t most) const;

  // In double, computed on demand: at most 64 updates of J^-1 at the first call for an index.

  /// J^-1 after `index`: the lower triangle, row by row, T (T + 1) / 2 values.
  [[nodiscard]] std::span<const double> inverse(std::size_t index) const;
  /// k = J^-1 A of the terms that were in the fit before `index`: the amplitudes change by k times
  /// the difference of sample and prediction.
  [[nodiscard]] std::span<const double> gain(std::size_t index) const;
  /// The bordering vector -J^-1 B of the term added after `index`; empty when none is.
  [[nodiscard]] std::span<const double> border(std::size_t index) const;

 private:
  static constexpr std::size_t chunk_size = 64;
  struct Chunk;
  struct Exact;
  struct Builder;
  struct Replay;

  [[nodiscard]] const Chunk& chunk_of(std::size_t index) const;
  void grow(std::size_t count) const;
  const Exact& exact(std::size_t index) const;

  InverseListSettings settings_;
  // Growing on demand is invisible to the reader; hence a const list may grow.
  mutable std::atomic<std::size_t> size_{0};
  mutable std::vector<std::atomic<Chunk*>> chunks_;
  Builder* builder_ = nullptr;
  Replay* replay_ = nullptr;
};

struct InverseList::Chunk {
  detail::SampleRow rows[chunk_size];
  SequencePosition positions[chunk_size];
  std::uint8_t terms[chunk_size];
  std::array<float, max_terms> variances[chunk_size];
  std::atomic<const Exact*> exact[chunk_size] = {};

  Chunk() = default;
  Chunk(const Chunk&) = delete;
  Chunk& operator=(const Chunk&) = delete;
  ~Chunk();
};

// ------------------------------------------------------------------------------------ definitions

[[gnu::always_inline]] inline const InverseList::Chunk& InverseList::chunk_of(
    std::size_t index) const {
  if (index >= size()) [[unlikely]] {
    grow(index + 1);
  }
  return *chunks_[index / chunk_size].load(std::memory_order_relaxed);
}

[[gnu::always_inline]] inline const SequencePosition& InverseList::position(
    std::size_t index) const {
  return chunk_of(index).positions[index % chunk_size];
}
[[gnu::always_inline]] inline std::size_t InverseList::terms(std::size_t index) const {
  return chunk_of(index).terms[index % chunk_size];
}
inline std::span<const float, max_terms> InverseList::variances(std::size_t index) const {
  return chunk_of(index).variances[index % chunk_size];
}
[[gnu::always_inline]] inline const detail::SampleRow& InverseList::row(std::size_t index) const {
  return chunk_of(index).rows[index % chunk_size];
}
[[gnu::always_inline]] inline std::span<const detail::SampleRow> InverseList::rows(
    std::size_t index, std::size_t most) const {
  const std::size_t slot = index % chunk_size;
  const std::size_t count = most < chunk_size - slot ? most : chunk_size - slot;
  return {chunk_of(index + count - 1).rows + slot, count};
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/inverse_list.inl"
#endif
