// What the published comparison rests on, as orderings with wide margins. The figures themselves
// are measured by benchmarks/quality, not here.

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/scene_radiance.h"
#include "scenes/scene.h"

namespace {

constexpr std::size_t size = 128;

class Orderings : public testing::TestWithParam<const char*> {
 protected:
  /// References take most of the time, so that they are made once.
  struct Subject {
    std::unique_ptr<scenes::Scene> scene;
    baselines::Radiance radiance;
    quality::Reference reference;
    std::vector<float> pixels;
  };

  const Subject& subject() {
    static std::map<std::string, Subject> subjects;
    Subject& result = subjects[GetParam()];
    if (!result.scene) {
      result.scene = scenes::make_scene({.name = GetParam(), .width = size, .height = size});
      result.radiance = quality::radiance_of(*result.scene);
      freqsynth::ThreadPool pool;
      result.reference = quality::render_reference(
          result.radiance, quality::pixel_average_of(*result.scene), {size, size, 256, 0}, pool);
      result.pixels = result.reference.pixels();
    }
    return result;
  }

  quality::Metrics measured(const char* method, double rate) {
    const quality::Run run = quality::run_method(
        quality::find_method(method), subject().radiance,
        {size, size, quality::samples_of(rate, size, size), 1, subject().scene->noisy()});
    return quality::measure({size, size, run.pixels}, {size, size, subject().pixels}, run.samples);
  }
};

TEST_P(Orderings, TheReferenceIsBetterThanWhatIsMeasured) {
  EXPECT_LT(subject().reference.standard_error(), 0.5 * measured("freqsynth", 4).rmse);
}

TEST_P(Orderings, FreqsynthIsBetterThanJitteredSamplesInABox) {
  for (const double rate : {1.0, 4.0}) {
    const quality::Metrics ours = measured("freqsynth", rate);
    const quality::Metrics theirs = measured("jittered-box", rate);
    EXPECT_LT(ours.rmse, 0.8 * theirs.rmse) << rate;
    EXPECT_GT(ours.psnr, theirs.psnr + 1) << rate;
    EXPECT_GT(ours.ssim, theirs.ssim) << rate;
  }
}

TEST_P(Orderings, ResidualsHelpWhereThereAreSamplesEnough) {
  EXPECT_LT(measured("freqsynth", 4).rmse, 0.9 * measured("freqsynth-paper", 4).rmse);
}

TEST_P(Orderings, MoreSamplesAreBetter) {
  for (const char* const method : {"freqsynth", "jittered-box"}) {
    const double few = measured(method, 0.25).rmse;
    const double more = measured(method, 1).rmse;
    EXPECT_LT(more, 0.9 * few) << method;
    EXPECT_LT(measured(method, 4).rmse, 0.9 * more) << method;
  }
}

TEST_P(Orderings, NoSeamAndNoMissedBlockAtOneSamplePerPixel) {
  const quality::Metrics metrics = measured("freqsynth", 1);
  EXPECT_LT(metrics.seam, 1.5);
  EXPECT_EQ(metrics.missed_blocks, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Orderings, testing::Values("fan", "chess"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
