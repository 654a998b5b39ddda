// SPDX-License-Identifier: MIT
// Pictures of the path tracer of the examples.

#include "path_tracer/rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace path_tracer {
namespace {

Job job_of(double samples, std::uint64_t frame = 0) {
  return {.width = 45, .height = 37, .samples_per_pixel = samples, .frame = frame};
}

/// Median of the absolute differences of the first three channels: glass casts light so rarely and
/// so bright that the mean square says nothing of most pixels.
double difference_of(const Pixels& a, const Pixels& b) {
  std::vector<double> all;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % channels < 3) all.push_back(std::abs(double{a[i]} - double{b[i]}));
  }
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

TEST(Rendering, IsTheSameForAnyNumberOfThreads) {
  freqsynth::ThreadPool one(1), three(3);
  for (const std::string_view name : scene_names) {
    const Scene scene = make_scene(name, 45, 37);
    const Pixels adaptive = render_adaptively(scene, job_of(2), one);
    EXPECT_EQ(adaptive, render_adaptively(scene, job_of(2), three));
    EXPECT_NE(adaptive, render_adaptively(scene, job_of(2, 1), one)) << "another frame";
    for (const Numbers numbers : {Numbers::random, Numbers::sobol}) {
      const Pixels plain = render_plainly(scene, job_of(2), numbers, one);
      EXPECT_EQ(plain, render_plainly(scene, job_of(2), numbers, three));
      EXPECT_NE(plain, render_plainly(scene, job_of(2, 1), numbers, one));
    }
  }
}

TEST(Rendering, ComesToTheSamePictureInAllWays) {
  freqsynth::ThreadPool pool;
  for (const std::string_view name : scene_names) {
    const Scene scene = make_scene(name, 45, 37);
    // With some hundreds of samples most pixels have not met the light that glass casts, which is a
    // good part of what there is.
    const Pixels truth = render_plainly(scene, job_of(3200, 9), Numbers::sobol, pool);
    const auto mean_difference = [&](const auto& render) {
      double sum = 0;
      for (const std::uint64_t frame : {0, 1, 2}) sum += difference_of(render(frame), truth);
      return sum / 3;
    };
    const auto plain = [&](double samples, Numbers numbers) {
      return mean_difference([&](std::uint64_t frame) {
        return render_plainly(scene, job_of(samples, frame), numbers, pool);
      });
    };
    const auto adaptive = [&](double samples) {
      return mean_difference([&](std::uint64_t frame) {
        return render_adaptively(scene, job_of(samples, frame), pool);
      });
    };
    const double by_sobol = plain(4, Numbers::sobol), by_engine = adaptive(4);
    EXPECT_LT(by_sobol, plain(4, Numbers::random)) << name;
    EXPECT_LT(by_engine, by_sobol) << name;
    EXPECT_LT(plain(64, Numbers::sobol), 0.5 * by_sobol) << name;
    EXPECT_LT(adaptive(64), 0.7 * by_engine) << name;
  }
}

TEST(Rendering, FeaturesAreThoseOfTheFirstSurface) {
  // In the middle of the back wall of the box, where a pixel sees nothing else.
  freqsynth::ThreadPool pool;
  const Scene scene = make_scene("cornell", 45, 37);
  const std::size_t at = (10 * 45 + 28) * channels;
  for (const Pixels& pixels : {render_plainly(scene, job_of(4), Numbers::sobol, pool),
                               render_adaptively(scene, job_of(4), pool)}) {
    EXPECT_NEAR(pixels[at + 3], 0.73, 0.02);
    EXPECT_NEAR(pixels[at + 7], -1, 0.02) << "towards the camera";
    EXPECT_NEAR(pixels[at + 9], 1 / 2.95, 0.02);
  }
}

TEST(Rendering, GivesFiniteValuesAndNoNegativeLight) {
  freqsynth::ThreadPool pool;
  const Scene scene = make_scene("spheres", 45, 37);
  const Pixels pixels = render_adaptively(scene, job_of(1), pool);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    ASSERT_TRUE(std::isfinite(pixels[i])) << i;
    if (i % channels < 3) {
      ASSERT_GE(pixels[i], 0) << i;
    }
  }
}

TEST(Rendering, PlainSamplersRefuseFractions) {
  freqsynth::ThreadPool pool(1);
  const Scene scene = make_scene("cornell", 45, 37);
  EXPECT_THROW((void)render_plainly(scene, job_of(0.5), Numbers::sobol, pool),
               std::invalid_argument);
  EXPECT_THROW((void)render_plainly(scene, job_of(1.5), Numbers::sobol, pool),
               std::invalid_argument);
  EXPECT_THROW((void)make_scene("kitchen", 45, 37), std::invalid_argument);
}

TEST(Decisions, AreUniformAndIndependent) {
  for (const Numbers numbers : {Numbers::random, Numbers::sobol}) {
    constexpr int count = 20000;
    for (const auto& [a, b] :
         {std::pair{0u, 1u}, std::pair{1u, 2u}, std::pair{5u, 9u}, std::pair{18u, 19u}}) {
      double first = 0, second = 0, product = 0, inner = 0;
      for (std::uint64_t i = 0; i < count; ++i) {
        // The fourth samples of as many pixels.
        const Decisions decisions(numbers, {i, 3, scenes::mix_bits(i + 1), 0});
        const auto p = decisions.pair(a), q = decisions.pair(b);
        first += p[0] / count;
        second += q[1] / count;
        product += (p[0] - 0.5) * (q[0] - 0.5) / count;
        inner += (p[0] - 0.5) * (p[1] - 0.5) / count;
      }
      // Five deviations: sqrt(1 / 12 n) and sqrt(1 / 144 n).
      EXPECT_NEAR(first, 0.5, 5 / std::sqrt(12.0 * count));
      EXPECT_NEAR(second, 0.5, 5 / std::sqrt(12.0 * count));
      EXPECT_NEAR(product, 0, 5 / std::sqrt(144.0 * count));
      EXPECT_NEAR(inner, 0, 5 / std::sqrt(144.0 * count));
    }
  }
}

}  // namespace
}  // namespace path_tracer
