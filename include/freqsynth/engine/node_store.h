// SPDX-License-Identifier: MIT
/// \file
/// Memory for the samples of nodes: it grows with them, without an allocation for each, and what a
/// node gives back the next one gets.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/config.h"

namespace freqsynth {

/// Chunks of one head and some rows of floats each. Rows have room for 8 to 1096 samples, in steps
/// that complete lattices fit; heads and rows start at multiples of 32 bytes. Chunks do not move.
class NodeStore {
 public:
  /// Room of the rows, by size.
  static constexpr std::array<std::uint32_t, 9> rooms = {8, 16, 32, 56, 88, 152, 296, 584, 1096};

  /// A part of the memory, or none.
  struct Chunk {
    float* data = nullptr;  ///< its head; the rows follow
    std::uint8_t step = 0;  ///< number of its room in `rooms`

    /// Whether there is one.
    explicit operator bool() const { return data != nullptr; }
    /// Samples that a row has room for.
    [[nodiscard]] std::size_t room() const { return data != nullptr ? rooms[step] : 0; }
  };

  /// \param head  floats in the head of each chunk
  /// \param rows  rows in each
  NodeStore(std::size_t head, std::size_t rows) : head_((head + 7) / 8 * 8), rows_(rows) {}

  /// A row of a chunk.
  [[nodiscard]] float* row(const Chunk& chunk, std::size_t number) const {
    return chunk.data + head_ + number * chunk.room();
  }

  /// A chunk of zeros with room for so many samples, 1 to 1096. \throws std::bad_alloc.
  [[nodiscard]] Chunk take(std::size_t samples);
  /// Gives a chunk more room; what rows hold beyond `used` samples becomes 0.
  /// \throws std::bad_alloc, and it is as it was.
  void enlarge(Chunk& chunk, std::size_t used, std::size_t samples);
  /// A chunk with what one of another store, with heads and rows like these, holds.
  /// \throws std::bad_alloc.
  [[nodiscard]] Chunk copy(const Chunk& other) {
    const Chunk chunk = take(other.room());
    std::copy_n(other.data, floats(chunk.step), chunk.data);
    return chunk;
  }
  /// Takes a chunk back, which becomes none.
  void give_back(Chunk& chunk) {
    if (!chunk) return;
    // There is room: see take().
    free_[chunk.step].push_back(chunk.data);
    in_use_ -= floats(chunk.step);
    chunk = {};
  }

  /// Bytes of all chunks, those that are free included.
  [[nodiscard]] std::size_t bytes() const { return slabs_.size() * slab_ * sizeof(float); }
  /// Bytes of the chunks that are in use.
  [[nodiscard]] std::size_t bytes_in_use() const { return in_use_ * sizeof(float); }

 private:
  [[nodiscard]] std::size_t floats(std::size_t step) const { return head_ + rows_ * rooms[step]; }

  std::size_t head_, rows_;
  std::size_t slab_ = 0;  // floats of each slab
  std::size_t left_ = 0;  // of the last one
  std::size_t in_use_ = 0;
  std::vector<detail::AlignedVector<float>> slabs_;
  std::array<std::vector<float*>, rooms.size()> free_;
  std::array<std::size_t, rooms.size()> made_{};  // chunks of each room
};

// ------------------------------------------------------------------------------------ definitions

inline NodeStore::Chunk NodeStore::take(std::size_t samples) {
  FREQSYNTH_ASSERT(samples > 0 && samples <= rooms.back());
  std::uint8_t step = 0;
  while (rooms[step] < samples) ++step;
  const std::size_t wanted = floats(step);
  std::vector<float*>& free = free_[step];
  Chunk chunk{nullptr, step};
  if (!free.empty()) {
    chunk.data = free.back();
    free.pop_back();
  } else {
    if (left_ < wanted) {
      if (slab_ == 0) slab_ = std::max<std::size_t>(std::size_t{1} << 16, floats(rooms.size() - 1));
      slabs_.emplace_back(slab_);
      left_ = slab_;
    }
    if (made_[step] + 1 > free.capacity()) free.reserve(2 * made_[step] + 8);
    ++made_[step];
    chunk.data = slabs_.back().data() + (slab_ - left_);
    left_ -= wanted;
  }
  std::fill(chunk.data, chunk.data + wanted, 0.0f);
  in_use_ += wanted;
  return chunk;
}

inline void NodeStore::enlarge(Chunk& chunk, std::size_t used, std::size_t samples) {
  if (chunk.room() >= samples) return;
  Chunk larger = take(samples);
  if (chunk) {
    std::copy(chunk.data, chunk.data + head_, larger.data);
    for (std::size_t i = 0; i < rows_; ++i) {
      const float* from = row(chunk, i);
      std::copy(from, from + used, row(larger, i));
    }
  }
  give_back(chunk);
  chunk = larger;
}

}  // namespace freqsynth
