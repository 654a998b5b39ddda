// SPDX-License-Identifier: MIT
/// \file
/// How much a block deserves the next sample: the interface of a measure, and the measures of the
/// paper (its change) and beyond it (its residuals). A third is in jpeg/quantizer_measure.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_view.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/engine/residual_book.h"
#include "freqsynth/engine/steering.h"
#include "freqsynth/refine/refiner.h"

namespace freqsynth {

/// A measure of blocks that R refines. It keeps what it needs to know of each block.
template <class M, class R>
concept BlockMeasure = requires(M& measure, const M& known, const BlockView<R>& view,
                                std::uint32_t block, float value, double sum,
                                std::span<const float> changes) {
  /// Blocks use other units from now on (BlockStore::use_units), in which a square over all
  /// channels is `value` times what it was.
  { measure.use_units(view, value) } -> std::same_as<void>;
  /// Values turn out to be estimates. Returns whether the priorities of all blocks are others by
  /// that.
  { measure.notice_noise(view) } -> std::same_as<bool>;
  /// A block has taken in samples, at least one, which changed it by `changes` one after the other.
  { measure.absorbed(view, block, changes) } -> std::same_as<void>;
  /// Whether absorbed() can be done in two steps at present, absorbed_apart() and add().
  { known.apart() } -> std::same_as<bool>;
  /// The first one touches nothing but the block, and may run for several at the same time.
  { measure.absorbed_apart(view, block, changes) } -> std::same_as<double>;
  /// The second one takes what the first has returned, block by block, in an order that results
  /// depend on.
  { measure.add(sum) } -> std::same_as<void>;
  /// Priority of a block that has had a sample, and is not full; `value` is a factor on it. 0 when
  /// the block needs no more. Finite or not, but a number, and not negative.
  { known.priority(view, block, value) } -> std::same_as<float>;
  /// Whether the blocks beside this one have to be told that its residuals have grown.
  { measure.has_news(block) } -> std::same_as<bool>;
  /// Whether a block whose priority is `value` cares for news.
  { known.cares(value) } -> std::same_as<bool>;
  /// Whether priorities are squares in the blocks' units, and change with them.
  { known.in_units() } -> std::same_as<bool>;
};

/// The paper's measure: from what the last samples have changed.
class ChangeMeasure {
 public:
  /// \param most_samples  of a block
  ChangeMeasure(const PrioritySettings& settings, std::size_t blocks, std::size_t most_samples,
                Steering steering = {})
      : metric_(settings, most_samples), steering_(std::move(steering)), variations_(blocks) {}

  /// See BlockMeasure.
  template <Refiner R>
  void use_units(const BlockView<R>&, float factor) {
    if (steering_.settled()) return;
    for (float& variation : variations_) variation *= factor;
  }

  /// See BlockMeasure. What changes have been is known in the unit that they were seen in.
  template <Refiner R>
  bool notice_noise(const BlockView<R>& view) {
    steering_.notice_noise(view.blocks);
    return false;
  }

  /// See BlockMeasure.
  [[nodiscard]] bool apart() const { return steering_.linear() || steering_.settled(); }
  /// See BlockMeasure.
  template <Refiner R>
  void absorbed(const BlockView<R>& view, std::uint32_t block, std::span<const float> changes) {
    note(view, block, changes);
    if (steering_.linear() || !steering_.absorbed(view.blocks, block, changes.size())) return;
    for (std::uint32_t b = 0; b < view.blocks.size(); ++b) {
      variations_[b] = steering_.change(view.blocks, b, variations_[b]);
    }
  }
  /// See BlockMeasure.
  template <Refiner R>
  double absorbed_apart(const BlockView<R>& view, std::uint32_t block,
                        std::span<const float> changes) {
    note(view, block, changes);
    if (!steering_.linear()) steering_.absorbed(view.blocks, block, changes.size());
    return 0;
  }
  /// See BlockMeasure.
  static void add(double) {}

  /// See BlockMeasure.
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float factor) const {
    const float variance = in_units() ? view.signal.variance() : steering_.variance();
    return factor * metric_.priority(variations_[block], view.blocks.samples(block), variance);
  }

  /// See BlockMeasure.
  [[nodiscard]] static bool has_news(std::uint32_t) { return false; }
  /// See BlockMeasure.
  [[nodiscard]] static bool cares(float) { return false; }
  /// See BlockMeasure.
  [[nodiscard]] bool in_units() const { return steering_.linear(); }

 private:
  friend struct StateArchive;

  template <Refiner R>
  void note(const BlockView<R>& view, std::uint32_t block, std::span<const float> changes) {
    // A plausible change is about that of a fit of T terms to n values in the signal's range.
    const float range = 8 * view.signal.most_variance(view.blocks.refiner().weights());
    float& variation = variations_[block];
    std::size_t taken = view.blocks.samples(block) - changes.size();
    for (const float change : changes) {
      const auto samples = static_cast<float>(++taken);
      const auto terms = static_cast<float>(view.blocks.refiner().terms(taken));
      const float most = range * terms / (samples * samples);
      const float plausible = std::min(change, most);
      if (steering_.linear()) {
        // What was noted before the range was known may be larger than all of it.
        variation = metric_.variation(std::min(variation, range), plausible);
      } else {
        // As the block is shown to be now.
        const bool known = steering_.settled();
        variation = metric_.variation(
            variation, known ? steering_.change(view.blocks, block, plausible) : plausible);
      }
    }
  }

  PriorityMetric metric_;
  Steering steering_;
  std::vector<float> variations_;
};

/// From the residuals of all samples of a block, of those beside it and of the whole image; see
/// PriorityMeasure::residual.
class ResidualMeasure {
 public:
  /// \param most_samples  of a block
  ResidualMeasure(const PrioritySettings& settings, std::size_t blocks, std::size_t most_samples,
                  Steering steering = {})
      : metric_(settings, most_samples),
        steering_(std::move(steering)),
        neighbours_(static_cast<float>(settings.neighbours)),
        image_(static_cast<float>(settings.image)),
        book_(blocks) {}

  /// See BlockMeasure.
  template <Refiner R>
  void use_units(const BlockView<R>&, float factor) {
    if (in_units()) book_.rescale(factor);
  }

  /// See BlockMeasure.
  template <Refiner R>
  bool notice_noise(const BlockView<R>& view) {
    steering_.notice_noise(view.blocks);
    if (!steering_.settled()) return false;
    for (std::uint32_t b = 0; b < view.blocks.size(); ++b) note_steered(view, b);
    return true;
  }

  /// See BlockMeasure.
  template <Refiner R>
  void absorbed(const BlockView<R>& view, std::uint32_t block, std::span<const float> changes) {
    if (apart()) {
      book_.add(absorbed_apart(view, block, changes));
    } else if (steering_.absorbed(view.blocks, block, changes.size())) {
      for (std::uint32_t b = 0; b < view.blocks.size(); ++b) note_steered(view, b);
    }
  }
  /// See BlockMeasure.
  [[nodiscard]] bool apart() const { return steering_.linear() || steering_.settled(); }
  /// See BlockMeasure.
  template <Refiner R>
  double absorbed_apart(const BlockView<R>& view, std::uint32_t block,
                        std::span<const float> changes) {
    if (steering_.linear()) return book_.exchange(block, plausible_residual(view, block));
    steering_.absorbed(view.blocks, block, changes.size());
    return book_.exchange(block, steered(view, block));
  }
  /// See BlockMeasure.
  void add(double change) { book_.add(change); }

  /// See BlockMeasure.
  template <Refiner R>
  [[nodiscard]] float priority(const BlockView<R>& view, std::uint32_t block, float factor) const {
    const std::uint32_t samples = view.blocks.samples(block);
    const float pooled = book_.pooled(
        view, block, [&](std::uint32_t b) { return book_.of(b); }, neighbours_, image_);
    const float area = view.grid.area(block);
    factor *= std::sqrt(area);
    if (steering_.linear()) {
      return factor * metric_.expected_gain(view.signal.rounding() + pooled, samples,
                                            view.signal.variance());
    }
    return factor * steering_.gain(static_cast<float>(samples) / (max_terms * area)) *
           metric_.expected_gain(steering_.rounding() + pooled, samples, steering_.variance());
  }

  /// See BlockMeasure.
  [[nodiscard]] bool has_news(std::uint32_t block) { return book_.has_news(block); }
  /// See BlockMeasure.
  [[nodiscard]] static bool cares(float) { return true; }
  /// See BlockMeasure.
  [[nodiscard]] bool in_units() const { return steering_.linear(); }

 private:
  friend struct StateArchive;
  template <Refiner R>
  [[nodiscard]] float steered(const BlockView<R>& view, std::uint32_t block) const {
    return steering_.residual(view.blocks, block,
                              [&](std::size_t c) { return plausible_residual(view, block, c); });
  }
  template <Refiner R>
  void note_steered(const BlockView<R>& view, std::uint32_t block) {
    book_.note(block, steered(view, block));
  }

  PriorityMetric metric_;
  Steering steering_;
  float neighbours_, image_;
  ResidualBook book_;
};

}  // namespace freqsynth
