// SPDX-License-Identifier: MIT
#include "rendering.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "common/sampling.h"

namespace embree_host {
namespace {

/// The plain samples of some pixels, those of a pixel side by side.
std::vector<freqsynth::Request> samples_of(const Job& job, path_tracer::Numbers numbers,
                                           std::size_t first, std::size_t end) {
  const auto count = static_cast<std::uint32_t>(job.samples_per_pixel);
  auto down = static_cast<std::uint32_t>(std::sqrt(job.samples_per_pixel));
  while (count % down != 0) --down;
  const std::uint32_t across = count / down;
  std::vector<freqsynth::Request> samples;
  samples.reserve((end - first) * count);
  for (std::size_t pixel = first; pixel < end; ++pixel) {
    for (std::uint32_t k = 0; k < count; ++k) {
      freqsynth::Request request;
      request.pixel = pixel;
      request.ordinal = k;
      request.seed = scenes::mix_bits(scenes::mix_bits(job.frame + 1) + pixel * count + k);
      request.spacing = static_cast<float>(1 / std::sqrt(job.samples_per_pixel));
      const path_tracer::Decisions decisions(numbers, {pixel, k, request.seed, job.frame});
      auto [u, v] = decisions.pair(path_tracer::Decisions::place_in_pixel);
      if (numbers == path_tracer::Numbers::random) {
        u = (k % across + u) / across;
        v = (k / across + v) / down;
      }
      request.x = static_cast<double>(pixel % job.width) + u;
      request.y = static_cast<double>(pixel / job.width) + v;
      samples.push_back(request);
    }
  }
  return samples;
}

/// The means of the samples of pixels, and the depth of those nearest to the centres.
void average(std::span<const freqsynth::Request> samples, std::span<const float> values,
             std::size_t count, float* pixels) {
  for (std::size_t first = 0; first < samples.size(); first += count, pixels += channels) {
    std::array<double, channels> sum{};
    double least = 2;
    for (std::size_t k = first; k < first + count; ++k) {
      const float* sample = values.data() + k * channels;
      for (std::size_t c = 0; c < depth; ++c) sum[c] += double{sample[c]};
      const double x = samples[k].x - std::floor(samples[k].x) - 0.5;
      const double y = samples[k].y - std::floor(samples[k].y) - 0.5;
      if (x * x + y * y >= least) continue;
      least = x * x + y * y;
      pixels[depth] = sample[depth];
    }
    for (std::size_t c = 0; c < depth; ++c) {
      pixels[c] = static_cast<float>(sum[c] / static_cast<double>(count));
    }
  }
}

}  // namespace

HostPool make_pool(std::size_t threads) {
#ifdef EMBREE_HOST_HAS_TBB
  if (threads == 0) threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return {tbb::global_control(tbb::global_control::max_allowed_parallelism, threads),
          tbb::task_arena(static_cast<int>(threads))};
#else
  return HostPool(threads);
#endif
}

freqsynth::SynthesisSettings settings_of(const Job& job) {
  freqsynth::SynthesisSettings settings = settings_of(job.width, job.height);
  settings.seed = job.frame;
  settings.max_samples_per_block =
      block_limit(job.samples_per_pixel, settings.max_samples_per_block);
  return settings;
}

Pixels render_adaptively(const Renderer& renderer, const Job& job, HostPool& pool,
                         const Watch& watch, Checkpoint checkpoint, const std::string& resume) {
  freqsynth::Synthesizer engine = make_engine(resume, settings_of(job));
  const auto progress = [&](const freqsynth::Progress& now) {
    checkpoint.keep_when_due(engine);
    return watch(now);
  };
  engine.run(Sampler{renderer, job.frame}, {.samples_per_pixel = job.samples_per_pixel}, pool,
             progress, batch);
  checkpoint.keep(engine);
  return pixels_of(engine, pool);
}

Pixels render_plainly(const Renderer& renderer, const Job& job, path_tracer::Numbers numbers,
                      HostPool& pool, const Watch& watch) {
  if (job.samples_per_pixel < 1 || job.samples_per_pixel != std::floor(job.samples_per_pixel)) {
    throw std::invalid_argument("a plain sampler takes a whole number of samples per pixel");
  }
  const auto count = static_cast<std::size_t>(job.samples_per_pixel);
  const Sampler sampler{renderer, job.frame, numbers};
  Pixels pixels(job.width * job.height * channels);
  // Some thousand samples a task; some tasks at a time, so that progress is told.
  const std::size_t all = job.width * job.height;
  const std::size_t portion = std::max<std::size_t>(4096 / count, 1);
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t together = 8 * pool.concurrency() * portion;
  for (std::size_t first = 0; first < all; first += together) {
    const std::size_t end = std::min(all, first + together);
    const auto render_portion = [&](std::size_t index) {
      const std::size_t start = first + index * portion;
      const std::vector<freqsynth::Request> samples =
          samples_of(job, numbers, start, std::min(end, start + portion));
      std::vector<float> values(samples.size() * channels);
      sampler(samples, values);
      average(samples, values, count, pixels.data() + start * channels);
    };
    pool.execute((end - first + portion - 1) / portion, freqsynth::TaskRef(render_portion));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    const double done = static_cast<double>(end) / static_cast<double>(all);
    if (!watch({.fraction = done,
                .seconds = seconds.count(),
                .seconds_left = seconds.count() * (1 - done) / done,
                .samples = end * count})) {
      break;
    }
  }
  return pixels;
}

}  // namespace embree_host
