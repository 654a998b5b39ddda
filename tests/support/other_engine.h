// SPDX-License-Identifier: MIT
// The engine made of an estimator and measures of other kinds than the library's, and a host for
// it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/block_store.h"
#include "freqsynth/engine/engine.h"
#include "freqsynth/engine/priority.h"
#include "support/engine_helpers.h"
#include "support/other_parts.h"
#include "support/refiner_helpers.h"

namespace helpers::other {

using freqsynth::BlockGrid;
using freqsynth::BlockStore;
using freqsynth::Engine;
using freqsynth::PrioritySettings;
using freqsynth::Request;

constexpr std::size_t width = 37, height = 21, channels = 2;

/// Two channels, of which the second is the first one seen from the other side.
inline std::array<float, channels> sample(double x, double y) {
  return {helpers::picture(x, y), 3 - 2 * helpers::picture(y, x)};
}

using Blocks = BlockStore<MeanRefiner>;

template <class M>
M measure_of(std::size_t blocks, std::size_t most) {
  if constexpr (std::is_same_v<M, FewestSamples>) {
    return M();
  } else {
    return M(PrioritySettings{}, blocks, most);
  }
}

template <class M>
Engine<MeanRefiner, M> make_engine(std::size_t wave, std::size_t most = 1000) {
  const BlockGrid grid = BlockGrid::of(width, height, channels);
  return {grid, Blocks(MeanRefiner(helpers::shared_list(), channels), grid.size(), most),
          measure_of<M>(grid.size(), most), std::vector<float>(grid.size(), 1), wave};
}

/// The host's loop. Calls look(request) before each sample.
template <class E, class Sample, class Look>
void serve(E& engine, std::size_t at_once, const Sample& of, const Look& look) {
  std::vector<Request> requests(at_once);
  while (const std::size_t count = engine.request(requests)) {
    std::vector<float> values;
    for (const Request& request : std::span(requests).first(count)) {
      look(request);
      for (const float value : of(request.x, request.y)) values.push_back(value);
    }
    engine.deliver(std::span(requests).first(count), values);
  }
}

}  // namespace helpers::other
