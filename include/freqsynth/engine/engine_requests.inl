// SPDX-License-Identifier: MIT
// How requests go out and values come in.
#pragma once

#include "freqsynth/basis/mix_bits.h"

namespace freqsynth {

template <Refiner R, BlockMeasure<R> M>
std::size_t Engine<R, M>::request(std::span<Request> out, Wait wait) {
  std::unique_lock lock = settled();
  while (true) {
    // Asked before anything is looked at: what changes afterwards is news.
    const std::uint64_t news = room_.news();
    if (end()) return 0;
    if (wave_.waiting()) break;
    if (wait == Wait::no || out.empty()) return 0;
    const auto deadline = meter_.deadline();
    lock.unlock();
    room_.wait(news, deadline);
    lock = settled();
  }
  std::size_t most = std::min(out.size(), wave_.waiting_count());
  if (most >= packet_) most -= most % packet_;
  std::size_t count = 0;
  while (count < most) {
    out[count] = make_request(wave_.hand_out());
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

/// All of a request but its ordinal.
template <Refiner R, BlockMeasure<R> M>
Request Engine<R, M>::make_request(std::uint32_t slot) const {
  const Wave::Slot& asked = wave_.slot(slot);
  const SequencePosition& place = position(asked.index);
  const BlockGrid::Point point = grid_.point(asked.block, place);
  const std::size_t side =
      std::min(grid_.block_width(asked.block), grid_.block_height(asked.block));
  // Names take 53 bits.
  const bool again = asked.repeated != Wave::Slot::none;
  const std::uint64_t id =
      grid_.name(asked.block, asked.index, place) | (again ? std::uint64_t{1} << 63 : 0);
  return {.x = point.x,
          .y = point.y,
          .id = id,
          .spacing = place.spacing * static_cast<float>(side),
          .slot = slot,
          .seed = detail::mix_bits(id * detail::golden_step + frame_),
          .pixel = pixels_.pixel(point),
          .ordinal = 0,
          .thread = 0,
          .again = again};
}

/// Claims the slots of all requests. \throws std::invalid_argument, and none is claimed.
template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::claim(std::span<const Request> requests) {
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

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::deliver(std::span<const Request> requests, std::span<const float> values,
                           std::size_t stride, const detail::ExecutorRef& executor) {
  const std::size_t channels = blocks_.refiner().channels() + nearest_.channels();
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
  end_of_delivery(lock, executor);
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::give_back(std::span<const Request> requests) {
  const std::lock_guard lock(mutex_);
  claim(requests);
  for (const Request& request : requests) wave_.recall(request.slot);
  if (!requests.empty()) room_.wake();
}

template <Refiner R, BlockMeasure<R> M>
void Engine<R, M>::abandon(std::span<const Request> requests) {
  std::unique_lock lock(mutex_);
  claim(requests);
  for (const Request& request : requests) wave_.abandon(request.slot);
  stats_.abandoned += requests.size();
  end_of_delivery(lock, {});
}

}  // namespace freqsynth
