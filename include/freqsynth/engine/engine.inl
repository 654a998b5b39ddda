// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/engine.h"
#include "freqsynth/engine/engine_absorb.inl"
#include "freqsynth/engine/engine_choice.inl"
#include "freqsynth/engine/engine_plan.inl"
#include "freqsynth/engine/engine_saved.inl"

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
Engine<R, M>::Engine(const BlockGrid& grid, BlockStore<R> blocks, M measure,
                     std::vector<float> factors, std::size_t wave, double exploration,
                     std::uint64_t seed, Noise noise, std::span<const ChannelRole> apart,
                     std::size_t first)
    : Desk(grid, blocks.refiner().weights(), apart, noise),
      blocks_(std::move(blocks)),
      cache_(grid, blocks_.refiner().channels()),
      units_(blocks_.refiner().weights()),
      signal_(blocks_.refiner().channels()),
      choice_(std::move(measure), std::move(factors)),
      plan_(grid.size()),
      frame_(detail::mix_bits(seed + detail::golden_step)),
      exploration_(exploration, grid.size(), first) {
  const std::size_t most = std::max<std::size_t>(grid.size(), 1);
  wave_size_ = wave != 0 ? std::min(wave, most) : std::max<std::size_t>(most / 32, 1);
  longest_visit_ = wave == 1 ? 1 : longest_visit(blocks_.most_samples());
  shares_ = choice_.shares();
  blocks_.use_units(units_.exponents(), units_.weights());
  choice_.revise_all(view());
  if (grid.size() < least_shared) return;
  taken_.reserve(grid.size());
  squares_.reserve(2 * blocks_.refiner().channels() * grid.size());
  revisions_.reserve(grid.size());
  for (std::size_t i = 0; i < ranges(grid.size()); ++i) rooms_.push_back(blocks_.make_room());
}

/// The lock, once no wave is being taken in.
template <Refiner R, BlockMeasure<R> M>
std::unique_lock<std::mutex> Engine<R, M>::settled() const {
  std::unique_lock lock(mutex_);
  while (team_.active()) {
    lock.unlock();
    team_.finish();
    lock.lock();
  }
  return lock;
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::set_factors(std::vector<float> factors) {
  FREQSYNTH_ASSERT(factors.size() == grid_.size());
  const std::lock_guard lock(mutex_);
  factors_ = std::move(factors);
  ended_.reset();
}

/// Values have come that blocks cannot take in in their units. To change these rounds nothing.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::change_units() {
  const int before = units_.exponent();
  const bool known = units_.known();
  units_.revise(wave_.values());
  blocks_.use_units(units_.exponents(), units_.weights());
  signal_.use_units(units_.exponents(), units_.weights());
  // Where all was 0 it still is. Units grow, once they are known.
  const int growth = known ? units_.exponent() - before : 0;
  choice_.use_units(view(), std::ldexp(1.0f, -2 * growth));
}

/// Looks at a sample as such.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::note(std::size_t number) {
  const Wave::Slot& slot = wave_.slot(number);
  const SequencePosition& place = position(slot.index);
  Desk::note(number, grid_.point(slot.block, place), [&](std::size_t c, float value) {
    if (!is_usable_sample(value)) return false;
    signal_.note(c, value);
    if (place.side == BlockSide::corner) signal_.add(c, value);
    return true;
  });
}

template <Refiner R, BlockMeasure<R> M>
template <class Use>
auto Engine<R, M>::with_snapshot(Use&& use, std::optional<PixelStore>* features) const {
  const std::lock_guard one(snapshot_);
  const bool soon = [&] {
    const std::lock_guard lock(mutex_);
    return !wave_.empty();
  }();
  detail::StateKeeper keeper(blocks_.size(), blocks_.state_size(), soon);
  std::unique_lock lock = settled();
  if (features) features->emplace(apart_.part(ChannelRole::mean_feature));
  const BlockSnapshot<R> snapshot(blocks_, &keeper);
  const bool noisy = noise_ == Noise::present;
  struct Watch {
    const Engine& engine;
    explicit Watch(const Engine& watched, detail::StateKeeper& keeper) : engine(watched) {
      engine.blocks_.watch(&keeper);
    }
    ~Watch() {
      const std::unique_lock lock = engine.settled();
      engine.blocks_.watch(nullptr);
    }
  };
  // Whatever happens before is under the lock still, and the watch ends under it.
  const Watch watch(*this, keeper);
  lock.unlock();
  return use(grid_, snapshot, noisy);
}

}  // namespace freqsynth
