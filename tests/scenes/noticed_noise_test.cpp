// SPDX-License-Identifier: MIT
// The library notices which scenes are noisy, and takes no other one for noisy.
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>

#include "freqsynth/synthesizer.h"
#include "scene_helpers.h"
#include "scenes/scene.h"

namespace {

TEST(NoticedNoise, IsThatOfTheNoisyScenes) {
  for (const std::string_view name : scenes::scene_names()) {
    for (const int size : {64, 200}) {
      const auto scene = scene_helpers::make(name, size, size);
      const auto side = static_cast<std::size_t>(size);
      freqsynth::Synthesizer engine({.width = side, .height = side});
      const auto sampler = [&](const freqsynth::Request& request) {
        return scene_helpers::radiance(*scene, request.x, request.y,
                                       scenes::sample_id(request.pixel, request.ordinal));
      };
      const double most = size == 64 ? 16 : 1;
      for (double rate = 0.25; rate <= most; rate *= 4) {
        engine.run(sampler, {.samples_per_pixel = rate});
        const freqsynth::SynthesisStats stats = engine.stats();
        EXPECT_EQ(engine.noisy(), scene->noisy()) << name << ", " << rate;
        if (!scene->noisy()) {
          EXPECT_EQ(stats.differing_probes, 0u) << name;
        }
      }
    }
  }
}

}  // namespace
