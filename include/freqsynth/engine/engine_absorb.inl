// SPDX-License-Identifier: MIT
// How a complete wave is taken in, by one thread or by several.
//
// Each visit changes its own block only. What concerns all blocks is noted for each, and added up
// by one thread in the order of the visits: so it does not matter which thread takes in which
// visit, nor how many there are.
#pragma once

#include <exception>

#include "freqsynth/engine/shared_work.h"

namespace freqsynth {

/// Takes in the wave, when all of it is there, with the help of an executor and of those that wait.
/// Nothing in it throws but the executor, see reserve(); then the wave is taken in all the same.
/// \param lock  is let go
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::end_of_delivery(std::unique_lock<std::mutex>& lock,
                                   const detail::ExecutorRef& executor) {
  if (team_.active() || !wave_.complete()) return;
  others_ = this->take_in_repeated() && choice_.notice_noise(view());
  if (!units_.fit(wave_.values())) change_units();
  for (std::size_t i = 0; i < wave_.samples(); ++i) note(i);
  take_known();
  const bool helped = !executor.is_serial() || room_.occupied();
  if (!helped || plan_.size() < least_shared || !choice_.apart()) {
    absorb_all();
    finish_wave();
    return room_.wake();
  }
  begin_stage(Stage::absorb);
  team_.begin({this, [](void* self, std::size_t piece) { static_cast<Engine*>(self)->work(piece); },
               [](void* self) { return static_cast<Engine*>(self)->next_stage(); }},
              ranges(plan_.size()));
  lock.unlock();
  room_.wake();
  work_together(executor);
}

/// Helps with the wave until it is taken in.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::work_together(const detail::ExecutorRef& executor) {
  std::exception_ptr error;
  const auto help = [this](std::size_t) { team_.help(); };
  do {
    const std::size_t pieces = team_.left();
    if (pieces <= 1 || error || executor.is_serial()) continue;
    try {
      executor.execute(pieces, TaskRef(help));
    }
    FREQSYNTH_RETHROW_CANCELLATION
    catch (...) {
      error = std::current_exception();
    }
  } while (team_.finish_stage());
  if (error) std::rethrow_exception(error);
}

/// Parts that so many visits are shared in.
template <Refiner R, BlockMeasure<R> M>
std::size_t Engine<R, M>::ranges(std::size_t visits) {
  constexpr std::size_t least = 16, most = 128;
  return std::clamp<std::size_t>(visits / least, 1, most);
}

/// Makes room for what is noted in a stage; there is memory for it.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::begin_stage(Stage stage) {
  stage_ = stage;
  const auto grow = [](auto& list, std::size_t size) {
    if (list.size() < size) list.resize(size);
  };
  grow(taken_, plan_.size());
  grow(squares_, plan_.size() * 2 * blocks_.refiner().channels());
  grow(revisions_, plan_.size());
}

/// Does a piece of a stage.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::work(std::size_t piece) {
  if (stage_ == Stage::revise) {
    // Nobody else needs the cache now.
    if (piece == 0) return keep_for_others();
    --piece;
  }
  const std::size_t visits = plan_.size();
  const std::size_t first = piece * visits / ranges(visits);
  const std::size_t end = (piece + 1) * visits / ranges(visits);
  for (std::size_t i = first; i < end; ++i) {
    if (stage_ == Stage::absorb) {
      prefetch(i, end);
      absorb_apart(i, rooms_[piece]);
    } else {
      revisions_[i] = choice_.revision(view(), plan_, plan_.visits()[i].block, wave_size_ == 1);
    }
  }
}

/// \return its pieces; 0: the wave is taken in
template <Refiner R, BlockMeasure<R> M>
std::size_t Engine<R, M>::next_stage() {
  const std::lock_guard lock(mutex_);
  if (stage_ == Stage::absorb) {
    join();
    if (others_ || (blocks_.untouched() == 0 && !signal_.settled())) {
      finish_wave();
      return 0;
    }
    begin_stage(Stage::revise);
    return 1 + ranges(plan_.size());
  }
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    choice_.enter(plan_.visits()[i].block, revisions_[i]);
  }
  end_wave();
  return 0;
}

/// Lets one thread take in all visits.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::absorb_all() {
  const std::size_t visits = plan_.size();
  for (std::size_t i = 0; i < visits; ++i) {
    prefetch(i, visits);
    absorb(plan_.visits()[i]);
  }
}

/// What is left to do then.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::finish_wave() {
  keep_for_others();
  if (blocks_.untouched() == 0 && !signal_.settled()) {
    signal_.settle(blocks_.refiner().weights());
    choice_.revise_all(view());
  } else if (others_) {
    choice_.revise_all(view());
  } else {
    choice_.revise(view(), plan_, wave_size_ == 1);
  }
  end_wave();
}

/// And after that.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::end_wave() {
  this->close_wave();
  borders_.clear();
  known_.clear();
  plan_.clear();
}

/// The states of blocks lie all over the memory: fetches those that come soon.
/// \param visit  that is next, of those before `end`
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::prefetch(std::size_t visit, std::size_t end) const {
  constexpr std::size_t ahead = 4;
  if (visit + ahead >= end) return;
  const Visit& soon = plan_.visits()[visit + ahead];
  blocks_.prefetch(soon.block, soon.first, soon.count);
}

/// Takes what is known of the visits' samples out of the cache.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::take_known() {
  for (const Known& one : known_) {
    const float* values =
        cache_.take(grid_.column(one.block), grid_.row(one.block), position(one.index));
    FREQSYNTH_ASSERT(values != nullptr);
    wave_.keep_known(values);
  }
}

/// Values of the i-th sample of a visit.
template <Refiner R, BlockMeasure<R> M>
const float* Engine<R, M>::values_of(const Visit& visit, std::size_t i) const {
  const ValueSource& source = plan_.source(visit, visit.first + static_cast<std::uint32_t>(i));
  return source.known ? wave_.known(source.number) : wave_.values(source.number);
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::absorb(const Visit& visit) {
  const std::span<float> changes = std::span(changes_).first(visit.count);
  blocks_.absorb(visit.block, changes, [&](std::size_t i) { return values_of(visit, i); });
  choice_.absorbed(view(), visit.block, changes);
  stats_.absorbed += visit.count;
}

/// The same, while others do so with other visits, but for what concerns all blocks.
/// \param number  of the visit
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::absorb_apart(std::size_t number, AbsorbRoom& room) {
  const Visit& visit = plan_.visits()[number];
  Taken& taken = taken_[number];
  taken.done = visit.count <= most_apart;
  if (!taken.done) return;
  std::array<float, most_apart> changes;
  const std::span<float> all = std::span(changes).first(visit.count);
  taken.done = blocks_.absorb_apart(
      visit.block, all, [&](std::size_t i) { return values_of(visit, i); }, room,
      squares_of(number));
  if (taken.done) taken.sum = choice_.absorbed_apart(view(), visit.block, all);
}

/// The rest of it.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::join() {
  for (AbsorbRoom& room : rooms_) blocks_.join(room);
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    const Visit& visit = plan_.visits()[i];
    if (!taken_[i].done) {
      absorb(visit);
      continue;
    }
    blocks_.join(visit.block, visit.count, squares_of(i));
    choice_.add(taken_[i].sum);
    stats_.absorbed += visit.count;
  }
}

/// Gives samples to the blocks that will need them later.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::keep_for_others() {
  for (const std::uint32_t slot : borders_) {
    const Wave::Slot& asked = wave_.slot(slot);
    const SequencePosition& place = position(asked.index);
    grid_.visit_sharing(asked.block, place, [&](std::uint32_t other, std::uint32_t index) {
      if (index >= blocks_.most_samples() || index < blocks_.samples(other)) return;
      cache_.put(grid_.column(other), grid_.row(other), position(index),
                 {std::as_const(wave_).values(slot), blocks_.refiner().channels()});
    });
  }
}

}  // namespace freqsynth
