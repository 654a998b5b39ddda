// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <utility>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/throwing_tasks.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/image/tree_pictures.h"

namespace freqsynth {

inline TreePictures::TreePictures(const NodePositions& positions,
                                  const BankPictureSettings& settings)
    : positions_(&positions), settings_(settings), rings_(positions) {
  detail::require(settings.blend <= block_size / 2, "blend", static_cast<double>(settings.blend),
                  "in 0..4");
  lists_.resize(positions.classes() + rings_.size());
}

inline TreePictures::TreePictures(const NodePositions& positions, PriorBank bank)
    : TreePictures(positions, BankPictureSettings{std::move(bank)}) {}

inline std::size_t TreePictures::memory() const {
  std::size_t bytes = estimates_.size() * sizeof(Estimate);
  for (const auto& lists : lists_) bytes += lists != nullptr ? lists->memory() : 0;
  for (const Room& room : rooms_) bytes += room.numbers.size() * sizeof(float);
  return bytes;
}

inline std::size_t TreePictures::list_of(const NodeTree& tree, std::uint32_t leaf) const {
  const TreeNode& node = tree.node(leaf);
  if (node.depth > 0 || !settings_.ring) return node.of;
  const std::size_t ring = rings_.ring_of(tree, leaf);
  return ring == 0 ? node.of : positions_->classes() + ring - 1;
}

/// The samples that a leaf's estimate is made from, all channels of the first, then of the next.
inline void TreePictures::gather(const NodeTree& tree, std::uint32_t leaf, std::size_t list,
                                 std::vector<float>& values) const {
  if (list >= positions_->classes()) {
    const std::size_t ring = list - positions_->classes() + 1;
    rings_.visit(tree, leaf, ring, [&](const detail::LeafSample& sample) {
      for (std::size_t c = 0; c < tree.channels(); ++c) {
        values.push_back(tree.values(sample.leaf, c)[sample.index]);
      }
      return true;
    });
  }
  const std::size_t first = values.size();
  values.resize(first + tree.node(leaf).samples * tree.channels());
  for (std::size_t c = 0; c < tree.channels(); ++c) {
    float* next = values.data() + first + c;
    for (const float value : tree.values(leaf, c)) {
      *next = value;
      next += tree.channels();
    }
  }
}

inline void TreePictures::update(const NodeTree& tree, const detail::ExecutorRef& executor) {
  FREQSYNTH_ASSERT(&tree.positions() == positions_);
  if (channels_ != tree.channels()) {
    estimates_.clear();
    rooms_ = {};
    channels_ = tree.channels();
  }
  estimates_.resize(tree.size());
  // What leaves are made from by now.
  struct Wanted {
    std::uint64_t key = 0;
    std::size_t list = 0;
  };
  std::vector<Wanted> wanted(tree.size());
  constexpr std::size_t together = 1024;
  detail::execute_all(executor, (tree.size() + together - 1) / together, [&](std::size_t task) {
    std::vector<float> values;
    const std::size_t end = std::min(tree.size(), (task + 1) * together);
    for (std::size_t number = task * together; number < end; ++number) {
      const auto leaf = static_cast<std::uint32_t>(number);
      if (!tree.node(leaf).leaf() || !estimated(tree, leaf)) continue;
      const std::size_t list = list_of(tree, leaf);
      values.clear();
      gather(tree, leaf, list, values);
      std::uint64_t key = list;
      for (const float value : values) {
        key = (key ^ std::bit_cast<std::uint32_t>(value)) * detail::golden_step;
        key ^= key >> 29;
      }
      wanted[leaf] = {key | 1, list};
    }
  });
  std::vector<std::vector<std::uint32_t>> changed(lists_.size());
  for (std::uint32_t leaf = 0; leaf < tree.size(); ++leaf) {
    if (estimates_[leaf].key == wanted[leaf].key) continue;
    estimates_[leaf].key = 0;
    if (wanted[leaf].key != 0) changed[wanted[leaf].list].push_back(leaf);
  }
  // Those with the most samples first: lists grow once, and leaves that are estimated together have
  // about as many.
  for (auto& leaves : changed) {
    std::stable_sort(leaves.begin(), leaves.end(), [&](std::uint32_t a, std::uint32_t b) {
      return tree.node(a).samples > tree.node(b).samples;
    });
  }
  grow_lists(tree, changed, executor);
  std::vector<Batch> batches;
  for (std::size_t list = 0; list < changed.size(); ++list) {
    if (changed[list].empty()) continue;
    give_slots(tree, changed[list]);
    constexpr std::size_t most = 128;
    const std::span<const std::uint32_t> all(changed[list]);
    for (std::size_t first = 0; first < all.size(); first += most) {
      batches.push_back({list, all.subspan(first, std::min(most, all.size() - first))});
    }
  }
  detail::execute_all(executor, batches.size(),
                      [&](std::size_t task) { estimate(tree, batches[task]); });
  for (const auto& leaves : changed) {
    for (const std::uint32_t leaf : leaves) estimates_[leaf].key = wanted[leaf].key;
  }
}

/// Makes lists, with as many rows as some leaves need. Those of each list have the one with the
/// most samples first.
inline void TreePictures::grow_lists(const NodeTree& tree,
                                     std::span<const std::vector<std::uint32_t>> leaves,
                                     const detail::ExecutorRef& executor) {
  struct Growth {
    const InnovationList* list;
    std::size_t rows;
  };
  std::vector<Growth> growths;
  for (std::size_t list = 0; list < leaves.size(); ++list) {
    if (leaves[list].empty()) continue;
    if (lists_[list] == nullptr) lists_[list] = make_lists(list);
    const BankLists& all = *lists_[list];
    // Up to the end of a level: most nodes that go beyond one come to the end of the next, and a
    // list that grows often costs as often.
    const std::size_t samples = tree.node(leaves[list].front()).samples;
    std::size_t level = 25;
    for (const std::size_t next : {std::size_t{81}, std::size_t{289}, NodePositions::size}) {
      if (level < samples) level = next;
    }
    const std::size_t rows = all.max_samples() - NodePositions::size + level;
    for (std::size_t member = 0; member < all.size(); ++member) {
      // Those of waves are made when a leaf needs them.
      if (!all.is_made(member)) continue;
      if (all[member].size() < std::min(rows, all[member].positions().size())) {
        growths.push_back({&all[member], std::min(rows, all[member].positions().size())});
      }
    }
  }
  detail::execute_all(executor, growths.size(),
                      [&](std::size_t task) { growths[task].list->reserve(growths[task].rows); });
}

inline std::unique_ptr<BankLists> TreePictures::make_lists(std::size_t list) const {
  const bool ring = list >= positions_->classes();
  const std::size_t of = ring ? 0 : list, side = positions_->pixels(of);
  std::vector<UnitPoint> points;
  for (std::size_t i = 0; !ring && i < NodePositions::size; ++i) {
    points.push_back({positions_->s(of, i), positions_->t(of, i)});
  }
  if (ring) points = rings_.positions(list - positions_->classes() + 1);
  return std::make_unique<BankLists>(settings_.bank, points,
                                     AverageGrid::with_margin(side, margin_of(side)));
}

/// Gives slots to leaves that have none of their size, and takes those of nodes that are split.
inline void TreePictures::give_slots(const NodeTree& tree, std::span<const std::uint32_t> leaves) {
  const auto release = [&](Estimate& one) {
    if (one.size == 0) return;
    rooms_[one.size - 1u].free.push_back(one.slot);
    one.size = 0;
  };
  for (std::uint32_t number = 0; number < tree.size(); ++number) {
    if (!tree.node(number).leaf()) release(estimates_[number]);
  }
  for (const std::uint32_t leaf : leaves) {
    const std::size_t side = positions_->pixels(tree.node(leaf).of), size = room_of(side);
    Estimate& one = estimates_[leaf];
    if (one.size == size + 1) continue;
    release(one);
    Room& room = rooms_[size];
    if (room.free.empty()) {
      room.free.push_back(room.slots);
      ++room.slots;
    }
    one.slot = room.free.back();
    one.size = static_cast<std::uint8_t>(size + 1);
    room.free.pop_back();
  }
  for (std::size_t size = 0; size < rooms_.size(); ++size) {
    const std::size_t count = (channels_ + 2) * count_of(std::size_t{1} << size);
    rooms_[size].numbers.resize(rooms_[size].slots * count);
  }
}

inline float* TreePictures::slot_of(const NodeTree& tree, std::uint32_t leaf) {
  const std::size_t side = positions_->pixels(tree.node(leaf).of);
  const std::size_t count = (channels_ + 2) * count_of(side);
  return rooms_[room_of(side)].numbers.data() + estimates_[leaf].slot * count;
}

inline void TreePictures::estimate(const NodeTree& tree, const Batch& batch) {
  BankEstimator estimator(*lists_[batch.list], channels_, settings_.weights);
  std::vector<float> values;
  std::vector<std::size_t> begins;
  for (const std::uint32_t leaf : batch.leaves) {
    begins.push_back(values.size());
    gather(tree, leaf, batch.list, values);
  }
  begins.push_back(values.size());
  std::vector<BankNode> nodes(batch.leaves.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t count = count_of(positions_->pixels(tree.node(batch.leaves[i]).of));
    nodes[i].values = values.data() + begins[i];
    nodes[i].count = (begins[i + 1] - begins[i]) / channels_;
    nodes[i].averages = slot_of(tree, batch.leaves[i]);
    nodes[i].squared_errors = nodes[i].averages + channels_ * count;
    nodes[i].doubts = nodes[i].squared_errors + count;
  }
  estimator.estimate(nodes);
}

inline std::vector<float> TreePictures::blended(const NodeTree& tree,
                                                const detail::ExecutorRef& executor) {
  const auto margin = [&](std::uint32_t leaf) {
    return estimated(tree, leaf) ? margin_of(positions_->pixels(tree.node(leaf).of)) : 0;
  };
  std::vector<float> pixels = detail::blend_leaves(
      tree, channels_, executor, margin, [&](std::uint32_t leaf, std::vector<float>& scratch) {
        return numbers_of(tree, leaf, scratch);
      });
  detail::ConstantPixels(tree, executor).set_pixels(pixels, executor);
  return pixels;
}

inline detail::LeafNumbers TreePictures::numbers_of(const NodeTree& tree, std::uint32_t leaf,
                                                    std::vector<float>& scratch) {
  const std::size_t side = positions_->pixels(tree.node(leaf).of);
  if (estimated(tree, leaf)) {
    const float* own = slot_of(tree, leaf);
    const std::size_t margin = margin_of(side);
    const float* doubts = margin > 0 ? own + (channels_ + 1) * count_of(side) : nullptr;
    return {own, doubts, margin};
  }
  scratch.clear();
  for (std::size_t c = 0; c < channels_; ++c) {
    scratch.insert(scratch.end(), side * side, tree.known_mean(leaf, c));
  }
  return {scratch.data(), nullptr, 0};
}

inline std::vector<float> TreePictures::squared_errors(const NodeTree& tree,
                                                       const detail::ExecutorRef& executor) {
  const auto numbers = [&](std::uint32_t leaf, std::vector<float>& scratch) {
    const std::size_t side = positions_->pixels(tree.node(leaf).of);
    // Leaves that lie within a pixel are off independently of each other.
    const double area = std::min(1.0, tree.area(leaf));
    if (!estimated(tree, leaf)) {
      double sum = 0;
      for (std::size_t c = 0; c < channels_; ++c) sum += tree.known_error(leaf, c);
      scratch.assign(side * side, static_cast<float>(area * sum / static_cast<double>(channels_)));
      return detail::LeafNumbers{scratch.data(), nullptr, 0};
    }
    const std::size_t margin = margin_of(side), line = side + 2 * margin;
    const float* own = slot_of(tree, leaf) + channels_ * count_of(side);
    scratch.clear();
    for (std::size_t j = margin; j < margin + side; ++j) {
      for (std::size_t i = margin; i < margin + side; ++i) {
        scratch.push_back(static_cast<float>(area * double{own[j * line + i]}));
      }
    }
    return detail::LeafNumbers{scratch.data(), nullptr, 0};
  };
  std::vector<float> errors = detail::blend_leaves(
      tree, 1, executor, [](std::uint32_t) { return std::size_t{0}; }, numbers);
  detail::ConstantPixels(tree, executor).lower_errors(errors, executor);
  return errors;
}

inline FrequencyImage TreePictures::image_of(const NodeTree& tree,
                                             const std::vector<float>& pixels) {
  return transform_pixels(pixels, tree.grid().width, tree.grid().height, tree.channels());
}

}  // namespace freqsynth
