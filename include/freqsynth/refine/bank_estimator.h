// SPDX-License-Identifier: MIT
/// \file
/// What a bank of priors makes of the samples of nodes: averages over pixels, and how far they are
/// expected to be off.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

/// How members are weighed.
struct BankSettings {
  /// The log evidence is divided by it, for no prior is right: more averages more. At least 1.
  double temper = 2;
  /// How much of its parent's log posterior a node begins with, 0 to 1.
  double inherit = 0.5;
  /// Waves are tried on a node whose best other prior exceeds the evidence of white noise by less
  /// than this for each sample, a natural logarithm, 0 to 100.
  double badly = 3;
};

/// A node: what is known of it, and where the result goes.
struct BankNode {
  const float* values = nullptr;  ///< finite: one per channel of sample 0, then of sample 1, ...
  std::size_t count = 0;          ///< samples, 1 to BankLists::max_samples()
  const float* parent = nullptr;  ///< log posterior of each member in the parent, or null
  float* averages = nullptr;      ///< receives the averages of channel 0, then those of the next
  float* posterior = nullptr;     ///< receives the log posterior of each member, or null
  /// Receives the expected squared error of each average, its mean over the channels; or null.
  float* squared_errors = nullptr;
  /// Receives by how much the squared error of each average is expected to be greater than the mean
  /// over those within the node, as far as positions tell; or null.
  float* doubts = nullptr;
};

/// Estimates nodes that share positions and a bank.
///
/// The members' evidence is that of the samples of all channels with one unknown scale for all:
/// three channels that are equal say no more than one. Members of little evidence have no part in
/// the average.
///
/// The result for a node does not depend on the others that are estimated with it. An estimator
/// keeps scratch memory, and serves one thread.
class FREQSYNTH_API BankEstimator {
 public:
  /// \param lists     outlives the estimator
  /// \param channels  of a sample, at least 1
  /// \throws std::invalid_argument naming the value when one is out of range.
  BankEstimator(const BankLists& lists, std::size_t channels, const BankSettings& settings = {});

  /// Estimates all nodes; the more at once, up to some hundreds, the faster.
  /// \throws std::invalid_argument naming the count of a node that is out of range.
  void estimate(std::span<BankNode> nodes);

 private:
  void load(std::span<BankNode> nodes);
  void weigh_all();
  void weigh(std::size_t member, std::span<const std::uint32_t> which);
  void weigh_directions(const PriorGroup& group);
  void weigh_waves(const PriorGroup& group);
  void find_badly_explained();
  [[nodiscard]] double log_evidence(double squares, std::size_t node, const InnovationList& list,
                                    std::size_t samples) const;
  void choose();
  void average(std::size_t member);
  [[nodiscard]] double scale_of(std::size_t node, std::size_t member) const;
  void add_variances(std::size_t member);
  void store();
  template <class Done>
  void innovate(const InnovationList& list, std::span<const std::uint32_t> which,
                std::size_t at_most, bool sums, Done done);

  const BankLists& lists_;
  std::size_t channels_;
  BankSettings settings_;

  // Of the nodes at work, those with the most samples first.
  std::vector<BankNode*> nodes_;
  std::vector<std::uint32_t> all_, some_;
  std::vector<float> values_;         // of all lanes, sample by sample; a lane is a node's channel
  std::vector<float> bases_;          // of each lane, what was subtracted
  std::vector<double> floors_;        // of each node: squares that are rounding
  std::vector<double> evidence_;      // nodes x members: log posterior
  std::vector<double> squares_;       // nodes x members: sum of squared innovations
  std::vector<double> later_;         // of each node: the squares of its later innovations
  std::vector<double> best_;          // of each node: the best log evidence so far
  std::vector<std::uint32_t> badly_;  // nodes that waves are tried on
  std::vector<double> probes_;        // of these x waves: log evidence
  std::vector<std::vector<std::uint32_t>> choice_;  // of each wave: the nodes that it may explain
  std::vector<double> averages_;                    // lanes x averages
  std::vector<double> errors_;                      // nodes x averages: mean squares, and variances
  std::vector<double> doubts_;                      // nodes x averages
  std::vector<bool> inside_;                        // which averages are of the node itself
  double inside_count_ = 0;
  std::size_t lanes_ = 0;
  detail::AlignedVector<float> chunk_, innovations_, sums_;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/refine/bank_estimator.inl"
#endif
