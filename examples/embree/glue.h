// SPDX-License-Identifier: MIT
/// \file
/// All that freqsynth, Embree and oneTBB have to know of each other.
#pragma once

#include "freqsynth/freqsynth.h"
#include "renderer.h"
#ifdef EMBREE_HOST_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace embree_host {

/// Answers requests, many at a time and on any thread: Embree finds what the camera's rays meet, in
/// packets, and the host's shading does the rest.
struct Sampler {
  const Renderer& renderer;
  std::uint64_t frame = 0;
  path_tracer::Numbers numbers = path_tracer::Numbers::sobol;

  void operator()(std::span<const freqsynth::Request> requests, std::span<float> values) const {
    std::vector<RTCRayHit> rays;
    std::vector<Sample> samples;
    for (const freqsynth::Request& r : requests) {
      rays.push_back(renderer.camera_ray(r.x, r.y));
      samples.push_back({{r.pixel, r.ordinal, r.seed, frame}, numbers, r.spacing});
    }
    renderer.geometry().find(rays);
    renderer.shade(rays, samples, values);
  }
};

/// What the channels are for: light steers, colours and normals guide the smoothing.
inline freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height) {
  using enum freqsynth::ChannelRole;
  freqsynth::SynthesisSettings settings{.width = width, .height = height, .channels = channels};
  settings.noise = freqsynth::Noise::present;
  settings.channel_settings.assign(3, {steer});
  settings.channel_settings.resize(9, {mean_feature});
  settings.channel_settings.push_back({mean});     // how much of the sun is seen
  settings.channel_settings.push_back({nearest});  // depth
  return settings;
}

#ifdef EMBREE_HOST_HAS_TBB
/// The host's pool, as the engine uses it.
struct HostPool {
  tbb::global_control most;
  tbb::task_arena arena;
  void execute(std::size_t count, freqsynth::TaskRef task) {
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, task); });
  }
  std::size_t concurrency() { return static_cast<std::size_t>(arena.max_concurrency()); }
};
#endif

}  // namespace embree_host
