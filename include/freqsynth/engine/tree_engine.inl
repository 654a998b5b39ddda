// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "freqsynth/engine/tree_engine.h"

namespace freqsynth {

inline TreeEngine::TreeEngine(const TreeSettings& settings, std::vector<float> factors,
                              std::uint64_t seed, Noise noise, std::span<const ChannelRole> apart)
    : HostDesk(
          BlockGrid::of(settings.width, settings.height, settings.weights.size() + apart.size()),
          settings.weights, apart, noise),
      sampler_(settings, &rule_),
      frame_(detail::mix_bits(seed + detail::golden_step)),
      self_(*this) {
  sampler_.use_factors(std::move(factors));
}

inline std::size_t TreeEngine::wave_size() const {
  const TreeSettings& settings = sampler_.settings();
  const std::size_t leaves = std::max<std::size_t>(grid_.size(), 1) << (2 * settings.depth);
  const std::size_t most =
      settings.wave != 0 ? std::min(settings.wave, leaves) : std::max<std::size_t>(leaves / 32, 1);
  return most + NoiseProbes::most(most);
}

inline std::optional<StopReason> TreeEngine::prepare_wave() {
  if (factors_) {
    sampler_.use_factors(std::move(*factors_));
    factors_.reset();
  }
  const std::optional<StopReason> why = choose_wave();
  if (why) return why;
  errors_.pass(stats_.absorbed);
  add_slots();
  repeat_some();
  return std::nullopt;
}

inline std::optional<StopReason> TreeEngine::choose_wave() {
  if (stats_.samples >= stop_.samples) return reason(StopReason::samples);
  if (hopeless() && sampler_.all_sampled()) return reason(StopReason::exhausted);
  if (meets_target()) return reason(StopReason::target_rmse);
  const std::uint64_t left = stop_.samples - stats_.samples;
  reserve_wave(static_cast<std::size_t>(std::min<std::uint64_t>(sampler_.usual_wave(), left)), 0);
  TreeSampler::Limits limits{.samples = left};
  if (stop_.aliasing_threshold > 0) {
    // Priorities are of all pixels of a leaf; the rule is about a block's mean over 64.
    limits.priority = 64 * stop_.aliasing_threshold * stop_.aliasing_threshold;
    limits.least = stop_.least_samples;
  }
  if (!sampler_.plan(limits).empty()) return std::nullopt;
  return reason(sampler_.complete() ? StopReason::exhausted : StopReason::threshold);
}

inline void TreeEngine::add_slots() {
  const std::size_t size = sampler_.planned().size();
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t leaf = sampler_.owner(i);
    wave_.add({.block = leaf, .index = sampler_.tree().node(leaf).samples});
  }
}

inline bool TreeEngine::meets_target() {
  if (stop_.target_rmse == 0 || predict_ == nullptr || !errors_.due(stats_.absorbed)) return false;
  if (!sampler_.all_sampled()) return false;
  const double error = errors_.look(stats_.absorbed, [&] {
    return predict_(context_, sampler_.tree(), noise_ == Noise::present);
  });
  return error <= stop_.target_rmse;
}

inline Request TreeEngine::make_request(std::uint32_t slot) const {
  const std::uint32_t repeated = wave_.slot(slot).repeated;
  const bool again = repeated != Wave::Slot::none;
  Request request = sampler_.planned()[again ? repeated : slot];
  // Names take 63 bits.
  request.id |= again ? std::uint64_t{1} << 63 : 0;
  request.seed = detail::mix_bits(request.id * detail::golden_step + frame_);
  request.pixel = pixels_.pixel({request.x, request.y});
  request.slot = slot;
  request.again = again;
  return request;
}

inline void TreeEngine::end_of_delivery(std::unique_lock<std::mutex>&, const detail::ExecutorRef&) {
  if (halfway_ || !wave_.complete()) return;
  static_cast<void>(take_in_repeated());
  for (std::size_t i = 0; i < wave_.samples(); ++i) {
    const Request& asked = sampler_.planned()[i];
    note(i, {asked.x, asked.y},
         [](std::size_t, float value) { return TreeSampler::usable(value); });
  }
  halfway_ = true;
  try {
    take_in_wave();
  } catch (const std::bad_alloc&) {
    // Answers need no memory; what is left of this waits for settled().
    room_.wake();
  }
}

/// The rest of it, which may be all. \throws std::bad_alloc, and there is a rest still.
inline void TreeEngine::take_in_wave() {
  sampler_.take_in(wave_.values());
  halfway_ = false;
  stats_.absorbed = sampler_.stats().absorbed;
  close_wave();
  room_.wake();
}

/// Far less than what was done where nodes end before they are as deep as they may be.
inline double TreeEngine::share_of_blocks() const {
  double most = 0;
  auto nodes = static_cast<double>(grid_.size());
  for (std::size_t depth = 0; depth <= sampler_.settings().depth; ++depth, nodes *= 4) {
    most += nodes * static_cast<double>(sampler_.settings().noisy ? NodePositions::size
                                                                  : TreeSampler::most);
  }
  return most > 0 ? static_cast<double>(stats_.absorbed) / most : 1;
}

template <class Archive, class Self>
void TreeEngine::list_parts(Archive& archive, Self& self) {
  archive.section("ENGN", [&] { list_desk(archive, self); });
  TreeArchive::sampler(archive, self.sampler_);
  archive.section("FACT", [&] {
    bool others = self.factors_.has_value();
    archive.number(others);
    if constexpr (Archive::loading) {
      if (others) self.factors_.emplace(self.grid_.size());
    }
    if (others) StateArchive::factors(archive, *self.factors_);
  });
  list_pixels(archive, self);
  archive.section("WAVE", [&] {
    if constexpr (Archive::loading) {
      archive.check(self.stats_.absorbed == self.sampler_.stats().absorbed);
      self.reserve_wave(self.sampler_.planned().size(), 0);
      self.add_slots();
    }
    list_slots(archive, self);
  });
  if constexpr (Archive::loading) self.start_clock();
}

}  // namespace freqsynth
