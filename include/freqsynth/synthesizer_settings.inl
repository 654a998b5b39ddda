// SPDX-License-Identifier: MIT
// What the settings of a synthesis must be, and what follows from them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/basis/float_bits.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/steering.h"

namespace freqsynth {
namespace detail {

/// The channels of that role.
inline std::vector<std::size_t> channels_of(const SynthesisSettings& settings, ChannelRole role) {
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < settings.channel_settings.size(); ++c) {
    if (settings.channel_settings[c].role == role) channels.push_back(c);
  }
  return channels;
}

/// Roles of the channels that have no coefficients: the last ones.
inline std::vector<ChannelRole> roles_apart(const SynthesisSettings& settings) {
  std::vector<ChannelRole> roles;
  for (const ChannelSettings& one : settings.channel_settings) {
    if (!has_coefficients(one.role)) roles.push_back(one.role);
  }
  return roles;
}

/// Number of channels that images have: the first ones.
inline std::size_t image_channels(const SynthesisSettings& settings) {
  return settings.channels - roles_apart(settings).size();
}

/// Of a channel without coefficients.
inline const char* name_of(ChannelRole role) {
  if (role == ChannelRole::nearest) return "nearest";
  return role == ChannelRole::mean ? "mean" : "mean_feature";
}

inline void check_channels(const SynthesisSettings& settings) {
  const std::vector<ChannelSettings>& all = settings.channel_settings;
  if (all.empty()) return;
  if (all.size() != settings.channels) {
    refuse("channel_settings has " + std::to_string(all.size()) + " entries for " +
           std::to_string(settings.channels) + " channels");
  }
  const std::size_t fitted = image_channels(settings);
  if (fitted == 0) {
    refuse("channel_settings has " + std::to_string(all.size()) +
           " channels without coefficients, not at least one other");
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c].role > ChannelRole::mean_feature) {
      refuse("one of channel_settings' roles is " + std::to_string(static_cast<int>(all[c].role)) +
             ", not steer, passive, feature, nearest, mean or mean_feature");
    }
    if (c < fitted && !has_coefficients(all[c].role)) {
      refuse("channel_settings has the role " + std::string(name_of(all[c].role)) +
             " for channel " + std::to_string(c) + ", not after all others");
    }
    const float weight = all[c].weight;
    require(all[c].role != ChannelRole::steer ||
                (is_finite(weight) && weight >= 1e-30f && weight <= 1e6f),
            "one of channel_settings' weights", weight, "in 1e-30..1e6");
  }
}

/// Weight of each channel that has coefficients: shares of 1, and 0 for those that do not steer.
inline std::vector<float> channel_weights(const SynthesisSettings& settings) {
  std::vector<ChannelSettings> all = settings.channel_settings;
  if (all.empty()) all.resize(settings.channels);
  all.resize(image_channels(settings));
  double sum = 0;
  for (ChannelSettings& one : all) {
    if (one.role != ChannelRole::steer) one.weight = 0;
    sum += double{one.weight};
  }
  std::vector<float> weights;
  for (const ChannelSettings& one : all) {
    weights.push_back(one.weight > 0 ? static_cast<float>(double{one.weight} / sum) : 0);
  }
  return weights;
}

/// \param blocks  of the whole picture
inline void check_importance(std::span<const float> importance, std::size_t blocks) {
  if (!importance.empty() && importance.size() != blocks) {
    refuse("importance has " + std::to_string(importance.size()) + " entries for " +
           std::to_string(blocks) + " blocks");
  }
  for (const float factor : importance) {
    // Smaller factors than that would make priorities nothing at all.
    const bool in_range = factor >= 1e-6f && factor <= 1e6f;
    require(is_finite(factor) && (factor == 0 || in_range), "one of importance", factor,
            "0 or in 1e-6..1e6");
  }
}

/// Settings that are in range, with a list.
/// \param blocks  of the whole picture
inline SynthesisSettings validated(SynthesisSettings settings, std::size_t blocks) {
  require(settings.refiner <= RefinerKind::kriging, "refiner",
          static_cast<double>(settings.refiner), "least_squares or kriging");
  settings.priority.validate();
  if (settings.max_samples_per_block == 0 ||
      settings.max_samples_per_block > SampleSequence::max_size) {
    refuse("max_samples_per_block is " + std::to_string(settings.max_samples_per_block) +
           ", not in 1.." + std::to_string(SampleSequence::max_size));
  }
  if (settings.packet == 0 || settings.packet > std::size_t{1} << 20) {
    refuse("packet is " + std::to_string(settings.packet) + ", not in 1..1048576");
  }
  if (settings.least_samples_per_block > settings.max_samples_per_block) {
    refuse("least_samples_per_block is " + std::to_string(settings.least_samples_per_block) +
           ", not in 0.." + std::to_string(settings.max_samples_per_block));
  }
  check_importance(settings.importance, blocks);
  check_channels(settings);
  if (settings.quantization) {
    settings.quantization->validate(image_channels(settings));
    require(settings.priority.steer == Steer::linear, "priority.steer",
            static_cast<double>(settings.priority.steer), "linear, with a quantization target");
  }
  const bool needs_list = settings.refiner == RefinerKind::least_squares;
  if (needs_list && !settings.shared_list) settings.shared_list = SharedInverseList(settings.list);
  return settings;
}

/// The blocks that are sampled for a part of a picture.
inline BlockGrid sampled_grid(const SynthesisSettings& settings) {
  // What shows in a block's finished pixels lies in it, in those around it, and around these.
  constexpr std::size_t margin = 2;
  const BlockGrid whole = BlockGrid::of(settings.width, settings.height, settings.channels);
  const PixelWindow& window = settings.window;
  if (window.x == 0 && window.y == 0 && window.width == 0 && window.height == 0) return whole;
  whole.check(window);
  return whole.part(window, margin);
}

/// Factor on the priority of each block: its importance times its area.
/// \param importance  of all blocks of the frame, or empty
inline std::vector<float> factors_of(const BlockGrid& grid, std::span<const float> importance) {
  std::vector<float> factors(grid.size());
  for (std::size_t b = 0; b < factors.size(); ++b) {
    factors[b] = grid.area(b);
    if (!importance.empty()) factors[b] *= importance[grid.in_frame(b)];
  }
  return factors;
}

/// With the host's weights of the channels.
inline Steering steering_of(const SynthesisSettings& settings, std::size_t blocks) {
  return {settings.priority, settings.noise == Noise::present, channel_weights(settings), blocks};
}

/// With what the engine knows of noise, unless the settings say otherwise.
inline FinishSettings settings_for(FinishSettings settings, bool noisy) {
  if (settings.noise == Noise::automatic) settings.noise = noisy ? Noise::present : Noise::none;
  return settings;
}

}  // namespace detail

}  // namespace freqsynth
