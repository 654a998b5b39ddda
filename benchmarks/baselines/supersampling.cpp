// SPDX-License-Identifier: MIT
#include "supersampling.h"

namespace baselines {

std::vector<Sample> supersamples(Sampler& sampler, const Job& job, bool jittered) {
  Random random(job.seed);
  std::vector<Sample> samples;
  samples.reserve(job.samples);
  for_each_stratum(job, [&](const Rectangle& stratum) {
    samples.push_back(jittered ? sampler.take_in(stratum, random)
                               : sampler.take((stratum.left + stratum.right) / 2,
                                              (stratum.top + stratum.bottom) / 2));
  });
  return samples;
}

Rendering supersampling(const Radiance& radiance, const Job& job,
                        const SupersamplingSettings& settings) {
  Sampler sampler(radiance, job);
  const std::vector<Sample> samples = supersamples(sampler, job, settings.jittered);
  Rendering rendering = sampler.rendering();
  const float width = static_cast<float>(width_for_rate(rate(job)));
  weighted_average(samples, settings.filter, {&width, 1}, rendering);
  return rendering;
}

}  // namespace baselines
