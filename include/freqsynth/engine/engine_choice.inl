// SPDX-License-Identifier: MIT
// How waves are chosen.
#pragma once

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::use_factors() {
  if (!factors_) return;
  choice_.use_factors(view(), std::move(*factors_));
  factors_.reset();
  shares_ = choice_.shares();
}

/// Chooses the next wave. \return why there is none
template <Refiner R, BlockMeasure<R> M>
std::optional<StopReason> Engine<R, M>::prepare_wave() {
  use_factors();
  const std::optional<StopReason> reason = choose_wave();
  probes_.visit(stats_.samples, wave_.samples(),
                [&](std::size_t slot) { wave_.repeat(static_cast<std::uint32_t>(slot)); });
  return reason;
}

/// Chooses the blocks of the next wave. \return why there is none
template <Refiner R, BlockMeasure<R> M>
std::optional<StopReason> Engine<R, M>::choose_wave() {
  if (stats_.samples >= stop_.samples) return reason(StopReason::samples);
  if (!any_usable_ && blocks_.untouched() == 0 && stats_.samples >= patience_) {
    return reason(StopReason::exhausted);
  }
  const std::size_t most = std::min<std::uint64_t>(wave_size_, stop_.samples - stats_.samples);
  reserve(most);
  // In the unit of the priorities. Of a signal that is all 0 so far, everything is below it.
  const int exponent = choice_.in_units() ? units_.exponent() : 0;
  const double rule = std::ldexp(stop_.aliasing_threshold, -exponent);
  const double square = units_.known() || rule == 0 ? rule * rule : double{most_priority};
  const auto threshold = static_cast<float>(std::min(square, double{most_priority}));
  choose_lagging(most);
  while (wave_.size() < most && choice_.top_priority() > threshold) choose(choice_.take());
  if (!wave_.empty()) return std::nullopt;
  if (choice_.top_priority() < 0) return reason(StopReason::exhausted);
  if (stop_.aliasing_threshold > 0) choose_least_sampled(most);
  return wave_.empty() ? std::optional(reason(StopReason::threshold)) : std::nullopt;
}

/// Takes all memory that a wave of `most` positions needs until its values are absorbed, so that
/// nothing can fail on the way.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::reserve(std::size_t most) {
  const std::size_t slots = most + NoiseProbes::most(most);
  wave_.reserve(slots);
  pixels_.reserve(slots);
  // Each sample goes to up to four blocks, and each may go on with its corners and what waits.
  blocks_.reserve(20 * most + cache_.waiting());
  cache_.reserve(most);
  bad_.reserve(std::min(bad_.size() + most, most_bad_reported));
  // With its own sample a block may take in what its neighbours know before and after it.
  const std::size_t reach = 2 * SampleSequence::longest_border_run + 2;
  blocks_.refiner().list().reserve(std::min(blocks_.largest() + reach, blocks_.most_samples()));
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose(std::uint32_t block) {
  const std::uint32_t index = blocks_.samples(block);
  if (!asked_by_neighbour(block, index)) wave_.add({block, index});
  touched_.add(block);
}

/// Chooses blocks that have stayed behind the others.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose_lagging(std::size_t most) {
  if (shares_ == 0 || blocks_.untouched() != 0) return;
  const auto lags = [&](std::uint32_t block, double least) {
    return blocks_.samples(block) < least * double{choice_.share(block)} && !blocks_.full(block);
  };
  exploration_.update(static_cast<double>(stats_.absorbed) / shares_, lags);
  exploration_.visit(lags, [&](std::uint32_t block) {
    if (wave_.size() >= most) return false;
    choice_.take(block);
    choose(block);
    return true;
  });
}

/// Chooses blocks that the threshold may not pass over yet.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose_least_sampled(std::size_t most) {
  for (std::uint32_t block = 0; block < blocks_.size() && wave_.size() < most; ++block) {
    if (blocks_.samples(block) >= stop_.least_samples) continue;
    if (blocks_.full(block) || !choice_.wanted(block)) continue;
    choice_.take(block);
    choose(block);
  }
}

/// Without a usable value no end is a good one.
template <Refiner R, BlockMeasure<R> M>
StopReason Engine<R, M>::reason(StopReason why) const {
  return stats_.samples > 0 && !any_usable_ ? StopReason::unusable : why;
}

template <Refiner R, BlockMeasure<R> M>
bool Engine<R, M>::asked_by_neighbour(std::uint32_t block, std::uint32_t index) const {
  bool asked = false;
  grid_.visit_sharing(block, position(index), [&](std::uint32_t other, std::uint32_t other_index) {
    asked = asked || (touched_.contains(other) && blocks_.samples(other) == other_index);
  });
  return asked;
}

}  // namespace freqsynth
