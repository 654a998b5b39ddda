// SPDX-License-Identifier: MIT
/// \file
/// The half of an engine that faces the host: hands out the requests of a wave, takes their values
/// and lets threads wait for more, until a rule ends it.
///
/// What chooses a wave, and takes it in once it is complete, is the other half: a class that
/// derives from this one.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/channel_settings.h"
#include "freqsynth/engine/error_watch.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/noise.h"
#include "freqsynth/engine/noise_probes.h"
#include "freqsynth/engine/pixel_counts.h"
#include "freqsynth/engine/pixel_store.h"
#include "freqsynth/engine/stop_meter.h"
#include "freqsynth/engine/stop_rule.h"
#include "freqsynth/engine/waiting_room.h"
#include "freqsynth/engine/wave.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

/// All public members may be called from any thread. Each does all that it says or, when it throws,
/// nothing: what was delivered is never lost.
/// \tparam Self  the engine: derives from this, lets it call private members, and has
///   `std::unique_lock<std::mutex> settled() const`, the lock, once no wave is being taken in;
///   and, to be called under the lock,
///   `std::optional<StopReason> prepare_wave()`, which chooses the next wave, or tells why there is
///   none; `Request make_request(std::uint32_t slot) const`, all of a request but its ordinal;
///   `void end_of_delivery(std::unique_lock<std::mutex>& lock, const detail::ExecutorRef&)`, which
///   takes the wave in if it is complete by now; and `double share_of_blocks() const`, the samples
///   so far as a share of those that blocks may have
template <class Self>
class HostDesk {
 public:
  HostDesk(const HostDesk&) = delete;
  HostDesk& operator=(const HostDesk&) = delete;

  /// Sets of how many requests request() hands out multiples, see SynthesisSettings::packet.
  void use_packets(std::size_t size) { packet_ = size; }
  /// That number.
  [[nodiscard]] std::size_t packet() const { return packet_; }

  /// Sets when request() stops, from the next wave on. \throws like StopRule::validate().
  void set_stop(const StopRule& stop);
  /// Hands out up to out.size() positions. \throws std::bad_alloc, and nothing is handed out.
  std::size_t request(std::span<Request> out, Wait wait = Wait::no);
  /// Takes values. \throws std::invalid_argument, and none is taken.
  /// \param executor  helps to take in a wave that is complete by this. What it throws goes on,
  ///                  but all values are taken
  void deliver(std::span<const Request> requests, std::span<const float> values,
               std::size_t stride = 0, const detail::ExecutorRef& executor = {});
  /// Takes requests back without values. \throws std::invalid_argument, and none is taken.
  void give_back(std::span<const Request> requests);
  /// Takes requests back that nobody will answer. \throws std::invalid_argument, and none is taken.
  void abandon(std::span<const Request> requests);
  /// Nothing is handed out any more until set_stop().
  void cancel();
  /// Why nothing is handed out. \throws std::bad_alloc.
  std::optional<StopReason> stopped();

  /// How far it is.
  [[nodiscard]] Progress progress() const;
  /// Whether values are taken for estimates by now.
  [[nodiscard]] bool noisy() const {
    const std::lock_guard lock(mutex_);
    return noise_ == Noise::present;
  }
  /// Counters since the engine's creation.
  [[nodiscard]] SynthesisStats stats() const;
  /// The first bad samples, at most 1000.
  [[nodiscard]] std::vector<BadSample> bad_samples() const;
  /// See PixelStore::pixels().
  [[nodiscard]] std::vector<float> channel_pixels(std::size_t channel) const;

 protected:
  /// Most that bad_samples() returns.
  static constexpr std::size_t most_bad_reported = 1000;
  /// A sampler that has never had a usable value, in every block and in so many samples, is not
  /// asked for more, unless a stop rule is set anew.
  static constexpr std::uint64_t unusable_at_most = 64;

  /// \param weights  of each channel of the blocks; those without one make no sample a bad one,
  ///                 unless all are
  /// \param apart    roles of the channels that come after those, see PixelStore
  /// \param noise    whether probes tell of noise, or what is known of it
  HostDesk(const BlockGrid& grid, std::span<const float> weights,
           std::span<const ChannelRole> apart, Noise noise);
  ~HostDesk() = default;

  // All of these run under the lock.
  /// Why nothing is handed out, whether or not something is owed. Chooses the next wave, if none is
  /// under way.
  std::optional<StopReason> end();
  /// Without a usable value no end is a good one.
  [[nodiscard]] StopReason reason(StopReason why) const {
    return stats_.samples > 0 && !any_usable_ ? StopReason::unusable : why;
  }
  /// Whether a sampler whose blocks all have samples is to be asked no more.
  [[nodiscard]] bool hopeless() const { return !any_usable_ && stats_.samples >= patience_; }
  /// Makes room for so many samples of a wave, and for what is noted of them.
  void reserve_wave(std::size_t samples, std::size_t known);
  /// Adds the slots of those samples of a wave that are asked for twice.
  void repeat_some();
  /// Compares the values of positions that were asked for twice. \return whether that has told of
  /// noise
  [[nodiscard]] bool take_in_repeated();
  /// Notes where a sample of a complete wave was bad, and what it says of pixels.
  /// \param take  take(channel, value) of each value of a block; returns whether it is usable
  template <class Take>
  void note(std::size_t slot, const BlockGrid::Point& point, Take&& take);
  /// Counts a wave that was taken in.
  void close_wave();
  /// Starts the clock of the rules.
  void start_clock() { meter_.begin(stop_.seconds, shares()); }

  /// Lists all but the wave for an archive.
  template <class Archive, class Engine>
  static void list_desk(Archive& archive, Engine& self);
  /// Lists the pixels.
  template <class Archive, class Engine>
  static void list_pixels(Archive& archive, Engine& self);
  /// Lists what has become of a wave whose samples have their slots, when it is loaded too.
  template <class Archive, class Engine>
  static void list_slots(Archive& archive, Engine& self);

  // What an engine shares with its desk.
  BlockGrid grid_;                   ///< the blocks of what is sampled
  Wave wave_;                        ///< that is under way
  PixelCounts pixels_;               ///< requests of each pixel
  PixelStore apart_;                 ///< channels without coefficients
  NoiseProbes probes_;               ///< positions that are asked for twice
  Noise noise_;                      ///< what is known of it
  StopRule stop_;                    ///< when requests end
  ErrorWatch errors_;                ///< when the predicted error is to be looked at
  std::optional<StopReason> ended_;  ///< why there is no wave
  WaitingRoom room_;                 ///< where threads wait for requests
  SynthesisStats stats_;             ///< counters, of complete waves
  mutable std::mutex mutex_;         ///< the lock

 private:
  [[nodiscard]] Self& self() { return static_cast<Self&>(*this); }
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
  [[nodiscard]] StopMeter::Shares shares() const;
  void claim(std::span<const Request> requests);
  bool take_in_repeated(const Wave::Slot& slot, const float* values);

  std::size_t packet_ = 1;  // requests
  StopMeter meter_;
  std::atomic<bool> cancelled_{false};
  std::vector<bool> counts_;  // channels whose values can make a sample bad
  bool any_usable_ = false;   // whether there was a usable value
  std::uint64_t patience_ = unusable_at_most;
  std::vector<BadSample> bad_;
};

}  // namespace freqsynth

#include "freqsynth/engine/host_desk.inl"
