// SPDX-License-Identifier: MIT
// When an engine ends, and how far it is.
#pragma once

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::set_stop(const StopRule& stop) {
  stop.validate();
  const std::lock_guard lock(mutex_);
  stop_ = stop;
  stop_.samples = stop.most_samples(grid_.width, grid_.height);
  patience_ = stats_.samples + unusable_at_most;
  cancelled_ = false;
  ended_.reset();
  meter_.begin(stop.seconds, shares());
  room_.wake();
}

template <Refiner R, BlockMeasure<R> M>
std::optional<StopReason> Engine<R, M>::stopped() {
  const std::unique_lock lock = settled();
  if (const std::optional<StopReason> why = end()) return why;
  return wave_.waiting() ? std::nullopt : std::optional(StopReason::waiting);
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::cancel() {
  cancelled_ = true;
  room_.wake();
}

/// Why nothing is handed out, whether or not something is owed. Chooses the next wave, if none is
/// under way.
template <Refiner R, BlockMeasure<R> M>
std::optional<StopReason> Engine<R, M>::end() {
  if (cancelled_) return StopReason::cancelled;
  if (meter_.out_of_time()) return reason(StopReason::seconds);
  if (wave_.empty()) ended_ = prepare_wave();
  return ended_;
}

template <Refiner R, BlockMeasure<R> M>
StopMeter::Shares Engine<R, M>::shares() const {
  StopMeter::Shares shares{1, 1};
  const auto done = static_cast<double>(stats_.samples + wave_.delivered_samples());
  if (stop_.samples == std::numeric_limits<std::uint64_t>::max()) {
    shares.samples = 0;
  } else if (stop_.samples > 0) {
    shares.samples = done / static_cast<double>(stop_.samples);
  }
  const double most =
      static_cast<double>(blocks_.size()) * static_cast<double>(blocks_.most_samples());
  if (most > 0) shares.blocks = static_cast<double>(stats_.absorbed) / most;
  // Between what errors of noise and those of smooth pictures do when samples double.
  if (stop_.target_rmse > 0) shares.error = std::pow(stop_.target_rmse / errors_.least(), 1.5);
  return shares;
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

template <Refiner R, BlockMeasure<R> M>
Progress Engine<R, M>::progress() const {
  const std::lock_guard lock(mutex_);
  // Without a wave under way, the last sample is the end.
  const StopMeter::Shares now = shares();
  const bool done = wave_.empty() && (now.samples >= 1 || now.blocks >= 1);
  Progress progress = meter_.progress(now, done || ended_);
  progress.samples = stats_.samples + wave_.delivered_samples();
  progress.revision = stats_.waves;
  progress.predicted_rmse = errors_.last();
  return progress;
}

}  // namespace freqsynth
