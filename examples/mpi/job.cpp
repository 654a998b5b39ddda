// SPDX-License-Identifier: MIT
#include "job.h"

#include <algorithm>

#include "common/sampling.h"
#include "trial.h"
#include "window_plan.h"

namespace farm {

Job::Job(const Options& options, int rank)
    : options_(options),
      scene_(named_scene({.name = options.scene,
                          .width = static_cast<int>(options.width),
                          .height = static_cast<int>(options.height),
                          .seed = options.seed})),
      pool_(options.threads) {
  // What a noisy scene takes its random decisions from.
  const Fields fields{.ordinal = scene_->noisy()};
  works_.push_back({{options.width, options.height, channels, fields},
                    on_trial(SceneSampler(*scene_, channels), options.trial, rank)});
  if (options.columns != 0) {
    step_ = coarse_step(options.width, options.height);
    const auto size = [&](std::size_t pixels) { return (pixels + step_ - 1) / step_; };
    works_.push_back(
        {{size(options.width), size(options.height), channels, fields}, coarse_sampler()});
  }
}

freqsynth::SynthesisSettings Job::settings(std::size_t work) const {
  freqsynth::SynthesisSettings settings;
  settings.width = works_[work].format.width;
  settings.height = works_[work].format.height;
  settings.channels = channels;
  settings.wave = options_.wave;
  settings.list.seed = options_.seed;
  settings.max_samples_per_block =
      options_.uniform != 0
          ? options_.uniform
          : block_limit(options_.samples_per_pixel, settings.max_samples_per_block);
  if (work == coarse_picture) {
    // Few blocks, so large waves: it need not be the best picture.
    settings.wave = std::max<std::size_t>(settings.width * settings.height / 256, 1);
  }
  return settings;
}

SampleFunction Job::coarse_sampler() const {
  const auto step = static_cast<double>(step_);
  const auto width = static_cast<double>(options_.width);
  const auto height = static_cast<double>(options_.height);
  return [=, fine = works_[picture].sample](std::span<const freqsynth::Request> requests,
                                            std::span<float> values) {
    std::vector<freqsynth::Request> there(requests.begin(), requests.end());
    for (freqsynth::Request& request : there) {
      request.x = std::min(request.x * step, width);
      request.y = std::min(request.y * step, height);
    }
    fine(there, values);
  };
}

}  // namespace farm
