// SPDX-License-Identifier: MIT
/// \file
/// A picture from the leaves of a tree by a bank of priors (refine/prior_bank.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/node_positions.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/node_tree.h"
#include "freqsynth/image/bank_picture.h"
#include "freqsynth/image/constant_pixels.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/leaf_picture.h"
#include "freqsynth/image/tree_ring.h"
#include "freqsynth/refine/bank_estimator.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

/// Makes pictures of a tree while it grows, or of several.
///
/// Each leaf is estimated from its own samples and, where it is a block whose eight neighbours have
/// had enough, from those of a ring around (BankPictureSettings::ring). An estimate goes on
/// beyond its leaf: near the border of two leaves both sides' are blended. Where the samples show a
/// picture that is constant within each pixel, pixels are what their own samples say
/// (image/constant_pixels.h).
///
/// What leaves are estimated to be is kept: a leaf is estimated again when a sample has changed
/// that it depends on, so that a picture of a tree that has grown a little is made soon. So are the
/// lists, one for each prior and class of nodes, which are built when they are needed.
///
/// Results do not depend on the executor, nor on what was made before. Not for several threads at
/// once.
class TreePictures {
 public:
  /// \param positions  of the trees' nodes; must live as long as this
  /// \throws std::invalid_argument naming the setting that is out of range.
  explicit TreePictures(const NodePositions& positions, const BankPictureSettings& settings = {});
  /// With a bank, and otherwise as usual.
  TreePictures(const NodePositions& positions, PriorBank bank);

  /// The pixels of a tree with these positions, channels interleaved, row by row. Leaves that wait,
  /// or have had no sample, show the mean of what they know.
  /// \param executor  of estimates, and of rows of blocks
  /// \throws std::bad_alloc.
  template <Executor E>
  [[nodiscard]] std::vector<float> pixels(const NodeTree& tree, E& executor) {
    update(tree, detail::ExecutorRef(executor));
    return blended(tree, detail::ExecutorRef(executor));
  }
  /// The same on this thread.
  [[nodiscard]] std::vector<float> pixels(const NodeTree& tree) {
    SerialExecutor serial;
    return pixels(tree, serial);
  }

  /// The expected squared error of each of these pixels, its mean over the channels, row by row: of
  /// the leaf that a pixel belongs to, before it is blended. The root of the mean of all is the
  /// error to expect of the picture. Of a leaf that waits, NodeTree::known_error().
  /// \throws std::bad_alloc.
  template <Executor E>
  [[nodiscard]] std::vector<float> errors(const NodeTree& tree, E& executor) {
    update(tree, detail::ExecutorRef(executor));
    return squared_errors(tree, detail::ExecutorRef(executor));
  }
  /// The same on this thread.
  [[nodiscard]] std::vector<float> errors(const NodeTree& tree) {
    SerialExecutor serial;
    return errors(tree, serial);
  }

  /// The pixels as a frequency image (CoefficientMeaning::pixel_average).
  /// \throws std::bad_alloc.
  template <Executor E>
  [[nodiscard]] FrequencyImage image(const NodeTree& tree, E& executor) {
    return image_of(tree, pixels(tree, executor));
  }

  /// Bytes that the lists built so far, and the estimates, take.
  [[nodiscard]] std::size_t memory() const;

 private:
  /// What is known of a leaf.
  struct Estimate {
    std::uint64_t key = 0;   // of all that it was made from; 0: it must be made
    std::uint32_t slot = 0;  // in the room of its size
    std::uint8_t size = 0;   // 1 + number of that room; 0: it has none
  };
  /// Room for the estimates of leaves of a size: averages of each channel, squared errors, doubts.
  struct Room {
    std::vector<float> numbers;
    std::vector<std::uint32_t> free;
    std::uint32_t slots = 0;
  };
  /// Leaves that are estimated together.
  struct Batch {
    std::size_t list;
    std::span<const std::uint32_t> leaves;
  };

  /// Pixels around a leaf that it is blended into: fewer around a smaller one, whose samples are
  /// nearer to each other.
  [[nodiscard]] std::size_t margin_of(std::size_t side) const {
    return settings_.blend * side / block_size;
  }
  [[nodiscard]] static std::size_t room_of(std::size_t side) {
    return side == 8 ? 3 : side == 4 ? 2 : side == 2 ? 1 : 0;
  }
  [[nodiscard]] std::size_t count_of(std::size_t side) const {
    const std::size_t line = side + 2 * margin_of(side);
    return line * line;
  }
  [[nodiscard]] static bool estimated(const NodeTree& tree, std::uint32_t leaf) {
    return tree.node(leaf).samples > 0 && !tree.waits(leaf);
  }
  [[nodiscard]] float* slot_of(const NodeTree& tree, std::uint32_t leaf);
  [[nodiscard]] detail::LeafNumbers numbers_of(const NodeTree& tree, std::uint32_t leaf,
                                               std::vector<float>& scratch);

  void update(const NodeTree& tree, const detail::ExecutorRef& executor);
  [[nodiscard]] std::size_t list_of(const NodeTree& tree, std::uint32_t leaf) const;
  void gather(const NodeTree& tree, std::uint32_t leaf, std::size_t list,
              std::vector<float>& values) const;
  void give_slots(const NodeTree& tree, std::span<const std::uint32_t> leaves);
  void grow_lists(const NodeTree& tree, std::span<const std::vector<std::uint32_t>> leaves,
                  const detail::ExecutorRef& executor);
  [[nodiscard]] std::unique_ptr<BankLists> make_lists(std::size_t list) const;
  void estimate(const NodeTree& tree, const Batch& batch);
  [[nodiscard]] std::vector<float> blended(const NodeTree& tree,
                                           const detail::ExecutorRef& executor);
  [[nodiscard]] std::vector<float> squared_errors(const NodeTree& tree,
                                                  const detail::ExecutorRef& executor);
  [[nodiscard]] static FrequencyImage image_of(const NodeTree& tree,
                                               const std::vector<float>& pixels);

  const NodePositions* positions_;
  BankPictureSettings settings_;
  detail::TreeRings rings_;
  // Of each class of nodes without a ring, then of blocks with each ring.
  std::vector<std::unique_ptr<BankLists>> lists_;
  std::vector<Estimate> estimates_;  // of each node
  std::array<Room, 4> rooms_;        // of leaves of 1, 2, 4 and 8 pixels
  std::size_t channels_ = 0;
};

}  // namespace freqsynth

#include "freqsynth/image/tree_pictures.inl"
