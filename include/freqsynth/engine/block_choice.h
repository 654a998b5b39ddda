// SPDX-License-Identifier: MIT
/// \file
/// Which blocks are next (paper, section 4.4): the queue, kept in order by a measure.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_measure.h"
#include "freqsynth/engine/block_queue.h"
#include "freqsynth/engine/visit_plan.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// The priorities of a block and of some beside it.
struct Revision {
  /// One of these.
  struct Beside {
    std::uint32_t block;  ///< its index
    float priority;       ///< what is expected of one more sample there
  };
  float priority = 0;            ///< of the block itself
  std::uint32_t count = 0;       ///< of those beside it
  std::array<Beside, 4> beside;  ///< the first ones are set
};

/// The blocks of an image in the order of their priorities.
template <Refiner R, BlockMeasure<R> M>
class BlockChoice {
 public:
  /// \param factors  factor on the priority of each block, finite and >= 0
  BlockChoice(M measure, std::vector<float> factors);

  /// Highest priority, BlockQueue::absent when no block is in the queue.
  [[nodiscard]] float top_priority() const { return queue_.top_priority(); }
  /// Takes the first block out of the queue; there is one.
  std::uint32_t take();
  /// Takes a block out of the queue.
  void take(std::uint32_t block) { queue_.update(block, BlockQueue::absent); }
  /// Whether more samples of a block are wanted at all.
  [[nodiscard]] bool wanted(std::uint32_t block) const { return factors_[block] > 0; }

  /// Share of what is owed to every block that is owed to this one: its factor, at most 1.
  [[nodiscard]] float share(std::uint32_t block) const { return std::min(factors_[block], 1.0f); }
  /// Those of all blocks.
  [[nodiscard]] double shares() const {
    double sum = 0;
    for (std::uint32_t block = 0; block < factors_.size(); ++block) sum += double{share(block)};
    return sum;
  }
  /// Other factors, one for each block. Does not allocate.
  void use_factors(const BlockView<R>& view, std::vector<float>&& factors) {
    factors_ = std::move(factors);
    revise_all(view);
  }
  /// See BlockMeasure.
  [[nodiscard]] bool in_units() const { return measure_.in_units(); }
  /// See BlockMeasure.
  void use_units(const BlockView<R>& view, float factor);

  /// See BlockMeasure.
  bool notice_noise(const BlockView<R>& view) { return measure_.notice_noise(view); }

  /// A block has taken in samples, which changed it by `changes`, one after the other.
  void absorbed(const BlockView<R>& view, std::uint32_t block, std::span<const float> changes) {
    measure_.absorbed(view, block, changes);
  }

  /// See BlockMeasure.
  [[nodiscard]] bool apart() const { return measure_.apart(); }
  /// See BlockMeasure.
  double absorbed_apart(const BlockView<R>& view, std::uint32_t block,
                        std::span<const float> changes) {
    return measure_.absorbed_apart(view, block, changes);
  }
  /// See BlockMeasure.
  void add(double sum) { measure_.add(sum); }

  /// Puts blocks where they belong after these visits, and those beside them that have to hear of
  /// it: revision() and then enter() for each.
  void revise(const BlockView<R>& view, const VisitPlan& plan, bool always);
  /// Where a block belongs after its visit, and those beside it that have to hear of it. For
  /// several visits at the same time.
  /// \param always  blocks beside are told whether there is news or not
  [[nodiscard]] Revision revision(const BlockView<R>& view, const VisitPlan& plan,
                                  std::uint32_t block, bool always);
  /// Puts them there.
  void enter(std::uint32_t block, const Revision& revision);
  /// Puts all blocks where they belong.
  void revise_all(const BlockView<R>& view);

 private:
  friend struct StateArchive;

  [[nodiscard]] float priority_of(const BlockView<R>& view, std::uint32_t block) const;

  M measure_;
  std::vector<float> factors_;
  BlockQueue queue_;
};

// ------------------------------------------------------------------------------------ definitions

template <Refiner R, BlockMeasure<R> M>
BlockChoice<R, M>::BlockChoice(M measure, std::vector<float> factors)
    : measure_(std::move(measure)), factors_(std::move(factors)), queue_(factors_.size()) {}

template <Refiner R, BlockMeasure<R> M>
void BlockChoice<R, M>::use_units(const BlockView<R>& view, float factor) {
  measure_.use_units(view, factor);
  if (factor == 1 || !measure_.in_units()) return;
  for (std::size_t b = 0; b < queue_.size(); ++b) {
    const float priority = queue_.priority(b);
    // Blocks without a sample stay the most urgent ones.
    if (priority >= 0 && priority <= most_priority) queue_.update(b, priority * factor);
  }
}

template <Refiner R, BlockMeasure<R> M>
std::uint32_t BlockChoice<R, M>::take() {
  const auto block = static_cast<std::uint32_t>(queue_.top());
  take(block);
  return block;
}

template <Refiner R, BlockMeasure<R> M>
float BlockChoice<R, M>::priority_of(const BlockView<R>& view, std::uint32_t block) const {
  if (view.blocks.samples(block) == 0) return std::numeric_limits<float>::max();
  if (view.blocks.full(block)) return BlockQueue::absent;
  if (!wanted(block)) return 0;
  // A sample that has no usable value is worth nothing.
  const float factor = factors_[block] * view.blocks.usable_share(block);
  const float priority = measure_.priority(view, block, factor);
  // Also where a state that was loaded is no number.
  return priority < most_priority ? priority : most_priority;
}

template <Refiner R, BlockMeasure<R> M>
void BlockChoice<R, M>::revise(const BlockView<R>& view, const VisitPlan& plan, bool always) {
  for (const Visit& visit : plan.visits()) {
    enter(visit.block, revision(view, plan, visit.block, always));
  }
}

// Reads the queue only of blocks that are not visited, and whatever the other visits enter there: a
// priority that is entered twice is the same.
template <Refiner R, BlockMeasure<R> M>
Revision BlockChoice<R, M>::revision(const BlockView<R>& view, const VisitPlan& plan,
                                     std::uint32_t block, bool always) {
  Revision revision;
  revision.priority = priority_of(view, block);
  if (!measure_.has_news(block) && !always) return revision;
  view.grid.visit_beside(block, [&](std::uint32_t other) {
    if (plan.contains(other) || !measure_.cares(queue_.priority(other))) return;
    revision.beside[revision.count++] = {other, priority_of(view, other)};
  });
  return revision;
}

template <Refiner R, BlockMeasure<R> M>
void BlockChoice<R, M>::enter(std::uint32_t block, const Revision& revision) {
  queue_.update(block, revision.priority);
  for (std::uint32_t i = 0; i < revision.count; ++i) {
    queue_.update(revision.beside[i].block, revision.beside[i].priority);
  }
}

template <Refiner R, BlockMeasure<R> M>
void BlockChoice<R, M>::revise_all(const BlockView<R>& view) {
  for (std::size_t b = 0; b < queue_.size(); ++b) {
    const auto block = static_cast<std::uint32_t>(b);
    queue_.update(block, priority_of(view, block));
  }
}

}  // namespace freqsynth
