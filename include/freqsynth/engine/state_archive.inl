// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/engine/state_archive.h"

namespace freqsynth {

template <class Archive, class Store>
void StateArchive::blocks_in_range(Archive& archive, Store& blocks) {
  if constexpr (Archive::loading) {
    blocks.untouched_ = blocks.largest_ = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      archive.check(blocks.counts_[b] <= blocks.most_samples_);
      archive.check(blocks.missing_[b] <= blocks.counts_[b]);
      blocks.untouched_ += blocks.counts_[b] == 0 ? 1 : 0;
      blocks.largest_ = std::max<std::size_t>(blocks.largest_, blocks.counts_[b]);
    }
  }
}

/// Each entry belongs to one block, whose entries lead from its last sample to its first.
template <class Archive, class Log>
void StateArchive::gaps(Archive& archive, Log& log, std::span<const std::uint32_t> counts,
                        std::size_t channels) {
  archive.array(log.heads_);
  archive.list(log.entries_, std::numeric_limits<std::uint32_t>::max() - 1, [&](auto& entry) {
    archive.number(entry.gap.sample);
    archive.number(entry.gap.value);
    archive.number(entry.channel);
    archive.number(entry.next);
  });
  if constexpr (Archive::loading) {
    std::size_t seen = 0;
    for (std::size_t b = 0; b < counts.size(); ++b) {
      std::uint32_t before = std::numeric_limits<std::uint32_t>::max(), sample = counts[b];
      for (std::uint32_t at = log.heads_[b]; at != log.none; at = log.entries_[at].next) {
        archive.check(at < log.entries_.size() && at < before);
        const auto& entry = log.entries_[at];
        archive.check(entry.channel < channels && entry.gap.sample < counts[b] &&
                      entry.gap.sample <= sample);
        before = at;
        sample = entry.gap.sample;
        archive.check(++seen <= log.entries_.size());
      }
    }
    archive.check(seen == log.entries_.size());
  }
}

template <class List>
StateArchive::Sides StateArchive::sides_of(const List& list, std::size_t longest) {
  Sides sides;
  for (Side& one : sides) one.counts.assign(1, 0);
  for (std::size_t n = 0; n < longest; ++n) {
    const SequencePosition& position = list.position(n);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const bool own =
          i + static_cast<std::size_t>(BlockSide::left) == static_cast<std::size_t>(position.side);
      if (own) sides[i].partners.push_back(position.partner);
      sides[i].counts.push_back(static_cast<std::uint32_t>(sides[i].partners.size()));
    }
  }
  return sides;
}

/// The values of `count` points of an edge from number `first` on.
template <class Archive, class Cache, class Edge>
void StateArchive::edge(Archive& archive, Cache& cache, Edge& edge, std::uint32_t first,
                        std::uint32_t count) {
  if constexpr (Archive::loading) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto place = static_cast<std::uint32_t>(cache.next_.size());
      cache.pool_.resize(cache.pool_.size() + cache.channels_);
      archive.array(std::span(cache.pool_).last(cache.channels_));
      cache.next_.push_back(Cache::none);
      (i == 0 ? edge.head : cache.next_[edge.tail]) = place;
      edge.tail = place;
      ++cache.waiting_;
    }
    edge.rank = first;
  } else {
    std::uint32_t place = edge.head;
    for (std::uint32_t i = 0; i < count; ++i) {
      FREQSYNTH_ASSERT(place != Cache::none && edge.rank == first);
      archive.array(std::span(cache.pool_).subspan(place * cache.channels_, cache.channels_));
      place = cache.next_[place];
    }
    FREQSYNTH_ASSERT(place == Cache::none);
  }
}

template <class Archive, class Cache, class Store>
void StateArchive::edges(Archive& archive, Cache& cache, const BlockGrid& grid,
                         const Store& blocks) {
  const Sides sides = sides_of(blocks.refiner().list(), blocks.largest());
  // Between a block and one before it, whose common edge has these names.
  const auto between = [&](std::uint32_t block, BlockSide own, std::uint32_t before,
                           BlockSide opposite, auto& between_them) {
    const std::uint32_t here = side(sides, own).counts[blocks.samples(block)];
    const std::uint32_t there = side(sides, opposite).counts[blocks.samples(before)];
    const std::uint32_t first = std::min(here, there);
    std::uint32_t last = first;
    // A block does not get what it may not take.
    const auto& partners = side(sides, here < there ? opposite : own).partners;
    while (last < std::max(here, there) && partners[last] < blocks.most_samples()) ++last;
    edge(archive, cache, between_them, first, last - first);
  };
  const auto columns = static_cast<std::uint32_t>(grid.blocks_x);
  for (std::uint32_t b = 0; b < grid.size(); ++b) {
    const std::size_t at = 2 * std::size_t{b};
    if (grid.column(b) > 0) {
      between(b, BlockSide::left, b - 1, BlockSide::right, cache.edges_[at]);
    }
    if (b >= columns) {
      between(b, BlockSide::top, b - columns, BlockSide::bottom, cache.edges_[at + 1]);
    }
  }
  archive.array(cache.corner_known_);
  for (std::size_t i = 0; i < cache.corner_known_.size(); ++i) {
    archive.check(cache.corner_known_[i] <= 1);
    if (cache.corner_known_[i] == 0) continue;
    archive.array(std::span(cache.corner_values_).subspan(i * cache.channels_, cache.channels_));
  }
}

template <class Archive, class Cache, class Store>
void StateArchive::check_corners(Archive& archive, const Cache& cache, const BlockGrid& grid,
                                 const Store& blocks) {
  constexpr std::size_t corners = 4;  // the first positions
  const auto& list = blocks.refiner().list();
  for (std::uint32_t b = 0; b < grid.size(); ++b) {
    for (std::size_t i = blocks.samples(b); i < std::min(corners, blocks.most_samples()); ++i) {
      const SequencePosition& position = list.position(i);
      const std::size_t corner = cache.corner_at(grid.column(b), grid.row(b), position);
      grid.visit_sharing(b, position, [&](std::uint32_t other, std::uint32_t index) {
        archive.check(index >= blocks.samples(other) || cache.corner_known_[corner] != 0);
      });
    }
  }
}

template <class Archive, class Store>
void StateArchive::check_next(Archive& archive, const BlockGrid& grid, const Store& blocks) {
  const auto& list = blocks.refiner().list();
  for (std::uint32_t b = 0; b < grid.size(); ++b) {
    if (blocks.full(b)) continue;
    grid.visit_sharing(b, list.position(blocks.samples(b)),
                       [&](std::uint32_t other, std::uint32_t index) {
                         archive.check(index >= blocks.samples(other));
                       });
  }
}

template <class Archive, class W>
void StateArchive::wave(Archive& archive, W& wave) {
  using State = typename W::State;
  const std::size_t size = wave.slots_.size();
  archive.count(wave.next_);
  archive.check(wave.next_ <= size);
  for (std::size_t i = 0; i < wave.next_; ++i) {
    auto& state = wave.states_[i];
    archive.number(state);
    archive.number(wave.slots_[i].ordinal);
    archive.check(state <= State::abandoned && state != State::claimed);
    if (state == State::waiting || state == State::owed) continue;
    archive.array(std::span(wave.values_).subspan(i * wave.channels_, wave.channels_));
    archive.array(std::span(wave.apart_values_).subspan(i * wave.apart_, wave.apart_));
  }
  archive.list(wave.returned_, size);
  if constexpr (Archive::loading) {
    std::size_t waiting = 0;
    std::vector<bool> seen(size);
    for (const std::uint32_t slot : wave.returned_) {
      archive.check(slot < wave.next_ && wave.states_[slot] == State::waiting && !seen[slot]);
      seen[slot] = true;
    }
    for (std::size_t i = 0; i < wave.next_; ++i) {
      const State state = wave.states_[i];
      waiting += state == State::waiting ? 1 : 0;
      if (state != State::waiting && state != State::owed) {
        wave.count(static_cast<std::uint32_t>(i));
      }
    }
    archive.check(waiting == wave.returned_.size() && !wave.complete());
    // The last one is handed out first.
    std::vector<std::uint32_t> owed;
    for (std::size_t i = wave.next_; i-- > 0;) {
      if (wave.states_[i] != State::owed) continue;
      wave.states_[i] = State::waiting;
      owed.push_back(static_cast<std::uint32_t>(i));
    }
    wave.returned_.insert(wave.returned_.begin(), owed.begin(), owed.end());
  }
}

}  // namespace freqsynth
