// SPDX-License-Identifier: MIT
/// \file
/// What several benchmarks share: term vectors, normal matrices, a list, a scene that costs next to
/// nothing, and an engine that has sampled it.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/normal_inverse.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/sampler.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth::bench {

using TermVector = std::array<double, max_terms>;

/// The 64 term values at the first 1024 positions of the sequence.
inline const std::vector<TermVector>& term_vectors() {
  static const std::vector<TermVector> vectors = [] {
    SampleSequence sequence;
    std::vector<TermVector> result(1024);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const SequencePosition position = sequence[i];
      evaluate_terms(position.s, position.t, result[i]);
    }
    return result;
  }();
  return vectors;
}

/// J of the first `terms` terms after the samples of term_vectors(); zero beyond.
inline std::unique_ptr<TermMatrix> normal_matrix(std::size_t terms) {
  auto normal = std::make_unique<TermMatrix>();
  for (const TermVector& a : term_vectors()) {
    for (std::size_t i = 0; i < terms; ++i) {
      for (std::size_t j = 0; j < terms; ++j) (*normal)(i, j) += a[i] * a[j];
    }
  }
  return normal;
}

/// A list that exists already, for images that share it. No other place here makes one.
inline SharedInverseList prepared_list() {
  static const SharedInverseList list = [] {
    auto made = SharedInverseList(InverseListSettings{});
    made->reserve(4096);
    return made;
  }();
  return list;
}

/// A batch sampler of three channels: a gradient with a hard-edged disc in every 64 x 64 pixels, so
/// that sampling adapts, in the same way for every size of the image.
struct DiscScene {
  void operator()(std::span<const Request> requests, std::span<float> values) const {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const auto x = static_cast<float>(requests[i].x);
      const auto y = static_cast<float>(requests[i].y);
      const float u = x - 64 * static_cast<float>(static_cast<int>(x * (1.0f / 64))) - 30;
      const float v = y - 64 * static_cast<float>(static_cast<int>(y * (1.0f / 64))) - 33;
      const float disc = u * u + v * v < 21.0f * 21.0f ? 1.0f : 0.0f;
      values[3 * i] = disc + 0.003f * u;
      values[3 * i + 1] = 0.5f * disc + 0.002f * v;
      values[3 * i + 2] = 1 - disc;
    }
  }
};

/// Settings of an image that shares the list.
inline SynthesisSettings sharing_settings(std::size_t width, std::size_t height) {
  SynthesisSettings settings;
  settings.width = width;
  settings.height = height;
  settings.shared_list = prepared_list();
  return settings;
}

/// An engine that has sampled the scene.
inline std::unique_ptr<Synthesizer> sampled_engine(std::size_t width, std::size_t height,
                                                   double samples_per_pixel) {
  auto engine = std::make_unique<Synthesizer>(sharing_settings(width, height));
  StopRule stop;
  stop.samples_per_pixel = samples_per_pixel;
  engine->run(DiscScene{}, stop);
  return engine;
}

/// Seconds between two times of std::chrono::steady_clock.
inline double seconds_between(std::chrono::steady_clock::time_point first,
                              std::chrono::steady_clock::time_point last) {
  return std::chrono::duration<double>(last - first).count();
}

/// Gives free memory back to the system, so that what is allocated next is new pages, as in a
/// program that does a thing once (glibc; nothing elsewhere). The state's clock stands meanwhile.
inline void forget_free_memory(benchmark::State& state) {
  state.PauseTiming();
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  state.ResumeTiming();
}

}  // namespace freqsynth::bench
