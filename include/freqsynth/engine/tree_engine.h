// SPDX-License-Identifier: MIT
/// \file
/// A tree of nodes as an engine: what Engine is to blocks, with the same face to the host.
///
/// It chooses and takes in what TreeSampler does, to the bit. Of n samples root n are asked for
/// twice, as by Engine, which tells whether there is noise; but a tree goes on as it was made.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/host_desk.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/engine/stop_rule.h"
#include "freqsynth/engine/tree_archive.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/engine/tree_settings.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// All members may be called from any thread. Where memory runs out while a wave is taken in, the
/// rest is put off: whoever asks for requests or looks at the tree next goes on with it, and meets
/// std::bad_alloc where there still is none.
class TreeEngine : public HostDesk<TreeEngine> {
 public:
  /// \param settings  noisy where `noise` is Noise::present
  /// \param factors   see TreeSampler::use_factors()
  /// \param seed      of Request::seed
  /// \param noise     Noise::automatic: it is looked for
  /// \param apart     roles of the channels that come after those of the nodes, see PixelStore
  /// \throws std::invalid_argument like TreeSampler.
  TreeEngine(const TreeSettings& settings, std::vector<float> factors, std::uint64_t seed,
             Noise noise, std::span<const ChannelRole> apart);

  /// Tells the error to expect of pictures of a tree.
  using Predictor = double (*)(const void* context, const NodeTree& tree, bool noisy);
  /// Sets what StopRule::target_rmse is compared with. Without it that rule never holds.
  /// \param context  handed on to `predict`; must live as long as the engine
  void use_predictor(Predictor predict, const void* context) {
    predict_ = predict;
    context_ = context;
  }

  /// Other factors, from the next wave on.
  void set_factors(std::vector<float> factors) {
    if (factors.empty()) factors.assign(grid_.size(), 1.0f);
    const std::unique_lock lock = settled();
    factors_ = std::move(factors);
    ended_.reset();
  }
  /// Most positions that can be out at a time. Waves grow with the number of leaves: these are the
  /// greatest.
  [[nodiscard]] std::size_t wave_size() const;

  /// Where samples lie.
  [[nodiscard]] const NodePositions& positions() const { return sampler_.tree().positions(); }
  /// A copy of the tree after the last complete wave, and whether values are taken for estimates.
  /// \throws std::bad_alloc.
  [[nodiscard]] std::pair<NodeTree, bool> snapshot() const {
    const std::unique_lock lock = settled();
    return {sampler_.tree(), noise_ == Noise::present};
  }

  /// Saves all that is known, requests that are owed included, into an archive; see TreeArchive.
  template <class Archive>
  void save(Archive& archive) const {
    const std::unique_lock lock = settled();
    list_parts(archive, *this);
  }
  /// Loads it, into an engine that is as new. What was owed is handed out again. When it throws,
  /// the engine must not be used.
  template <class Archive>
  void load(Archive& archive) {
    const std::unique_lock lock = settled();
    list_parts(archive, *this);
  }

 private:
  friend HostDesk<TreeEngine>;

  /// The lock, once no wave is left halfway. \throws std::bad_alloc.
  [[nodiscard]] std::unique_lock<std::mutex> settled() const {
    std::unique_lock lock(mutex_);
    if (halfway_) self_.take_in_wave();
    return lock;
  }
  // All of these run under the lock.
  std::optional<StopReason> prepare_wave();
  std::optional<StopReason> choose_wave();
  [[nodiscard]] bool meets_target();
  [[nodiscard]] Request make_request(std::uint32_t slot) const;
  void end_of_delivery(std::unique_lock<std::mutex>& lock, const detail::ExecutorRef& executor);
  void take_in_wave();
  [[nodiscard]] double share_of_blocks() const;
  void add_slots();
  template <class Archive, class Self>
  static void list_parts(Archive& archive, Self& self);

  DirectionRule rule_;
  TreeSampler sampler_;
  std::uint64_t frame_;                        // the seed, mixed
  std::optional<std::vector<float>> factors_;  // that are to be used from the next wave on
  Predictor predict_ = nullptr;
  const void* context_ = nullptr;
  bool halfway_ = false;  // a complete wave waits to be taken in
  TreeEngine& self_;      // which whoever looks may have to go on with
};

}  // namespace freqsynth

#include "freqsynth/engine/tree_engine.inl"
