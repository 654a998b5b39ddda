// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "freqsynth/basis/check.h"
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
  return bank;
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

FREQSYNTH_INLINE BankLists::BankLists(const PriorBank& bank, std::span<const UnitPoint> positions,
                                      const AverageGrid& grid)
    : bank_(bank) {
  detail::require(!bank.members().empty(), "bank.members().size()", 0, "at least 1");
  for (const Covariance& member : bank.members()) {
    lists_.push_back(std::make_unique<const InnovationList>(member, positions, grid));
  }
}

FREQSYNTH_INLINE std::size_t BankLists::memory() const {
  std::size_t bytes = 0;
  for (const auto& list : lists_) bytes += list->memory();
  return bytes;
}

}  // namespace freqsynth
