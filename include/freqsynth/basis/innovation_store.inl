// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/innovation_store.h"
#include "freqsynth/basis/mix_bits.h"

namespace freqsynth {
namespace detail {

/// The lists that somebody holds.
class InnovationStore {
 public:
  /// Of the process. Never destroyed: static objects may hold engines.
  static InnovationStore& instance() {
    static InnovationStore& store = *new InnovationStore;
    return store;
  }

  std::shared_ptr<const InnovationList> get(const Covariance& covariance,
                                            std::span<const UnitPoint> positions,
                                            const AverageGrid& grid) {
    const std::uint64_t key = key_of(covariance, positions);
    {
      const std::lock_guard lock(mutex_);
      if (auto list = find(key, covariance, positions, grid)) return list;
    }
    // To make one takes a while; others need not wait for it.
    auto made = std::make_shared<const InnovationList>(covariance, positions, grid);
    const std::lock_guard lock(mutex_);
    if (auto list = find(key, covariance, positions, grid)) return list;
    if (entries_.size() == entries_.capacity()) forget();
    entries_.insert(std::lower_bound(entries_.begin(), entries_.end(), key, before), {key, made});
    return made;
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    std::weak_ptr<const InnovationList> list;
  };

  static bool before(const Entry& entry, std::uint64_t key) { return entry.key < key; }

  static std::uint64_t key_of(const Covariance& covariance, std::span<const UnitPoint> positions) {
    std::uint64_t key = positions.size();
    const auto add = [&key](double value) {
      key = mix_bits(key ^ std::bit_cast<std::uint64_t>(value + 0.0));  // -0 is 0
    };
    for (const double value : {covariance.along, covariance.across, covariance.angle,
                               covariance.frequency, covariance.noise}) {
      add(value);
    }
    for (const UnitPoint& point : positions) {
      add(point.s);
      add(point.t);
    }
    return key;
  }

  std::shared_ptr<const InnovationList> find(std::uint64_t key, const Covariance& covariance,
                                             std::span<const UnitPoint> positions,
                                             const AverageGrid& grid) const {
    const auto same = [](const UnitPoint& a, const UnitPoint& b) {
      return a.s == b.s && a.t == b.t;
    };
    for (auto at = std::lower_bound(entries_.begin(), entries_.end(), key, before);
         at != entries_.end() && at->key == key; ++at) {
      auto list = at->list.lock();
      if (list != nullptr && list->covariance() == covariance && list->grid() == grid &&
          std::equal(positions.begin(), positions.end(), list->positions().begin(),
                     list->positions().end(), same)) {
        return list;
      }
    }
    return nullptr;
  }

  /// Entries of lists that have gone, before room for more is made.
  void forget() {
    std::erase_if(entries_, [](const Entry& entry) { return entry.list.expired(); });
    entries_.reserve(2 * entries_.size() + 16);
  }

  std::mutex mutex_;
  std::vector<Entry> entries_;  // sorted by key
};

}  // namespace detail

FREQSYNTH_INLINE std::shared_ptr<const InnovationList> shared_innovations(
    const Covariance& covariance, std::span<const UnitPoint> positions, const AverageGrid& grid) {
  return detail::InnovationStore::instance().get(covariance, positions, grid);
}

}  // namespace freqsynth
