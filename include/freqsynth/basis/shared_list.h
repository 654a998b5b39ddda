// SPDX-License-Identifier: MIT
/// \file
/// A list of inverse matrices (inverse_list.h) that several images share.
#pragma once

#include <utility>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/list_settings.h"

namespace freqsynth {

class InverseList;

/// A counted reference to a list, or to none. Copies refer to the same list, which goes with the
/// last of them. Different copies may be used from different threads.
class FREQSYNTH_API SharedInverseList {
 public:
  /// None.
  SharedInverseList() = default;
  /// A new list. \throws std::invalid_argument like InverseList.
  explicit SharedInverseList(const InverseListSettings& settings);
  /// Another reference to the same list.
  SharedInverseList(const SharedInverseList& other) noexcept;
  /// The reference moves; `other` refers to none then.
  SharedInverseList(SharedInverseList&& other) noexcept
      : list_(std::exchange(other.list_, nullptr)) {}
  /// Refers to the list of `other` from now on.
  SharedInverseList& operator=(SharedInverseList other) noexcept {
    std::swap(list_, other.list_);
    return *this;
  }
  ~SharedInverseList();

  /// Whether there is a list.
  explicit operator bool() const { return list_ != nullptr; }
  /// The list; there is one.
  const InverseList& operator*() const;
  /// Members of the list; there is one.
  const InverseList* operator->() const { return &**this; }

  /// Whether both refer to the same list, or to none.
  friend bool operator==(const SharedInverseList& a, const SharedInverseList& b) {
    return a.list_ == b.list_;
  }

 private:
  struct Counted;
  Counted* list_ = nullptr;
};

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/basis/shared_list.inl"
#endif
