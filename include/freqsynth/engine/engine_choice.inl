// SPDX-License-Identifier: MIT
// How waves are chosen, and when none is.
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
  const std::optional<StopReason> why = choose_wave();
  if (!why) errors_.pass(stats_.absorbed);
  plan_visits();
  this->repeat_some();
  return why;
}

/// Chooses the blocks of the next wave. \return why there is none
template <Refiner R, BlockMeasure<R> M>
std::optional<StopReason> Engine<R, M>::choose_wave() {
  if (stats_.samples >= stop_.samples) return reason(StopReason::samples);
  if (this->hopeless() && blocks_.untouched() == 0) return reason(StopReason::exhausted);
  if (meets_target()) return reason(StopReason::target_rmse);
  const Portion most = portion();
  reserve(most);
  // In the unit of the priorities. Of a signal that is all 0 so far, everything is below it.
  const int exponent = choice_.in_units() ? units_.exponent() : 0;
  const double rule = std::ldexp(stop_.aliasing_threshold, -exponent);
  const double square = units_.known() || rule == 0 ? rule * rule : double{most_priority};
  const auto threshold = static_cast<float>(std::min(square, double{most_priority}));
  choose_lagging(most);
  const std::size_t visit = exploration_.even() ? 1 : most.visit;
  while (plan_.size() < most.blocks && choice_.top_priority() > threshold) {
    choose(choice_.take(), visit);
  }
  if (!plan_.empty()) return std::nullopt;
  if (choice_.top_priority() < 0) return reason(StopReason::exhausted);
  if (stop_.aliasing_threshold > 0) choose_least_sampled(most);
  return plan_.empty() ? std::optional(reason(StopReason::threshold)) : std::nullopt;
}

/// One sample a visit where more could be too many.
template <Refiner R, BlockMeasure<R> M>
typename Engine<R, M>::Portion Engine<R, M>::portion() const {
  const std::uint64_t left = stop_.samples - stats_.samples;
  const std::size_t longest =
      std::min(longest_visit_, longest_visit(std::max<std::size_t>(blocks_.largest(), 1)));
  if (left / longest >= wave_size_) return {wave_size_, longest};
  return {static_cast<std::size_t>(std::min<std::uint64_t>(wave_size_, left)), 1};
}

/// Takes all memory that a wave needs until its values are absorbed, so that nothing can fail on
/// the way.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::reserve(const Portion& most) {
  const std::size_t samples = most.blocks * most.visit;
  // A sample on an edge goes to two blocks. One at a corner goes to four, each of which may go on
  // with its other corners; the blocks that ask for corners ask for one sample each. And each block
  // may take in what waits for it.
  const std::size_t known = 20 * most.blocks + cache_.waiting();
  this->reserve_wave(samples, known);
  plan_.reserve(2 * samples + known);
  borders_.reserve(samples);
  if (known > known_.capacity()) known_.reserve(std::max(known, 2 * known_.capacity()));
  blocks_.reserve(2 * samples + known);
  cache_.reserve(samples);
  // Beside its own samples a block may take in what its neighbours know before and after them.
  const std::size_t reach = most.visit + 2 * SampleSequence::longest_border_run + 2;
  if (changes_.size() < reach) changes_.resize(reach);
  blocks_.refiner().list().reserve(std::min(blocks_.largest() + reach, blocks_.most_samples()));
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose(std::uint32_t block, std::size_t samples) {
  const std::uint32_t first = blocks_.samples(block);
  const std::uint32_t asked =
      visit_length(first, std::min<std::size_t>(samples, blocks_.most_samples() - first));
  plan_.add({.block = block, .first = first, .asked = asked, .count = asked});
}

/// Chooses blocks that have stayed behind the others.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose_lagging(const Portion& most) {
  if (shares_ == 0 || blocks_.untouched() != 0) return;
  const auto lags = [&](std::uint32_t block, double least) {
    return blocks_.samples(block) < least * double{choice_.share(block)} && !blocks_.full(block);
  };
  exploration_.update(static_cast<double>(stats_.absorbed) / shares_, lags);
  exploration_.visit(lags, [&](std::uint32_t block) {
    if (plan_.size() >= most.blocks) return false;
    const double lag = exploration_.least() * double{choice_.share(block)} -
                       static_cast<double>(blocks_.samples(block));
    choice_.take(block);
    choose(block, std::min(most.visit, static_cast<std::size_t>(std::ceil(lag))));
    return true;
  });
}

/// Chooses blocks that the threshold may not pass over yet.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::choose_least_sampled(const Portion& most) {
  for (std::uint32_t block = 0; block < blocks_.size() && plan_.size() < most.blocks; ++block) {
    const std::size_t samples = blocks_.samples(block);
    if (samples >= stop_.least_samples) continue;
    if (blocks_.full(block) || !choice_.wanted(block)) continue;
    choice_.take(block);
    choose(block, std::min(most.visit, stop_.least_samples - samples));
  }
}

template <Refiner R, BlockMeasure<R> M>
double Engine<R, M>::share_of_blocks() const {
  const double most =
      static_cast<double>(blocks_.size()) * static_cast<double>(blocks_.most_samples());
  return most > 0 ? static_cast<double>(stats_.absorbed) / most : 1;
}

/// Whether the expected error is as small as a rule wants it.
template <Refiner R, BlockMeasure<R> M>
bool Engine<R, M>::meets_target() {
  if (stop_.target_rmse == 0 || predict_ == nullptr || !errors_.due(stats_.absorbed)) return false;
  if (blocks_.untouched() > 0) return false;
  const double error = errors_.look(stats_.absorbed, [&] {
    return predict_(context_, grid_, BlockSnapshot<R>(blocks_), noise_ == Noise::present);
  });
  return error <= stop_.target_rmse;
}

}  // namespace freqsynth
