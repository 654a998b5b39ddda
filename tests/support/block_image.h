// SPDX-License-Identifier: MIT
// An image whose blocks a test feeds, and what the measures of its blocks are made of, in long
// double.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/block_view.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/engine/signal_statistics.h"
#include "support/oracles.h"
#include "support/scripted_refiner.h"

namespace helpers {

using freqsynth::BlockGrid;
using freqsynth::BlockStore;
using freqsynth::BlockView;
using freqsynth::PrioritySettings;
using freqsynth::SignalStatistics;

using BlockNumber = std::uint32_t;
using oracle::Real;

/// A few dozen roundings of positive numbers.
inline double tolerance(Real expected) {
  return 40 * oracle::float_rounding * static_cast<double>(expected);
}

/// An image whose blocks say of themselves what the test wants.
template <class R>
struct BlockImage {
  BlockImage(std::size_t blocks_x, std::size_t blocks_y, R refiner, std::size_t most = 300)
      : grid(BlockGrid::of(8 * blocks_x, 8 * blocks_y, refiner.channels())),
        blocks(std::move(refiner), grid.size(), most),
        signal(blocks.refiner().channels()) {}

  [[nodiscard]] BlockView<R> view() const { return {grid, blocks, signal}; }
  /// Blocks that share an edge with this one.
  [[nodiscard]] std::vector<BlockNumber> beside(BlockNumber block) const {
    std::vector<BlockNumber> found;
    for (BlockNumber other = 0; other < grid.size(); ++other) {
      const auto dx = static_cast<int>(grid.column(block)) - static_cast<int>(grid.column(other));
      const auto dy = static_cast<int>(grid.row(block)) - static_cast<int>(grid.row(other));
      if (std::abs(dx) + std::abs(dy) == 1) found.push_back(other);
    }
    return found;
  }
  /// A signal that varies by `spread` around `level` in each channel.
  void settle(float level, float spread) {
    for (const float sign : {-1.0f, 1.0f}) {
      const std::vector<float> values(blocks.refiner().channels(), level + sign * spread);
      signal.add(values.data());
    }
    signal.settle(blocks.refiner().weights());
  }

  BlockGrid grid;
  BlockStore<R> blocks;
  SignalStatistics signal;
};

/// U_n of engine/priority.h per unit of the image's variance: the running average of U r^n, from U
/// on.
inline Real uncertainty(const PrioritySettings& settings, std::size_t samples) {
  const auto w = static_cast<Real>(settings.weight), r = static_cast<Real>(settings.decay);
  Real running = static_cast<Real>(settings.uncertainty);
  for (std::size_t n = 0; n <= samples; ++n) {
    const Real newest = static_cast<Real>(settings.uncertainty) * std::pow(r, static_cast<Real>(n));
    running = (1 - w) * running + w * newest;
  }
  return running;
}

/// What a sample of a block is worth per unit of its residuals: the share that the step from one
/// even lattice to the next takes away, per sample, of 64 / n.
inline Real gain_of_sample(std::size_t samples) {
  std::size_t before = 1;
  for (std::size_t k = 1;; k *= 2) {
    const std::size_t level = (k + 1) * (k + 1);
    for (const std::size_t after : {level, level + k * k}) {
      if (samples < after) {
        const auto a = static_cast<Real>(before), b = static_cast<Real>(after);
        return 64 / static_cast<Real>(samples) * (1 - std::pow(a / b, Real{1.5})) / (b - a);
      }
      before = after;
    }
  }
}

/// U r^n / n per unit of the image's variance.
inline Real doubt(const PrioritySettings& settings, std::size_t samples) {
  const auto n = static_cast<Real>(samples);
  return static_cast<Real>(settings.uncertainty) * std::pow(static_cast<Real>(settings.decay), n) /
         n;
}

inline std::vector<PrioritySettings> different_settings() {
  return {{},
          {.weight = 1, .uncertainty = 5, .decay = 0.9, .neighbours = 3, .image = 0.25},
          {.weight = 0.05, .uncertainty = 0, .decay = 0, .neighbours = 0, .image = 0},
          {.uncertainty = 0.1, .neighbours = 1e6, .image = 0},
          {.uncertainty = 1e6, .neighbours = 0, .image = 1e6}};
}

/// Feeds blocks at random, so that they have different residuals and numbers of samples. Calls
/// then(block) after each.
template <class Then>
void feed(BlockImage<ScriptedRefiner>& image, int samples, oracle::Random& random, Then&& then) {
  const std::size_t channels = image.blocks.refiner().channels();
  for (int n = 0; n < samples; ++n) {
    const auto block = static_cast<BlockNumber>(random.below(image.grid.size()));
    if (image.blocks.full(block)) continue;
    std::vector<float> values;
    for (std::size_t c = 0; c < channels; ++c) {
      values.push_back(static_cast<float>(std::pow(random.uniform(0, 3), 4)));
    }
    image.blocks.absorb(block, values.data());
    then(block);
  }
}

}  // namespace helpers
