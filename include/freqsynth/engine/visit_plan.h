// SPDX-License-Identifier: MIT
/// \file
/// What blocks take in in a wave: each some samples that follow each other, in one visit. So what
/// is known of a block is fetched from memory once for all of them.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {

/// Some samples of a block that follow each other in its sequence.
struct Visit {
  std::uint32_t block = 0;  ///< that takes them in
  std::uint32_t first = 0;  ///< index of the first one: how many the block had before
  std::uint32_t asked = 0;  ///< so many it was chosen for
  std::uint32_t count = 0;  ///< with those that come after them, and are known by then
  std::uint32_t begin = 0;  ///< number of the first one's source

  /// Index after the last sample that the block was chosen for.
  [[nodiscard]] std::uint32_t asked_end() const { return first + asked; }
  /// Index after the last sample.
  [[nodiscard]] std::uint32_t end() const { return first + count; }
};

/// How many samples a block that has had `samples` is asked for in one visit: an eighth as many,
/// but from 1 to `most`, and not beyond the end of a step of the sequence
/// (SampleSequence::even_size), where the worth of a sample drops. One until the lattice of 5 x 5
/// is complete: till then a sample more or less matters much, and blocks that are alike have to
/// stay side by side.
[[nodiscard]] constexpr std::uint32_t visit_length(std::size_t samples, std::size_t most) {
  constexpr std::size_t lattice = 25;
  if (samples < lattice) return 1;
  std::size_t step = 0;
  while (SampleSequence::even_size(step) <= samples) ++step;
  const std::size_t usual = std::clamp<std::size_t>(samples / 8, 1, most);
  return static_cast<std::uint32_t>(std::min(usual, SampleSequence::even_size(step) - samples));
}

/// Most samples that visit_length() asks a block for which may have `most_samples`.
[[nodiscard]] constexpr std::size_t longest_visit(std::size_t most_samples) {
  return std::clamp<std::size_t>(most_samples / 8, 1, 8);
}

/// Where the values of a sample are: in a slot of the wave, or among those that were known before.
struct ValueSource {
  std::uint32_t number = 0;  ///< of the slot, or of the known value
  bool known = false;        ///< whether it is one of these
};

/// The visits of a wave, at most one to each block, and the source of each of their samples.
class VisitPlan {
 public:
  /// No visits yet to blocks 0 .. blocks - 1.
  explicit VisitPlan(std::size_t blocks);

  /// Makes room for so many sources in all. There is always room for the visits.
  void reserve(std::size_t sources);

  /// Number of visits.
  [[nodiscard]] std::size_t size() const { return visits_.size(); }
  /// Whether there is none.
  [[nodiscard]] bool empty() const { return visits_.empty(); }
  /// Whether a block is visited.
  [[nodiscard]] bool contains(std::size_t block) const { return places_[block] != none; }
  /// The visit to a block that is visited.
  [[nodiscard]] const Visit& of(std::size_t block) const { return visits_[places_[block]]; }
  /// The same, to complete it.
  [[nodiscard]] Visit& of(std::size_t block) { return visits_[places_[block]]; }
  /// All visits.
  [[nodiscard]] std::span<const Visit> visits() const { return visits_; }
  /// The same, to complete them.
  [[nodiscard]] std::span<Visit> visits() { return visits_; }

  /// Adds a visit to a block that is not visited yet.
  void add(const Visit& visit);
  /// Puts the visits in the order of their blocks.
  void sort();

  /// Adds a source; there is room for it.
  void add_source(const ValueSource& source) {
    FREQSYNTH_ASSERT(sources_.size() < sources_.capacity());
    sources_.push_back(source);
  }
  /// Number of sources.
  [[nodiscard]] std::size_t source_count() const { return sources_.size(); }
  /// The source of sample `index` of the sequence in a visit whose sources were added.
  [[nodiscard]] const ValueSource& source(const Visit& visit, std::uint32_t index) const {
    FREQSYNTH_ASSERT(index >= visit.first && index < visit.end());
    return sources_[visit.begin + (index - visit.first)];
  }

  /// Ends all visits, at a cost in proportion to their number; the memory stays.
  void clear();

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  std::vector<std::uint32_t> places_;  // of each block's visit
  std::vector<std::uint64_t> bits_;    // 1: a block is visited
  std::vector<Visit> visits_, sorted_;
  std::vector<ValueSource> sources_;
};

// ------------------------------------------------------------------------------------ definitions

inline VisitPlan::VisitPlan(std::size_t blocks) : places_(blocks, none), bits_(blocks / 64 + 1) {
  visits_.reserve(blocks);
  sorted_.reserve(blocks);
}

inline void VisitPlan::reserve(std::size_t sources) {
  if (sources > sources_.capacity()) sources_.reserve(std::max(sources, 2 * sources_.capacity()));
}

inline void VisitPlan::add(const Visit& visit) {
  FREQSYNTH_ASSERT(!contains(visit.block));
  places_[visit.block] = static_cast<std::uint32_t>(visits_.size());
  bits_[visit.block / 64] |= std::uint64_t{1} << (visit.block % 64);
  visits_.push_back(visit);
}

inline void VisitPlan::sort() {
  // Few of many blocks are sorted faster than they are found.
  if (visits_.size() < bits_.size() / 64) {
    std::sort(visits_.begin(), visits_.end(),
              [](const Visit& a, const Visit& b) { return a.block < b.block; });
  } else {
    sorted_.clear();
    for (std::size_t word = 0; word < bits_.size(); ++word) {
      for (std::uint64_t left = bits_[word]; left != 0; left &= left - 1) {
        sorted_.push_back(of(64 * word + static_cast<std::size_t>(std::countr_zero(left))));
      }
    }
    visits_.swap(sorted_);
  }
  for (std::size_t i = 0; i < visits_.size(); ++i) {
    places_[visits_[i].block] = static_cast<std::uint32_t>(i);
  }
}

inline void VisitPlan::clear() {
  for (const Visit& visit : visits_) {
    places_[visit.block] = none;
    bits_[visit.block / 64] = 0;
  }
  visits_.clear();
  sources_.clear();
}

}  // namespace freqsynth
