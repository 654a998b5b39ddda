// SPDX-License-Identifier: MIT
/// \file
/// Random settings, stop rules and samplers, and hosts that ask in random portions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/oracles.h"

namespace helpers {

/// A synthesis of a few blocks of any kind. Of the same number it is the same.
struct RandomSynthesis {
  freqsynth::SynthesisSettings settings;
  freqsynth::StopRule stop;
  float scale = 1;          // of the values
  float noise = 0;          // of these, relative
  unsigned bad_of = 0;      // of so many samples one has no usable value; 0: none
  unsigned abandon_of = 0;  // of so many requests one is never answered; 0: none
  float level = 0;

  /// \param larger  so many times as wide and high, and waves in proportion
  explicit RandomSynthesis(unsigned number, std::size_t larger = 1);

  /// The values of a request; they depend on it alone.
  void sample(const freqsynth::Request& request, std::span<float> out) const {
    std::uint64_t bits = request.seed;
    const auto random = [&] {
      bits = bits * 6364136223846793005u + 1442695040888963407u;
      return static_cast<float>(bits >> 40) / 16777216.0f;
    };
    for (std::size_t c = 0; c < out.size(); ++c) {
      const double turn = 0.3 + 0.1 * static_cast<double>(c);
      const double wave = std::sin(turn * request.x) * std::cos(0.2 * request.y);
      const double edge = request.x + 0.7 * request.y > 11 ? 0.8 : -0.1;
      out[c] = scale * (level + static_cast<float>(wave + edge) + noise * random());
    }
    if (bad_of == 0 || request.id % bad_of != 0) return;
    constexpr std::array bad{std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity(), 2e36f, -1e37f, 3e35f};
    out[request.id / bad_of % out.size()] = bad[request.id / 7 % bad.size()];
  }
};

inline RandomSynthesis::RandomSynthesis(unsigned number, std::size_t larger) {
  using namespace freqsynth;
  oracle::Random random(number);
  const auto chance = [&](double share) { return random.uniform(0, 1) < share; };
  settings.width = larger * (1 + random.below(chance(0.2) ? 60 : 26));
  settings.height = larger * (1 + random.below(26));
  settings.channels = 1 + random.below(4);
  settings.seed = random.below(3);
  settings.wave = chance(0.3) ? 1 : random.below(20) * larger * larger;
  settings.noise = static_cast<Noise>(random.below(3));
  settings.max_samples_per_block = chance(0.3) ? 1 + random.below(60) : 4000;
  if (chance(0.2)) settings.list.positions = SamplePositions::lattice;
  if (chance(0.2)) settings.list.max_terms = 1 + random.below(64);
  PrioritySettings& priority = settings.priority;
  if (chance(0.3)) priority.measure = PriorityMeasure::change;
  if (chance(0.5)) priority.steer = static_cast<Steer>(random.below(3));
  if (chance(0.2)) priority.exploration = random.uniform(0, 1);
  if (chance(0.5)) {
    settings.channel_settings.resize(settings.channels);
    for (ChannelSettings& one : settings.channel_settings) {
      one.role = static_cast<ChannelRole>(random.below(3));
      one.weight = static_cast<float>(random.uniform(0.1, 3));
    }
    // The last one, and perhaps the one before it.
    for (std::size_t c = settings.channels; c-- > 1 && c + 2 >= settings.channels && chance(0.5);) {
      settings.channel_settings[c].role =
          static_cast<ChannelRole>(static_cast<unsigned>(ChannelRole::nearest) + random.below(3));
    }
  }
  const std::size_t blocks = (settings.width + 7) / 8 * ((settings.height + 7) / 8);
  if (chance(0.3)) {
    for (std::size_t b = 0; b < blocks; ++b) {
      settings.importance.push_back(chance(0.3) ? 0 : static_cast<float>(random.uniform(0.01, 4)));
    }
  }
  if (chance(0.2)) {
    PixelWindow& window = settings.window;
    window.x = random.below(settings.width);
    window.y = random.below(settings.height);
    window.width = 1 + random.below(settings.width - window.x);
    window.height = 1 + random.below(settings.height - window.y);
  }
  scale = chance(0.3) ? static_cast<float>(std::exp(random.uniform(-60, 60))) : 1;
  if (chance(0.4)) noise = static_cast<float>(random.uniform(0, 0.5));
  if (chance(0.3)) level = static_cast<float>(random.uniform(-20, 20));
  if (chance(0.4)) bad_of = 2 + static_cast<unsigned>(random.below(40));
  if (chance(0.2)) abandon_of = 5 + static_cast<unsigned>(random.below(90));
  if (chance(0.2)) {
    priority.steer = Steer::linear;
    settings.quantization.emplace();
    std::size_t channels = settings.channels;
    for (const ChannelSettings& one : settings.channel_settings) {
      channels -= has_coefficients(one.role) ? 0 : 1;
    }
    settings.quantization->steps.resize(channels);
    for (auto& steps : settings.quantization->steps) {
      for (float& step : steps)
        step = std::max(scale, 1e-30f) * static_cast<float>(random.uniform(0.1, 9));
    }
    settings.quantization->most_samples = 1 + random.below(300);
  }
  stop.samples = random.below(60 * blocks + 1);
  if (chance(0.3)) stop.aliasing_threshold = 0.05 * static_cast<double>(scale);
}

/// Asks in random portions, keeps some for a while, gives some back, and delivers out of order.
class RandomHost {
 public:
  RandomHost(const RandomSynthesis& synthesis, unsigned number)
      : synthesis_(synthesis), random_(number) {}

  /// Some calls. \return false at the end
  bool step(freqsynth::Synthesizer& engine) {
    std::vector<freqsynth::Request> more(1 + random_.below(9));
    more.resize(engine.request(more));
    const bool any = !more.empty() || !held_.empty();
    held_.insert(held_.end(), more.begin(), more.end());
    std::shuffle(held_.begin(), held_.end(), random_.engine());
    // All that is held, where nothing else is to be had.
    const std::size_t count = more.empty() ? held_.size() : random_.below(held_.size() + 1);
    const std::span<const freqsynth::Request> out = std::span(held_).first(count);
    if (!more.empty() && random_.below(8) == 0) {
      engine.give_back(out);
    } else {
      deliver(engine, out);
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(count));
    return any;
  }
  void run(freqsynth::Synthesizer& engine) {
    while (step(engine)) {
    }
  }

  /// Requests that are owed.
  [[nodiscard]] std::vector<freqsynth::Request>& held() { return held_; }

  void deliver(freqsynth::Synthesizer& engine, std::span<const freqsynth::Request> requests) {
    const std::size_t channels = engine.channels();
    std::vector<freqsynth::Request> answered, abandoned;
    for (const freqsynth::Request& one : requests) {
      const bool never = synthesis_.abandon_of != 0 && one.id % synthesis_.abandon_of == 3;
      (never ? abandoned : answered).push_back(one);
    }
    std::vector<float> values(answered.size() * channels);
    for (std::size_t i = 0; i < answered.size(); ++i) {
      synthesis_.sample(answered[i], std::span(values).subspan(i * channels, channels));
    }
    engine.abandon(abandoned);
    engine.deliver(answered, values);
  }

 private:
  const RandomSynthesis& synthesis_;
  oracle::Random random_;
  std::vector<freqsynth::Request> held_;
};

}  // namespace helpers
