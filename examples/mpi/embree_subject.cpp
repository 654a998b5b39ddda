// SPDX-License-Identifier: MIT
#include <memory>

#include "embree/rendering.h"
#include "subject.h"

namespace farm {

Subject make_embree_subject(const Options& options) {
  embree_host::SceneOptions scene = options.embree;
  scene.obj = options.scene == colonnade ? "" : options.scene.substr(obj_prefix.size());
  const auto renderer = std::make_shared<const embree_host::Renderer>(
      embree_host::make_renderer(scene, options.width, options.height));
  Subject subject;
  subject.settings = embree_host::settings_of(
      embree_host::Job{options.width, options.height, options.samples_per_pixel, options.frame});
  subject.channels.assign(embree_host::channel_names.begin(), embree_host::channel_names.end());
  // Sobol points by pixel and ordinal; the footprint of textures.
  subject.fields = {.ordinal = true, .spacing = true};
  // Rays go to Embree together, as many as there are.
  subject.portion = 256;
  subject.sample = [renderer, frame = options.frame](std::span<const freqsynth::Request> requests,
                                                     std::span<float> values) {
    embree_host::Sampler{*renderer, frame}(requests, values);
  };
  subject.finish = embree_host::pixels_of<freqsynth::ThreadPool>;
  return subject;
}

}  // namespace farm
