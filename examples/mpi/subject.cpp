// SPDX-License-Identifier: MIT
#include "subject.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/sampling.h"

namespace farm {
namespace {

/// As freqsynth_render has them.
std::vector<float> colours_of(const freqsynth::Synthesizer& engine, freqsynth::ThreadPool& pool) {
  const freqsynth::PixelWindow shown = engine.window();
  std::vector<float> pixels(shown.width * shown.height * engine.channels());
  engine.finish({.data = pixels.data(), .width = shown.width, .height = shown.height}, {}, pool);
  for (float& value : pixels) value = std::max(value, 0.0f);
  return pixels;
}

}  // namespace

Subject make_subject(const Options& options) {
  if (is_embree_scene(options)) {
#ifdef FREQSYNTH_HAS_EMBREE
    return make_embree_subject(options);
#else
    throw std::runtime_error("--scene " + options.scene +
                             ": this program was built without Embree");
#endif
  }
  const std::shared_ptr<const scenes::Scene> scene =
      named_scene({.name = options.scene,
                   .width = static_cast<int>(options.width),
                   .height = static_cast<int>(options.height),
                   .seed = options.seed});
  Subject subject;
  subject.channels = {"R", "G", "B"};
  subject.settings.width = options.width;
  subject.settings.height = options.height;
  subject.settings.channels = subject.channels.size();
  subject.settings.max_samples_per_block =
      block_limit(options.samples_per_pixel, subject.settings.max_samples_per_block);
  // What a noisy scene takes its random decisions from.
  subject.fields = {.ordinal = scene->noisy()};
  subject.sample = [scene, channels = subject.channels.size()](
                       std::span<const freqsynth::Request> requests, std::span<float> values) {
    SceneSampler(*scene, channels)(requests, values);
  };
  subject.finish = colours_of;
  return subject;
}

}  // namespace farm
