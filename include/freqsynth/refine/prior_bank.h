// SPDX-License-Identifier: MIT
/// \file
/// A bank of priors (basis/covariance.h), and the shared lists of all its members.
#pragma once

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
};

/// The priors that may explain a node. None is right; those that explain the samples best are
/// averaged.
class FREQSYNTH_API PriorBank {
 public:
  /// None.
  PriorBank() = default;
  /// For functions without noise: four priors from edges to smooth shading and two that are nearly
  /// polynomials, in all directions alike; long edges and long soft ones in 16 directions each.
  [[nodiscard]] static PriorBank exact();
  /// For Monte Carlo estimates: edges and smooth shading below noise of a tenth to thirty times
  /// their variance, and edges in 8 directions.
  [[nodiscard]] static PriorBank noisy();

  /// One more group, of one member. \throws std::invalid_argument like CovarianceFunction.
  void add(const Covariance& covariance);
  /// One more group: a prior in `count` directions, 4 to 64, a power of two.
  /// \throws std::invalid_argument for another count, or like CovarianceFunction.
  void add_directions(const Covariance& covariance, std::size_t count);

  /// All members.
  [[nodiscard]] std::span<const Covariance> members() const { return members_; }
  /// Which of them are tried together.
  [[nodiscard]] std::span<const PriorGroup> groups() const { return groups_; }

 private:
  std::vector<Covariance> members_;
  std::vector<PriorGroup> groups_;
};

/// An innovation list for each member of a bank, of the same positions and averages. Lists grow
/// when they are used, from any thread.
class FREQSYNTH_API BankLists {
 public:
  /// \throws std::invalid_argument for a bank without members, or like InnovationList.
  BankLists(const PriorBank& bank, std::span<const UnitPoint> positions, const AverageGrid& grid);

  /// The bank.
  [[nodiscard]] const PriorBank& bank() const { return bank_; }
  /// Number of members.
  [[nodiscard]] std::size_t size() const { return lists_.size(); }
  /// The list of a member.
  [[nodiscard]] const InnovationList& operator[](std::size_t member) const {
    return *lists_[member];
  }
  /// The boxes of the averages.
  [[nodiscard]] const AverageGrid& grid() const { return lists_.front()->grid(); }
  /// Most samples of a node.
  [[nodiscard]] std::size_t max_samples() const { return lists_.front()->positions().size(); }
  /// Bytes that the rows built so far take.
  [[nodiscard]] std::size_t memory() const;

 private:
  PriorBank bank_;
  std::vector<std::unique_ptr<const InnovationList>> lists_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/prior_bank.inl"
#endif
