// SPDX-License-Identifier: MIT
#include "rendering.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "freqsynth/freqsynth.h"

namespace path_tracer {
namespace {

using Values = std::array<float, channels>;

Values values_of(const PathSample& sample) {
  const auto& [light, colour, normal, nearness] = sample;
  Values values{};
  const std::array all = {light.x,  light.y,  light.z,  colour.x, colour.y,
                          colour.z, normal.x, normal.y, normal.z, nearness};
  std::transform(all.begin(), all.end(), values.begin(),
                 [](double value) { return static_cast<float>(value); });
  return values;
}

}  // namespace

Pixels render_adaptively(const Scene& scene, const Job& job, freqsynth::ThreadPool& pool) {
  freqsynth::SynthesisSettings settings{
      .width = job.width, .height = job.height, .channels = channels};
  settings.seed = job.frame;
  settings.channel_settings.assign(channels, {freqsynth::ChannelRole::feature});
  std::fill_n(settings.channel_settings.begin(), 3, freqsynth::ChannelSettings{});
  freqsynth::Synthesizer engine(settings);
  const auto sampler = [&](const freqsynth::Request& request) {
    const SampleName name{request.pixel, request.ordinal, request.seed, job.frame};
    return values_of(scene.sample(request.x, request.y, Decisions(Numbers::sobol, name)));
  };
  engine.run(sampler, {.samples_per_pixel = job.samples_per_pixel}, pool);
  Pixels pixels = freqsynth::reconstruct(engine.finished_image());
  for (std::size_t i = 0; i < pixels.size(); i += channels) {
    for (std::size_t c = 0; c < 3; ++c) pixels[i + c] = std::max(0.0f, pixels[i + c]);
  }
  return pixels;
}

Pixels render_plainly(const Scene& scene, const Job& job, Numbers numbers,
                      freqsynth::ThreadPool& pool) {
  if (job.samples_per_pixel < 1 || job.samples_per_pixel != std::floor(job.samples_per_pixel)) {
    throw std::invalid_argument("a plain sampler takes a whole number of samples per pixel");
  }
  const auto samples = static_cast<std::uint32_t>(job.samples_per_pixel);
  auto down = static_cast<std::uint32_t>(std::sqrt(job.samples_per_pixel));
  while (samples % down != 0) --down;
  const std::uint32_t across = samples / down;

  Pixels pixels(job.width * job.height * channels);
  const auto render_row = [&](std::size_t y) {
    for (std::size_t x = 0; x < job.width; ++x) {
      const std::uint64_t pixel = std::uint64_t{y} * job.width + x;
      std::array<double, channels> sum{};
      for (std::uint32_t k = 0; k < samples; ++k) {
        const std::uint64_t seed =
            scenes::mix_bits(scenes::mix_bits(job.frame + 1) + pixel * samples + k);
        const Decisions decisions(numbers, {pixel, k, seed, job.frame});
        auto [u, v] = decisions.pair(Decisions::place_in_pixel);
        if (numbers == Numbers::random) {
          u = (k % across + u) / across;
          v = (k / across + v) / down;
        }
        const Values values = values_of(
            scene.sample(static_cast<double>(x) + u, static_cast<double>(y) + v, decisions));
        for (std::size_t c = 0; c < channels; ++c) sum[c] += double{values[c]};
      }
      for (std::size_t c = 0; c < channels; ++c) {
        pixels[pixel * channels + c] = static_cast<float>(sum[c] / samples);
      }
    }
  };
  pool.execute(job.height, freqsynth::TaskRef(render_row));
  return pixels;
}

}  // namespace path_tracer
