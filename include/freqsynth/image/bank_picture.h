// SPDX-License-Identifier: MIT
/// \file
/// A picture from the samples of its blocks by a bank of priors (refine/prior_bank.h).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/pixel_view.h"
#include "freqsynth/image/ring_samples.h"
#include "freqsynth/refine/bank_estimator.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

/// The samples of a block, in the order of the sequence.
struct BlockSamples {
  const float* values = nullptr;  ///< finite: one per channel of sample 0, then of sample 1, ...
  std::size_t count = 0;          ///< samples, at least 1
};

/// What a BankPictures is made from.
struct BankPictureSettings {
  PriorBank bank = PriorBank::exact();  ///< the priors
  BankSettings weights = {};            ///< how they are weighed
  /// Whether the samples of the eight blocks around, as far as they are near, have a part in a
  /// block's estimate: the first 25, 81 or 289 of each within a half, a quarter or an eighth of a
  /// block, by what all of them have.
  bool ring = true;
  /// Pixels on each side of a border in which the estimates of both blocks are blended, 0 to 4: the
  /// farther a pixel lies from a block, and the less the block's samples tell of it, the less.
  std::size_t blend = 2;
};

/// Makes pictures. Its lists are shared by all pictures and by all threads.
class FREQSYNTH_API BankPictures {
 public:
  /// \param positions  those of a block's samples, in their order: as many as a block can have,
  ///                   1 to 1800
  /// \throws std::invalid_argument naming the value when one is out of range.
  explicit BankPictures(std::span<const UnitPoint> positions,
                        const BankPictureSettings& settings = {});

  /// The pixel averages of a picture. Blocks tile it exactly (engine/block_grid.h): the last column
  /// and the last row are as narrow as what is left, and are estimated alone.
  /// \param blocks   row by row; each has at most as many samples as there are positions
  /// \param picture  receives the averages
  /// \param errors   empty, or receives the expected squared error of each pixel, row by row: its
  ///                 mean over channels, before blending
  /// \throws std::invalid_argument naming the value when one is out of range.
  void render(std::span<const BlockSamples> blocks, const PixelView& picture, std::size_t channels,
              std::span<float> errors = {}) const;

  /// Bytes that the lists built so far take.
  [[nodiscard]] std::size_t memory() const;

 private:
  struct Work;
  /// What samples a block's estimate is made from.
  struct Kind {
    std::size_t level;  // samples of the blocks around that lie in the ring; 0: none
    std::vector<detail::RingSample> ring;
    std::unique_ptr<const BankLists> lists;
  };

  BankPictureSettings settings_;
  std::vector<Kind> kinds_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/image/bank_picture.inl"
#endif
