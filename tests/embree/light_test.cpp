// SPDX-License-Identifier: MIT
// Light in scenes whose light is known in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "embree/renderer.h"
#include "scenes/random.h"

namespace embree_host {
namespace {

constexpr double pi = std::numbers::pi;

Sky uniform_sky(double radiance) {
  Sky sky;
  sky.zenith = sky.horizon = sky.below = {radiance, radiance, radiance};
  sky.sun = {0, 0, 0};
  return sky;
}

/// Mean of a channel over many samples through one position, and the deviation of that mean.
struct Estimate {
  double mean = 0, deviation = 0;
};
Estimate estimate_of(const Renderer& renderer, double x, double y, std::size_t channel,
                     std::size_t count = 20000) {
  std::vector<RTCRayHit> rays(count, renderer.camera_ray(x, y));
  renderer.geometry().find(rays);
  std::vector<Sample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    samples[i].name = {i, 0, scenes::mix_bits(i + 1), 0};
    samples[i].numbers = path_tracer::Numbers::random;
  }
  std::vector<float> values(count * channels);
  renderer.shade(rays, samples, values);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(values[i * channels + channel]);
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(count);
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)) / n)};
}

/// A floor, and a camera that looks at it askew; the middle of the picture shows the origin.
Model floor_of(const Vec3& colour) {
  Model model;
  model.materials = {{colour, {}}};
  model.add_rectangle({-1000, -1000, 0}, {2000, 0, 0}, {0, 2000, 0}, 1, 0);
  return model;
}
const View askew{{0.5, -3, 2}, {0, 0, 0}, 0.3};

TEST(EmbreeLight, AFloorUnderAnEvenSkyHasItsShare) {
  const Renderer renderer(Geometry(floor_of({0.8, 0.5, 0.2})), askew, uniform_sky(3), 16, 16);
  // Every single path brings the same.
  for (const std::size_t channel : {0u, 1u, 2u}) {
    const auto [mean, deviation] = estimate_of(renderer, 8, 8, channel, 2000);
    EXPECT_NEAR(mean, 3 * (channel == 0 ? 0.8 : channel == 1 ? 0.5 : 0.2), 1e-6);
    EXPECT_LT(deviation, 1e-6);
  }
  EXPECT_NEAR(estimate_of(renderer, 8, 8, 3, 10).mean, 0.8, 1e-6) << "colour";
  EXPECT_NEAR(estimate_of(renderer, 8, 8, 8, 10).mean, 1, 1e-6) << "normal";
  EXPECT_NEAR(estimate_of(renderer, 8, 8, 9, 10).mean, 1, 1e-6) << "sees the sun";
  EXPECT_NEAR(estimate_of(renderer, 8, 8, 10, 10).mean, length(askew.eye), 1e-5) << "depth";
}

TEST(EmbreeLight, AFloorUnderTheSkyHasTheIntegral) {
  Sky sky;
  sky.sun = {0, 0, 0};
  const Renderer renderer(Geometry(floor_of({0.6, 0.6, 0.6})), askew, sky, 16, 16);
  // 1 / pi times radiance times the cosine over the half sphere: 2 c dc, c the cosine.
  double integral = 0;
  for (int i = 0; i < 10000; ++i) {
    const double c = (i + 0.5) / 10000;
    integral += 2 * c * sky.radiance({std::sqrt(1 - c * c), 0, c}).x / 10000;
  }
  const auto [mean, deviation] = estimate_of(renderer, 8, 8, 0);
  EXPECT_NEAR(mean, 0.6 * integral, 5 * deviation);
  EXPECT_LT(deviation, 0.01 * mean);
}

TEST(EmbreeLight, TheSunShinesByItsHeight) {
  Sky sky = uniform_sky(0);
  sky.to_sun = {1, 0, 1};
  sky.sun = {2, 2, 2};
  for (const double radius : {0.001, 0.3}) {
    sky.sun_radius = radius;
    const Renderer renderer(Geometry(floor_of({0.6, 0.6, 0.6})), askew, sky, 16, 16);
    // The mean of a direction over the cap is along its middle, (1 + cos radius) / 2 long.
    const double expected = 0.6 / pi * 2 * std::sqrt(0.5) * (1 + std::cos(radius)) / 2;
    const auto [mean, deviation] = estimate_of(renderer, 8, 8, 0);
    EXPECT_NEAR(mean, expected, 5 * deviation + 1e-6) << radius;
  }
}

TEST(EmbreeLight, TheShadowOfAnEdgeIsTheShareOfTheSun) {
  // A roof over x > e, 10 above the floor; the sun stands upright over the origin. What is seen of
  // its disc is a segment of a circle.
  constexpr double height = 10, radius = 0.05;
  for (const double edge : {-0.4, -0.2, 0.0, 0.3}) {
    Model model = floor_of({0.5, 0.5, 0.5});
    model.add_rectangle({edge, -50, height}, {100, 0, 0}, {0, 100, 0}, 1, 0);
    Sky sky = uniform_sky(0);
    sky.to_sun = {0, 0, 1};
    sky.sun_radius = radius;
    const Renderer renderer(Geometry(std::move(model)), askew, sky, 16, 16);
    const double d = edge / height / std::sin(radius);  // flat, as far as so small a disc is
    const double share = d >= 1    ? 1
                         : d <= -1 ? 0
                                   : 1 - (std::acos(d) - d * std::sqrt(1 - d * d)) / pi;
    const auto [mean, deviation] = estimate_of(renderer, 8, 8, 9);
    EXPECT_NEAR(mean, share, 5 * deviation + 1e-3) << edge;
    EXPECT_GT(deviation, 0) << edge << ": in the half shadow";
  }
}

TEST(EmbreeLight, AWallCastsLightOnTheFloor) {
  // A wall of height h and a depth beyond all need, at distance d. Seen from the floor it fills
  // F = (1 - d / sqrt(d^2 + h^2)) / 2; half of what it sees is sky.
  constexpr double distance = 1.5, height = 2, albedo = 0.7;
  Model model = floor_of({albedo, albedo, albedo});
  model.add_rectangle({distance, 1000, 0}, {0, -2000, 0}, {0, 0, height}, 1, 0);
  const Renderer renderer(Geometry(std::move(model)), askew, uniform_sky(1), 16, 16);
  const double filled = 0.5 * (1 - distance / std::hypot(distance, height));
  const double expected = albedo * (1 - filled + filled * albedo / 2);
  const auto [mean, deviation] = estimate_of(renderer, 8, 8, 0, 40000);
  EXPECT_NEAR(mean, expected, 5 * deviation);
  EXPECT_LT(deviation, 0.002);
}

TEST(EmbreeLight, NoLightComesIntoAClosedBox) {
  Model model;
  model.materials = {{}};
  model.add_box({-1, -1, -1}, {1, 1, 1}, 1, 0);
  const View inside{{0.3, -0.4, 0.2}, {0, 0.9, 0.1}, 0.8};
  const Renderer renderer(Geometry(std::move(model)), inside, {}, 16, 16);
  for (double x = 0; x <= 16; x += 2) {
    EXPECT_EQ(estimate_of(renderer, x, 16 - x, 0, 500).mean, 0);
    EXPECT_EQ(estimate_of(renderer, x, 16 - x, 9, 500).mean, 0);
  }
}

TEST(EmbreeLight, MorePathsASampleHaveTheSameMean) {
  View view;
  const auto estimate = [&](std::uint32_t paths) {
    const Renderer renderer(Geometry(make_colonnade(view)), view, {}, 64, 36, paths);
    return estimate_of(renderer, 45.5, 25.5, 0, 16000);
  };
  const auto [one, one_deviation] = estimate(1);
  const auto [many, many_deviation] = estimate(4);
  EXPECT_NEAR(one, many, 5 * std::hypot(one_deviation, many_deviation));
  EXPECT_LT(many_deviation, 0.6 * one_deviation);
}

}  // namespace
}  // namespace embree_host
