// SPDX-License-Identifier: MIT
/// \file
/// A bank of priors (basis/covariance.h), and the shared lists of all its members.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/innovation_list.h"

namespace freqsynth {

/// Members of a bank that are tried together.
struct PriorGroup {
  std::size_t first = 0;  ///< index of the first
  std::size_t count = 0;  ///< how many
  /// Whether they are one prior in as many directions, at equal steps of half a turn. Then only
  /// some are tried: every fourth at first, and those beside what explains a node best.
  bool directions = false;
  /// Whether they oscillate. Then they are tried on nodes that all others explain badly.
  bool waves = false;
};

/// Priors that oscillate, with wave vectors on a polar grid: 1 to 6.25 waves per edge of the node,
/// at steps of 3/4, in directions that are about as far from each other.
[[nodiscard]] FREQSYNTH_API std::vector<Covariance> wave_priors();

/// The priors that may explain a node. None is right; those that explain the samples best are
/// averaged.
class FREQSYNTH_API PriorBank {
 public:
  /// None.
  PriorBank() = default;
  /// For functions without noise: four priors from edges to smooth shading and two that are nearly
  /// polynomials, in all directions alike; long edges and long soft ones in 16 directions each; and
  /// wave_priors().
  [[nodiscard]] static PriorBank exact();
  /// For Monte Carlo estimates: edges and smooth shading below noise of a tenth to thirty times
  /// their variance, and edges in 8 directions.
  [[nodiscard]] static PriorBank noisy();

  /// One more group, of one member. \throws std::invalid_argument like CovarianceFunction.
  void add(const Covariance& covariance);
  /// One more group: a prior in `count` directions, 4 to 64, a power of two.
  /// \throws std::invalid_argument for another count, or like CovarianceFunction.
  void add_directions(const Covariance& covariance, std::size_t count);
  /// One more group, of priors that oscillate. There must be another one before, and none of these.
  /// \throws std::invalid_argument when it is not so, or like CovarianceFunction.
  void add_waves(std::span<const Covariance> waves);

  /// All members.
  [[nodiscard]] std::span<const Covariance> members() const { return members_; }
  /// Which of them are tried together.
  [[nodiscard]] std::span<const PriorGroup> groups() const { return groups_; }

 private:
  std::vector<Covariance> members_;
  std::vector<PriorGroup> groups_;
};

/// An innovation list for each member of a bank, of the same positions and averages. Lists grow
/// when they are used, from any thread; those of waves are made then. Each is shared with all
/// others in the process that hold the same (shared_innovations()).
class FREQSYNTH_API BankLists {
 public:
  /// Most samples of a node that waves are tried on: a lattice of 289, and those around it.
  static constexpr std::size_t wave_samples = 448;
  /// So many of its samples tell which waves are: a lattice of 81, and those around it.
  static constexpr std::size_t probe_samples = 176;

  /// \throws std::invalid_argument for a bank without members, or like InnovationList.
  BankLists(const PriorBank& bank, std::span<const UnitPoint> positions, const AverageGrid& grid);
  ~BankLists();
  BankLists(const BankLists&) = delete;
  BankLists& operator=(const BankLists&) = delete;

  /// The bank.
  [[nodiscard]] const PriorBank& bank() const { return bank_; }
  /// Number of members.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The list of a member. Those of waves have `wave_samples` positions at most.
  [[nodiscard]] const InnovationList& operator[](std::size_t member) const {
    return made(lists_[member], member, wave_samples, grid());
  }
  /// Whether the list of a member has been made. All are but those of waves.
  [[nodiscard]] bool is_made(std::size_t member) const {
    return lists_[member].load(std::memory_order_acquire) != nullptr;
  }
  /// A list for the first `probe_samples` positions of a wave, for its evidence alone. It takes a
  /// hundredth of the time to build.
  [[nodiscard]] const InnovationList& probe(std::size_t member) const {
    return made(probes_[member], member, probe_samples, {1, 0.5, 0.001});
  }
  /// Whether waves are tried: where averages are those of a quarter of the node's edge or less.
  [[nodiscard]] bool tries_waves() const { return grid().edge <= 0.25; }
  /// The boxes of the averages.
  [[nodiscard]] const AverageGrid& grid() const { return first().grid(); }
  /// Most samples of a node.
  [[nodiscard]] std::size_t max_samples() const { return first().positions().size(); }
  /// Bytes that the rows built so far take, those that others hold as well included.
  [[nodiscard]] std::size_t memory() const;

 private:
  using Held = std::shared_ptr<const InnovationList>;
  using Slot = std::atomic<const Held*>;

  [[nodiscard]] const InnovationList& first() const {
    return **lists_[0].load(std::memory_order_relaxed);
  }
  const InnovationList& made(Slot& slot, std::size_t member, std::size_t most,
                             const AverageGrid& grid) const {
    const Held* list = slot.load(std::memory_order_acquire);
    return list != nullptr ? **list : make(slot, member, most, grid);
  }
  const InnovationList& make(Slot& slot, std::size_t member, std::size_t most,
                             const AverageGrid& grid) const;

  PriorBank bank_;
  std::size_t size_;
  std::unique_ptr<Slot[]> lists_, probes_;  // null until they are needed
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/prior_bank.inl"
#endif
