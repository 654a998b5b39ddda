// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/shared_list.h"

namespace freqsynth {

struct SharedInverseList::Counted {
  explicit Counted(const InverseListSettings& settings) : list(settings) {}

  InverseList list;
  std::atomic<std::size_t> references{1};
};

FREQSYNTH_INLINE SharedInverseList::SharedInverseList(const InverseListSettings& settings)
    : list_(new Counted(settings)) {}

FREQSYNTH_INLINE SharedInverseList::SharedInverseList(const SharedInverseList& other) noexcept
    : list_(other.list_) {
  if (list_ != nullptr) list_->references.fetch_add(1, std::memory_order_relaxed);
}

FREQSYNTH_INLINE SharedInverseList::~SharedInverseList() {
  if (list_ != nullptr && list_->references.fetch_sub(1, std::memory_order_acq_rel) == 1) {
    delete list_;
  }
}

FREQSYNTH_INLINE const InverseList& SharedInverseList::operator*() const {
  FREQSYNTH_ASSERT(list_ != nullptr);
  return list_->list;
}

}  // namespace freqsynth
