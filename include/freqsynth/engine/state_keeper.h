// SPDX-License-Identifier: MIT
/// \file
/// States of blocks as they were at one moment, for a reader, while others change them.
///
/// Whoever is about to change a state that the reader has not read yet saves it first. So nobody
/// waits for the reader, and only what changes under way is copied.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/basis/large_pages.h"

namespace freqsynth {
namespace detail {

/// What is saved of all blocks for one reader, on any number of threads. Takes all memory at the
/// start, room for every state; of that, the system has to provide only what is used.
class StateKeeper {
 public:
  /// \param floats  of a state
  /// \param soon    states are about to change. Then the system is to provide the first of the
  ///                memory here, where nobody waits for it
  StateKeeper(std::size_t blocks, std::size_t floats, bool soon = false)
      : floats_(floats), marks_(blocks), places_(blocks), saved_(memory_of(blocks * floats)) {
    const std::size_t used = soon ? std::min(blocks * floats, ready) : 0;
    for (std::size_t at = 0; at < used; at += page) saved_[at] = 0;
  }

  /// Copies a state as it was.
  /// \param state  where it is
  /// \param reads  how often it will be read in all; after that it need not be saved
  void read(std::size_t block, const float* state, float* out, unsigned reads);
  /// To be called before a state changes, by one thread at a time for each block. Needs no memory.
  void keep(std::size_t block, const float* state);

 private:
  // A mark is the number of reads so far, or one of these.
  static constexpr std::uint8_t busy = 0x20, saved = 0x40, done = 0x80;
  using Mark = std::atomic<std::uint8_t>;

  static constexpr std::size_t ready = std::size_t{1} << 21;  // floats, of 8 MB
  static constexpr std::size_t page = 1024;                   // floats; pages may be larger

  struct Release {
    void operator()(float* memory) const {
      ::operator delete (memory, std::align_val_t{large_page});
    }
  };
  static float* memory_of(std::size_t floats) {
    if (floats > static_cast<std::size_t>(-1) / sizeof(float)) throw std::bad_array_new_length();
    void* const memory = ::operator new (floats * sizeof(float), std::align_val_t{large_page});
    ask_for_large_pages(memory, floats * sizeof(float));
    return static_cast<float*>(memory);
  }
  /// Waits until nobody copies the state, which takes no longer than that, and keeps others from
  /// it, unless the mark is one of `without`. \return the mark
  static std::uint8_t hold(Mark& mark, std::uint8_t without);
  /// Lets others have it.
  static void release(Mark& mark, std::uint8_t value) {
    mark.store(value, std::memory_order_release);
    mark.notify_all();
  }

  std::size_t floats_;
  std::vector<Mark> marks_;
  std::vector<std::uint32_t> places_;  // of states that are saved
  std::unique_ptr<float[], Release> saved_;
  std::atomic<std::uint32_t> saved_count_{0};
};

// ------------------------------------------------------------------------------------ definitions

inline std::uint8_t StateKeeper::hold(Mark& mark, std::uint8_t without) {
  std::uint8_t seen = mark.load(std::memory_order_acquire);
  for (;;) {
    if ((seen & without) != 0) return seen;
    if ((seen & busy) != 0) {
      mark.wait(seen, std::memory_order_acquire);
      seen = mark.load(std::memory_order_acquire);
    } else if (mark.compare_exchange_weak(seen, static_cast<std::uint8_t>(seen | busy),
                                          std::memory_order_acquire)) {
      return seen;
    }
  }
}

inline void StateKeeper::read(std::size_t block, const float* state, float* out, unsigned reads) {
  const std::uint8_t seen = hold(marks_[block], saved);
  if ((seen & saved) != 0) {
    std::copy_n(saved_.get() + places_[block] * floats_, floats_, out);
    return;
  }
  std::copy_n(state, floats_, out);
  const unsigned times = seen + 1u;
  release(marks_[block], times >= reads ? done : static_cast<std::uint8_t>(times));
}

inline void StateKeeper::keep(std::size_t block, const float* state) {
  if ((hold(marks_[block], saved | done) & (saved | done)) != 0) return;
  const std::uint32_t place = saved_count_.fetch_add(1, std::memory_order_relaxed);
  std::copy_n(state, floats_, saved_.get() + place * floats_);
  places_[block] = place;
  release(marks_[block], saved);
}

}  // namespace detail
}  // namespace freqsynth
