// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/innovation_store.h"
#include "freqsynth/basis/rounding.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {

FREQSYNTH_INLINE PriorBank PriorBank::exact() {
  using enum CovarianceShape;
  PriorBank bank;
  bank.add(Covariance::isotropic(exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(matern32, 0.35, 0.001));
  bank.add(Covariance::isotropic(matern52, 0.4, 0.001));
  bank.add(Covariance::isotropic(matern52, 1.5, 1e-4));
  bank.add(Covariance::isotropic(matern52, 3, 1e-6));
  bank.add(Covariance::isotropic(matern52, 6, 1e-8));
  bank.add_directions(Covariance::oriented(exponential, 20, 1, 0, 0.003), 16);
  bank.add_directions(Covariance::oriented(matern32, 8, 0.4, 0, 0.001), 16);
  bank.add_waves(wave_priors());
  return bank;
}

FREQSYNTH_ROUNDING FREQSYNTH_INLINE std::vector<Covariance> wave_priors() {
  FREQSYNTH_ROUNDING_BEGIN
  constexpr double lowest = 1, highest = 6.25, step = 0.75;
  std::vector<Covariance> waves;
  for (double frequency = lowest; frequency <= highest; frequency += step) {
    const double directions = std::floor(std::numbers::pi * frequency / step + 0.5);
    for (double k = 0; k < directions; ++k) {
      waves.push_back(Covariance::oscillating(CovarianceShape::matern52, 1.2, frequency,
                                              std::numbers::pi * (k + 0.5) / directions, 0.001));
    }
  }
  return waves;
}

FREQSYNTH_INLINE PriorBank PriorBank::noisy() {
  using enum CovarianceShape;
  PriorBank bank;
  bank.add(Covariance::isotropic(exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(matern32, 0.35, 0.001));
  bank.add(Covariance::isotropic(matern52, 0.4, 0.001));
  bank.add(Covariance::isotropic(matern52, 1.5, 1e-4));
  bank.add_directions(Covariance::oriented(exponential, 10, 1, 0, 0.003), 8);
  for (const double noise : {0.1, 0.3, 1.0, 3.0, 10.0, 30.0}) {
    for (const double length : {1.0, 4.0}) {
      bank.add(Covariance::isotropic(exponential, length, noise));
      bank.add(Covariance::isotropic(matern52, length, noise));
    }
  }
  for (const double noise : {0.1, 0.3, 1.0, 3.0}) {
    bank.add_directions(Covariance::oriented(exponential, 15, 1.5, 0, noise), 8);
  }
  return bank;
}

FREQSYNTH_INLINE void PriorBank::add(const Covariance& covariance) {
  const detail::CovarianceFunction checked(covariance);
  groups_.reserve(groups_.size() + 1);
  members_.push_back(covariance);
  groups_.push_back({members_.size() - 1, 1, false});
}

FREQSYNTH_INLINE void PriorBank::add_directions(const Covariance& covariance, std::size_t count) {
  detail::require(count >= 4 && count <= 64 && std::has_single_bit(count), "count",
                  static_cast<double>(count), "4, 8, 16, 32 or 64");
  const detail::CovarianceFunction checked(covariance);
  groups_.reserve(groups_.size() + 1);
  members_.reserve(members_.size() + count);
  const std::size_t first = members_.size();
  for (std::size_t k = 0; k < count; ++k) {
    members_.push_back(covariance);
    members_.back().angle = std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
  }
  groups_.push_back({first, count, true});
}

FREQSYNTH_INLINE void PriorBank::add_waves(std::span<const Covariance> waves) {
  const bool before = std::any_of(groups_.begin(), groups_.end(),
                                  [](const PriorGroup& group) { return group.waves; });
  detail::require(!members_.empty() && !before, "groups().size()",
                  static_cast<double>(groups_.size()), "more than 0, none of them of waves");
  for (const Covariance& wave : waves) const detail::CovarianceFunction checked(wave);
  groups_.reserve(groups_.size() + 1);
  members_.insert(members_.end(), waves.begin(), waves.end());
  groups_.push_back({members_.size() - waves.size(), waves.size(), false, true});
}

FREQSYNTH_INLINE BankLists::BankLists(const PriorBank& bank, std::span<const UnitPoint> positions,
                                      const AverageGrid& grid)
    : bank_(bank), size_(bank.members().size()) {
  detail::require(size_ > 0, "bank.members().size()", 0, "at least 1");
  // Who owns them until all are there.
  std::vector<std::unique_ptr<const Held>> lists(size_);
  for (const PriorGroup& group : bank_.groups()) {
    for (std::size_t k = group.first; !group.waves && k < group.first + group.count; ++k) {
      lists[k] =
          std::make_unique<const Held>(shared_innovations(bank_.members()[k], positions, grid));
    }
  }
  lists_ = std::make_unique<Slot[]>(size_);
  probes_ = std::make_unique<Slot[]>(size_);
  for (std::size_t k = 0; k < size_; ++k) lists_[k] = lists[k].release();
}

FREQSYNTH_INLINE BankLists::~BankLists() {
  for (std::size_t k = 0; k < size_; ++k) {
    delete lists_[k].load(std::memory_order_relaxed);
    delete probes_[k].load(std::memory_order_relaxed);
  }
}

FREQSYNTH_INLINE const InnovationList& BankLists::make(Slot& slot, std::size_t member,
                                                       std::size_t most,
                                                       const AverageGrid& grid) const {
  const std::span<const UnitPoint> all = first().positions();
  auto list = std::make_unique<const Held>(
      shared_innovations(bank_.members()[member], all.first(std::min(most, all.size())), grid));
  // Another thread may have been faster.
  const Held* there = nullptr;
  return slot.compare_exchange_strong(there, list.get()) ? **list.release() : **there;
}

FREQSYNTH_INLINE std::size_t BankLists::memory() const {
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    for (const Slot* slot : {&lists_[k], &probes_[k]}) {
      const Held* list = slot->load(std::memory_order_acquire);
      bytes += list != nullptr ? (*list)->memory() : 0;
    }
  }
  return bytes;
}

}  // namespace freqsynth
