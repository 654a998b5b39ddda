// SPDX-License-Identifier: MIT
#pragma once

#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/mix_bits.h"
#include "freqsynth/engine/engine.h"
#include "freqsynth/engine/engine_absorb.inl"
#include "freqsynth/engine/engine_choice.inl"
#include "freqsynth/engine/engine_end.inl"
#include "freqsynth/engine/engine_plan.inl"
#include "freqsynth/engine/engine_requests.inl"
#include "freqsynth/engine/engine_saved.inl"

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
Engine<R, M>::Engine(const BlockGrid& grid, BlockStore<R> blocks, M measure,
                     std::vector<float> factors, std::size_t wave, double exploration,
                     std::uint64_t seed, Noise noise, std::size_t nearest, std::size_t first)
    : grid_(grid),
      blocks_(std::move(blocks)),
      cache_(grid, blocks_.refiner().channels()),
      units_(blocks_.refiner().weights()),
      signal_(blocks_.refiner().channels()),
      choice_(std::move(measure), std::move(factors)),
      wave_(blocks_.refiner().channels(), nearest),
      pixels_(grid),
      nearest_(grid, nearest),
      noise_(noise),
      plan_(grid.size()),
      frame_(detail::mix_bits(seed + detail::golden_step)),
      exploration_(exploration, grid.size(), first),
      errors_(grid.size()) {
  const std::size_t most = std::max<std::size_t>(grid.size(), 1);
  wave_size_ = wave != 0 ? std::min(wave, most) : std::max<std::size_t>(most / 32, 1);
  longest_visit_ = wave == 1 ? 1 : longest_visit(blocks_.most_samples());
  stats_.blocks = grid.size();
  shares_ = choice_.shares();
  blocks_.use_units(units_.exponents(), units_.weights());
  for (const float weight : units_.weights()) counts_.push_back(weight > 0);
  const bool none = std::none_of(counts_.begin(), counts_.end(), [](bool one) { return one; });
  if (none) counts_.assign(counts_.size(), true);
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

/// Compares the values of positions that were asked for twice. \return whether all priorities are
/// others by that
template <Refiner R, BlockMeasure<R> M>
bool Engine<R, M>::take_in_repeated() {
  bool seen = false;
  for (std::size_t i = wave_.samples(); i < wave_.size(); ++i) {
    seen = take_in_repeated(wave_.slot(i), wave_.values(i)) || seen;
  }
  if (!seen || noise_ != Noise::automatic) return false;
  noise_ = Noise::present;
  return choice_.notice_noise(view());
}

/// Two values that differ are two estimates, and their mean is a better one. Of a function without
/// noise the first one stays as it is. \return whether they differ
template <Refiner R, BlockMeasure<R> M>
bool Engine<R, M>::take_in_repeated(const Wave::Slot& slot, const float* values) {
  float* first = wave_.values(slot.repeated);
  bool differ = false;
  for (std::size_t c = 0; c < counts_.size(); ++c) {
    differ = differ || (counts_[c] && NoiseProbes::differ(first[c], values[c]));
  }
  for (std::size_t c = 0; c < counts_.size(); ++c) {
    if (!is_usable_sample(values[c])) continue;
    if (!is_usable_sample(first[c])) {
      first[c] = values[c];
    } else if (differ) {
      first[c] = 0.5f * first[c] + 0.5f * values[c];
    }
  }
  stats_.differing_probes += differ ? 1 : 0;
  return differ;
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
  const std::size_t channels = blocks_.refiner().channels();
  const Wave::Slot& slot = wave_.slot(number);
  const float* values = wave_.values(number);
  const SequencePosition& place = position(slot.index);
  bool bad = false, ignored = false;
  if (nearest_.channels() > 0) {
    const float* others = wave_.nearest(number);
    nearest_.add(grid_.point(slot.block, place), others);
    for (std::size_t c = 0; c < nearest_.channels(); ++c) {
      ignored = ignored || detail::is_nan(others[c]);
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    if (is_usable_sample(values[c])) {
      signal_.note(c, values[c]);
      if (place.side == BlockSide::corner) signal_.add(c, values[c]);
      any_usable_ = any_usable_ || counts_[c];
    } else if (counts_[c]) {
      bad = true;
    } else {
      ignored = true;
    }
  }
  if (wave_.abandoned(number)) return;
  if (!bad) {
    stats_.ignored_bad_samples += ignored ? 1 : 0;
    return;
  }
  ++stats_.bad_samples;
  if (bad_.size() < most_bad_reported) {
    const BlockGrid::Point point = grid_.point(slot.block, place);
    bad_.push_back({point.x, point.y, slot.id});
  }
}

template <Refiner R, BlockMeasure<R> M>
template <class Use>
auto Engine<R, M>::with_snapshot(Use&& use) const {
  const std::lock_guard one(snapshot_);
  detail::StateKeeper keeper(blocks_.size(), blocks_.state_size());
  std::unique_lock lock = settled();
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

template <Refiner R, BlockMeasure<R> M>
SynthesisStats Engine<R, M>::stats() const {
  const std::unique_lock lock = settled();
  SynthesisStats stats = stats_;
  stats.samples += wave_.delivered_samples();
  stats.probes += wave_.delivered() - wave_.delivered_samples();
  return stats;
}

template <Refiner R, BlockMeasure<R> M>
std::vector<BadSample> Engine<R, M>::bad_samples() const {
  const std::unique_lock lock = settled();
  return bad_;
}

}  // namespace freqsynth
