// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "freqsynth/engine/host_desk.h"
#include "freqsynth/engine/host_desk_saved.inl"

namespace freqsynth {

template <class Self>
HostDesk<Self>::HostDesk(const BlockGrid& grid, std::span<const float> weights,
                         std::span<const ChannelRole> apart, Noise noise)
    : grid_(grid),
      wave_(weights.size(), apart.size()),
      pixels_(grid),
      apart_(grid, apart),
      noise_(noise),
      errors_(grid.size()) {
  stats_.blocks = grid.size();
  for (const float weight : weights) counts_.push_back(weight > 0);
  const bool none = std::none_of(counts_.begin(), counts_.end(), [](bool one) { return one; });
  if (none) counts_.assign(counts_.size(), true);
}

// --------------------------------------------------------------------------- requests and values

template <class Self>
std::size_t HostDesk<Self>::request(std::span<Request> out, Wait wait) {
  std::unique_lock lock = self().settled();
  while (true) {
    // Asked before anything is looked at: what changes afterwards is news.
    const std::uint64_t news = room_.news();
    if (end()) return 0;
    if (wave_.waiting()) break;
    if (wait == Wait::no || out.empty()) return 0;
    const auto deadline = meter_.deadline();
    lock.unlock();
    room_.wait(news, deadline);
    lock = self().settled();
  }
  std::size_t most = std::min(out.size(), wave_.waiting_count());
  if (most >= packet_) most -= most % packet_;
  std::size_t count = 0;
  while (count < most) {
    out[count] = self().make_request(wave_.hand_out());
    pixels_.prefetch(out[count].pixel);
    ++count;
  }
  // Slots are handed out in their order, those that came back once more.
  for (Request& request : out.first(count)) {
    Wave::Slot& slot = wave_.slot(request.slot);
    if (slot.ordinal == Wave::Slot::no_ordinal) slot.ordinal = pixels_.next(request.pixel);
    slot.id = request.id;
    request.ordinal = slot.ordinal;
  }
  return count;
}

/// Claims the slots of all requests. \throws std::invalid_argument, and none is claimed.
template <class Self>
void HostDesk<Self>::claim(std::span<const Request> requests) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Request& request = requests[i];
    if (wave_.owed(request.slot) && wave_.slot(request.slot).id == request.id) {
      wave_.claim(request.slot);
      continue;
    }
    for (const Request& before : requests.first(i)) wave_.let_go(before.slot);
    detail::refuse("request " + std::to_string(request.id) + " is not owed");
  }
}

template <class Self>
void HostDesk<Self>::deliver(std::span<const Request> requests, std::span<const float> values,
                             std::size_t stride, const detail::ExecutorRef& executor) {
  const std::size_t channels = counts_.size() + apart_.channels();
  const bool packed = stride == 0 || stride == channels;
  if (packed) stride = channels;
  detail::require(stride >= channels, "stride", static_cast<double>(stride),
                  "at least the number of channels");
  // What would lie behind the last values may be there or not.
  const std::size_t most = requests.size() * stride;
  const std::size_t least = requests.empty() ? 0 : most - stride + channels;
  if (values.size() < least || values.size() > most) {
    detail::refuse(std::to_string(values.size()) + " values for " +
                   std::to_string(requests.size()) + " requests of " + std::to_string(channels) +
                   " channels" + (packed ? "" : ", each " + std::to_string(stride) + " apart"));
  }
  std::unique_lock lock(mutex_);
  claim(requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    wave_.deliver(requests[i].slot, values.data() + i * stride);
  }
  self().end_of_delivery(lock, executor);
}

template <class Self>
void HostDesk<Self>::give_back(std::span<const Request> requests) {
  const std::lock_guard lock(mutex_);
  claim(requests);
  for (const Request& request : requests) wave_.recall(request.slot);
  if (!requests.empty()) room_.wake();
}

template <class Self>
void HostDesk<Self>::abandon(std::span<const Request> requests) {
  std::unique_lock lock(mutex_);
  claim(requests);
  for (const Request& request : requests) wave_.abandon(request.slot);
  stats_.abandoned += requests.size();
  self().end_of_delivery(lock, {});
}

// ------------------------------------------------------------------------------------------ ends

template <class Self>
void HostDesk<Self>::set_stop(const StopRule& stop) {
  stop.validate();
  const std::lock_guard lock(mutex_);
  stop_ = stop;
  stop_.samples = stop.most_samples(grid_.width, grid_.height);
  patience_ = stats_.samples + unusable_at_most;
  cancelled_ = false;
  ended_.reset();
  start_clock();
  room_.wake();
}

template <class Self>
std::optional<StopReason> HostDesk<Self>::stopped() {
  const std::unique_lock lock = self().settled();
  if (const std::optional<StopReason> why = end()) return why;
  return wave_.waiting() ? std::nullopt : std::optional(StopReason::waiting);
}

template <class Self>
void HostDesk<Self>::cancel() {
  cancelled_ = true;
  room_.wake();
}

template <class Self>
std::optional<StopReason> HostDesk<Self>::end() {
  if (cancelled_) return StopReason::cancelled;
  if (meter_.out_of_time()) return reason(StopReason::seconds);
  if (wave_.empty()) ended_ = self().prepare_wave();
  return ended_;
}

/// What is done of what the rules allow.
template <class Self>
StopMeter::Shares HostDesk<Self>::shares() const {
  StopMeter::Shares shares{1, self().share_of_blocks()};
  const auto done = static_cast<double>(stats_.samples + wave_.delivered_samples());
  if (stop_.samples == std::numeric_limits<std::uint64_t>::max()) {
    shares.samples = 0;
  } else if (stop_.samples > 0) {
    shares.samples = done / static_cast<double>(stop_.samples);
  }
  // Between what errors of noise and those of smooth pictures do when samples double.
  if (stop_.target_rmse > 0) shares.error = std::pow(stop_.target_rmse / errors_.least(), 1.5);
  return shares;
}

template <class Self>
Progress HostDesk<Self>::progress() const {
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

// ------------------------------------------------------------------------------------ the samples

template <class Self>
void HostDesk<Self>::reserve_wave(std::size_t samples, std::size_t known) {
  const std::size_t slots = samples + NoiseProbes::most(samples);
  wave_.reserve(slots, known);
  pixels_.reserve(slots);
  bad_.reserve(std::min(bad_.size() + samples, most_bad_reported));
}

template <class Self>
void HostDesk<Self>::repeat_some() {
  probes_.visit(stats_.samples, wave_.samples(),
                [&](std::size_t slot) { wave_.repeat(static_cast<std::uint32_t>(slot)); });
}

template <class Self>
bool HostDesk<Self>::take_in_repeated() {
  bool seen = false;
  for (std::size_t i = wave_.samples(); i < wave_.size(); ++i) {
    seen = take_in_repeated(wave_.slot(i), wave_.values(i)) || seen;
  }
  if (!seen || noise_ != Noise::automatic) return false;
  noise_ = Noise::present;
  return true;
}

/// Two values that differ are two estimates, and their mean is a better one. Of a function without
/// noise the first one stays as it is. \return whether they differ
template <class Self>
bool HostDesk<Self>::take_in_repeated(const Wave::Slot& slot, const float* values) {
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

template <class Self>
template <class Take>
void HostDesk<Self>::note(std::size_t slot, const BlockGrid::Point& point, Take&& take) {
  const float* values = wave_.values(slot);
  bool bad = false, ignored = false;
  if (apart_.channels() > 0) ignored = !apart_.add(point, wave_.apart(slot));
  for (std::size_t c = 0; c < counts_.size(); ++c) {
    if (take(c, values[c])) {
      any_usable_ = any_usable_ || counts_[c];
    } else if (counts_[c]) {
      bad = true;
    } else {
      ignored = true;
    }
  }
  if (wave_.abandoned(slot)) return;
  if (!bad) {
    stats_.ignored_bad_samples += ignored ? 1 : 0;
    return;
  }
  ++stats_.bad_samples;
  if (bad_.size() < most_bad_reported) bad_.push_back({point.x, point.y, wave_.slot(slot).id});
}

template <class Self>
void HostDesk<Self>::close_wave() {
  stats_.samples += wave_.samples();
  stats_.probes += wave_.size() - wave_.samples();
  ++stats_.waves;
  wave_.clear();
}

// --------------------------------------------------------------------------------- what is looked

template <class Self>
SynthesisStats HostDesk<Self>::stats() const {
  const std::unique_lock lock = self().settled();
  SynthesisStats stats = stats_;
  stats.samples += wave_.delivered_samples();
  stats.probes += wave_.delivered() - wave_.delivered_samples();
  return stats;
}

template <class Self>
std::vector<BadSample> HostDesk<Self>::bad_samples() const {
  const std::unique_lock lock = self().settled();
  return bad_;
}

template <class Self>
std::vector<float> HostDesk<Self>::channel_pixels(std::size_t channel) const {
  const std::unique_lock lock = self().settled();
  return apart_.pixels(channel);
}

}  // namespace freqsynth
