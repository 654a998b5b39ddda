// SPDX-License-Identifier: MIT
// What the list holds in double, made when it is asked for.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/normal_inverse.h"

namespace freqsynth {

/// What an entry is in double.
struct InverseList::Exact {
  std::vector<double> inverse, gain, border;
};

/// The same updates once more, for those who ask for J^-1 itself.
struct InverseList::Replay {
  std::mutex asking;
  /// State before the first entry of each chunk that was passed. Entry 0 starts from nothing.
  std::vector<std::unique_ptr<const NormalInverse>> states;
  NormalInverse normal;  // before entry `next`
  std::size_t next = 0;

  void step(const Chunk& chunk, Exact* keep);
};

/// Goes on by one entry, which it writes to `keep` unless that is null; its vectors have room.
FREQSYNTH_INLINE void InverseList::Replay::step(const Chunk& chunk, Exact* keep) {
  const std::size_t slot = next % chunk_size;
  std::array<double, max_terms> a, values;
  evaluate_terms(chunk.positions[slot].s, chunk.positions[slot].t, a);
  normal.add_sample(a);
  std::size_t terms = normal.terms();
  if (keep != nullptr) {
    detail::multiply(normal.inverse().values.data(), a.data(), terms, values.data());
    keep->gain.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(terms));
  }
  if (chunk.rows[slot].border != nullptr) {
    normal.add_term(std::span(values).first(terms));
    if (keep != nullptr) {
      keep->border.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(terms));
    }
    ++terms;
  }
  ++next;
  if (keep == nullptr) return;
  const TermMatrix& inverse = normal.inverse();
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      keep->inverse.push_back(0.5 * (inverse(i, j) + inverse(j, i)));
    }
  }
}

FREQSYNTH_INLINE const InverseList::Exact& InverseList::exact(std::size_t index) const {
  const Chunk& own = chunk_of(index);
  std::atomic<const Exact*>& known =
      chunks_[index / chunk_size].load(std::memory_order_relaxed)->exact[index % chunk_size];
  if (const Exact* entry = known.load(std::memory_order_acquire)) return *entry;

  Replay& replay = *replay_;
  const std::lock_guard lock(replay.asking);
  if (const Exact* entry = known.load(std::memory_order_relaxed)) return *entry;
  auto entry = std::make_unique<Exact>();
  const std::size_t terms = own.terms[index % chunk_size];
  entry->inverse.reserve(terms * (terms + 1) / 2);
  entry->gain.reserve(terms);
  entry->border.reserve(terms);
  // From the nearest state before it.
  const std::size_t chunk = std::min(index / chunk_size, replay.states.size());
  if (replay.next > index || replay.next < chunk * chunk_size) {
    replay.normal = chunk == 0 ? NormalInverse() : *replay.states[chunk - 1];
    replay.next = chunk * chunk_size;
  }
  while (replay.next <= index) {
    const std::size_t at = replay.next;
    if (at > 0 && at % chunk_size == 0 && replay.states.size() < at / chunk_size) {
      replay.states.push_back(std::make_unique<const NormalInverse>(replay.normal));
    }
    replay.step(chunk_of(at), at == index ? entry.get() : nullptr);
  }
  known.store(entry.get(), std::memory_order_release);
  return *entry.release();
}

FREQSYNTH_INLINE std::span<const double> InverseList::inverse(std::size_t index) const {
  return exact(index).inverse;
}
FREQSYNTH_INLINE std::span<const double> InverseList::gain(std::size_t index) const {
  return exact(index).gain;
}
FREQSYNTH_INLINE std::span<const double> InverseList::border(std::size_t index) const {
  return exact(index).border;
}

}  // namespace freqsynth
