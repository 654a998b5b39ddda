// SPDX-License-Identifier: MIT
#include "job.h"

#include <algorithm>

#include "trial.h"
#include "window_plan.h"

namespace farm {

Job::Job(const Options& options, int rank)
    : options_(options), subject_(make_subject(options)), pool_(options.threads) {
  const std::size_t channels = subject_.channels.size();
  works_.push_back({{options.width, options.height, channels, subject_.fields},
                    on_trial(subject_.sample, options.trial, rank),
                    subject_.portion});
  if (options.columns != 0) {
    step_ = coarse_step(options.width, options.height);
    const auto size = [&](std::size_t pixels) { return (pixels + step_ - 1) / step_; };
    works_.push_back({{size(options.width), size(options.height), channels, subject_.fields},
                      coarse_sampler(),
                      subject_.portion});
  }
}

freqsynth::SynthesisSettings Job::settings(std::size_t work) const {
  freqsynth::SynthesisSettings settings = subject_.settings;
  settings.width = works_[work].format.width;
  settings.height = works_[work].format.height;
  settings.wave = options_.wave;
  settings.list.seed = options_.seed;
  if (options_.uniform != 0) settings.max_samples_per_block = options_.uniform;
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
      request.spacing *= static_cast<float>(step);
    }
    fine(there, values);
  };
}

}  // namespace farm
