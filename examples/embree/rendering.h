// SPDX-License-Identifier: MIT
/// \file
/// Pictures: by freqsynth, and plainly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/checkpoint.h"
#include "glue.h"
#ifndef EMBREE_HOST_HAS_TBB
#include "freqsynth/engine/thread_pool.h"
#endif

namespace embree_host {

#ifndef EMBREE_HOST_HAS_TBB
using HostPool = freqsynth::ThreadPool;
#endif

/// Linear values, row by row, the channels of a pixel side by side.
using Pixels = std::vector<float>;

/// What is to be rendered.
struct Job {
  std::size_t width = 0;
  std::size_t height = 0;
  double samples_per_pixel = 1;
  std::uint64_t frame = 0;  ///< pictures of other frames have other noise
};

/// The number of the channel that is not averaged.
inline constexpr std::size_t depth = channels - 1;

/// Most samples that freqsynth is asked for together.
inline constexpr std::size_t batch = 4096;

/// Told how far it is; false ends the work.
using Watch = std::function<bool(const freqsynth::Progress&)>;

/// The engine's settings for it.
[[nodiscard]] freqsynth::SynthesisSettings settings_of(const Job& job);

/// The pixels of what an engine with such settings shows, on a pool's threads.
template <class Pool>
[[nodiscard]] Pixels pixels_of(const freqsynth::Synthesizer& engine, Pool& pool) {
  const freqsynth::PixelWindow shown = engine.window();
  Pixels pixels(shown.width * shown.height * channels);
  // Light comes finished, to where it belongs.
  engine.finish({.data = pixels.data(),
                 .width = shown.width,
                 .height = shown.height,
                 .pixel_stride = channels,
                 .row_stride = static_cast<std::ptrdiff_t>(shown.width * channels)},
                {}, pool);
  for (std::size_t channel = 3; channel < channels; ++channel) {
    const std::vector<float> own = engine.channel_pixels(channel);
    for (std::size_t p = 0; p < own.size(); ++p) pixels[p * channels + channel] = own[p];
  }
  return pixels;
}

/// Keeps nothing.
[[nodiscard]] inline Checkpoint no_checkpoint() { return {{}, {}, 0}; }

/// A pool of so many threads; 0: all. One at a time: those of oneTBB share their threads.
[[nodiscard]] HostPool make_pool(std::size_t threads);

/// By freqsynth, which says where to sample. An early end leaves the picture of what there is.
/// \param checkpoint  keeps its state
/// \param resume      such a state to go on from; empty: from the beginning
/// \throws std::runtime_error naming the file and the reason when it cannot go on from that.
[[nodiscard]] Pixels render_adaptively(const Renderer& renderer, const Job& job, HostPool& pool,
                                       const Watch& watch, Checkpoint checkpoint = no_checkpoint(),
                                       const std::string& resume = {});

/// As many samples in each pixel, and their means; the depth of the sample nearest to the centre.
/// Random numbers come with a jittered grid, Sobol points with Sobol points. An early end leaves
/// rows black. \throws std::invalid_argument when the number of samples per pixel is not a whole
/// one.
[[nodiscard]] Pixels render_plainly(const Renderer& renderer, const Job& job,
                                    path_tracer::Numbers numbers, HostPool& pool,
                                    const Watch& watch);

}  // namespace embree_host
