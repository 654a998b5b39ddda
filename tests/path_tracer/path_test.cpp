// SPDX-License-Identifier: MIT
// The path tracer of the examples keeps energy, and its two ways to find lights agree.

#include "path_tracer/path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "path_tracer/scattering.h"
#include "path_tracer/scene.h"

namespace path_tracer {
namespace {

Decisions decisions_of(std::uint64_t seed, Numbers numbers = Numbers::random) {
  return {numbers, {seed, 0, scenes::mix_bits(seed + 1), 0}};
}

double mean_of(const Vec3& v) { return (v.x + v.y + v.z) / 3; }

/// Mean of independent paths, and the standard deviation of that mean.
struct Estimate {
  double mean = 0, deviation = 0;

  template <class Function>
  Estimate(std::uint64_t count, const Function& function) {
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = function(i);
      sum += value;
      squares += value * value;
    }
    const auto n = static_cast<double>(count);
    mean = sum / n;
    deviation = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
  }
};

TEST(Furnace, WhiteThingsCannotBeSeenUnderAWhiteSky) {
  // Nothing is lost anywhere, so each path brings exactly what the sky has.
  World world;
  world.horizon = world.zenith = {1, 1, 1};
  world.add(Sphere{{0, 0, 0}, 1, {}, {{1, 1, 1}}});
  world.add(Sphere{{2.1, 0, 0}, 1, {0, 0.5, 0}, {{1, 1, 1}, Scattering::glass}});
  world.add(Sphere{{0, 2.1, 0}, 1, {}, {{1, 1, 1}, Scattering::mirror}});
  world.add_box({2, 2, 0}, {1, 1, 1}, 0.3, {{1, 1, 1}});
  int met = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const Decisions decisions = decisions_of(i);
    const auto place = decisions.pair(1000);
    const Vec3 origin{8, 7, 6};
    const Vec3 target{3 * place[0] - 0.5, 3 * place[1] - 0.5, 0.2};
    const PathSample sample = trace(world, {origin, normalize(target - origin)}, 0.3, decisions);
    met += sample.nearness > 0;
    ASSERT_NEAR(sample.radiance.x, 1, 1e-12);
    ASSERT_NEAR(sample.radiance.z, 1, 1e-12);
  }
  EXPECT_GT(met, 2000);
}

TEST(Furnace, AClosedBoxShinesAsTheSumOfAllReflections) {
  // Walls that emit e and scatter a: e / (1 - a) wherever one looks.
  const Material wall{{0.6, 0.6, 0.6}, Scattering::diffuse, {0.5, 0.5, 0.5}};
  World world;
  for (const auto& [corner, a, b] : {std::array{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}},
                                     std::array{Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}},
                                     std::array{Vec3{0, 0, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 0}},
                                     std::array{Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}},
                                     std::array{Vec3{0, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}},
                                     std::array{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 1, 0}}}) {
    world.add(Rectangle{corner, a, b, wall});
  }
  world.add(Sphere{{0.4, 0.5, 0.4}, 0.2, {}, {{1, 1, 1}, Scattering::glass}});
  ASSERT_EQ(world.lights(), 6u);
  // By chance: asked lights that meet in a corner are as bright as one likes.
  const Estimate estimate(40000, [&](std::uint64_t i) {
    const Decisions decisions = decisions_of(i);
    const Vec3 direction = diffuse_direction({0, 0, 1}, decisions.pair(1000));
    return trace(world, {{0.7, 0.4, 0.5}, direction}, 0, decisions, {.ask_lights = false})
        .radiance.x;
  });
  EXPECT_NEAR(estimate.mean, 0.5 / (1 - 0.6), 5 * estimate.deviation);
  EXPECT_LT(estimate.deviation, 0.02);
}

TEST(Lights, AFloorUnderALampIsAsBrightAsTheIntegralSays) {
  World world;
  world.add(Rectangle{{-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, {{0.8, 0.8, 0.8}}});
  const Material lamp{{0, 0, 0}, Scattering::diffuse, {3, 3, 3}};
  world.add(Rectangle{{-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}, lamp});
  double expected = 0;  // albedo / pi times radiance times cosines over squares of distances
  for (int i = 0; i < 10000; ++i) {
    const Vec3 to{(i % 100 + 0.5) / 100 - 0.5 - 0.3, (i / 100 + 0.5) / 100 - 0.5, 2};
    const double square = dot(to, to);
    expected += 0.8 / std::numbers::pi * 3 * (to.z * to.z / square) / square / 10000;
  }
  const Ray down{{0.3, 0, 0.5}, {0, 0, -1}};
  for (const bool ask : {false, true}) {
    const Estimate estimate(60000, [&](std::uint64_t i) {
      return trace(world, down, 0, decisions_of(i), {.ask_lights = ask}).radiance.x;
    });
    EXPECT_NEAR(estimate.mean, expected, 5 * estimate.deviation + 1e-5) << ask;
    EXPECT_LT(estimate.deviation, 0.05 * expected) << ask;
  }
  // From behind a lamp is dark.
  const Ray up{{0, 0, 3}, {0, 0, -1}};
  EXPECT_EQ(trace(world, up, 0, decisions_of(1)).radiance.x, 0);
}

TEST(Lights, AskedOrMetByChanceTheMeanIsTheSame) {
  for (const std::string_view name : scene_names) {
    const Scene scene = make_scene(name, 64, 64);
    // Over the whole picture, and so over all kinds of paths.
    const auto picture = [&](bool ask, std::uint64_t first) {
      return Estimate(400000, [&](std::uint64_t i) {
        const Decisions decisions = decisions_of(first + i);
        const auto place = decisions.pair(1000);
        return mean_of(scene.sample(64 * place[0], 64 * place[1], decisions, {ask}).radiance);
      });
    };
    const Estimate asked = picture(true, 0);
    const Estimate met = picture(false, 1u << 30);
    EXPECT_NEAR(asked.mean, met.mean, 5 * std::hypot(asked.deviation, met.deviation)) << name;
    EXPECT_LT(asked.deviation, met.deviation) << name;
    EXPECT_LT(met.deviation, 0.05 * met.mean) << name << ": else it says nothing";
  }
}

TEST(Lights, SobolPointsHaveTheSameMeanAsRandomNumbers) {
  for (const std::string_view name : scene_names) {
    const Scene scene = make_scene(name, 64, 64);
    const auto picture = [&](Numbers numbers) {
      // A mean over a pixel is one value; its four samples belong together.
      return Estimate(50000, [&](std::uint64_t i) {
        const auto place = decisions_of(i).pair(1000);
        double mean = 0;
        for (std::uint32_t k = 0; k < 4; ++k) {
          const Decisions decisions(numbers, {i, k, scenes::mix_bits(4 * i + k + 1), 0});
          mean += mean_of(scene.sample(64 * place[0], 64 * place[1], decisions).radiance) / 4;
        }
        return mean;
      });
    };
    const Estimate random = picture(Numbers::random);
    const Estimate sobol = picture(Numbers::sobol);
    EXPECT_NEAR(random.mean, sobol.mean, 5 * std::hypot(random.deviation, sobol.deviation)) << name;
  }
}

TEST(Glass, MirrorsWhatFresnelSays) {
  EXPECT_NEAR(mirrored_share(1, 1 / 1.5), 0.04, 1e-12);
  EXPECT_NEAR(mirrored_share(1, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(mirrored_share(1e-9, 1 / 1.5), 1, 1e-7);
  EXPECT_EQ(mirrored_share(0.7, 1.5), 1) << "beyond the critical angle, cosine 0.745";
  EXPECT_LT(mirrored_share(0.75, 1.5), 1);
  // The same share on both sides of the way of a ray.
  for (const double cosine : {0.1, 0.4, 0.8}) {
    const double other = std::sqrt(1 - (1 - cosine * cosine) / (1.5 * 1.5));
    EXPECT_NEAR(mirrored_share(cosine, 1 / 1.5), mirrored_share(other, 1.5), 1e-12);
  }
}

TEST(Glass, RefractsAsSnellSays) {
  const Vec3 normal = normalize(Vec3{0.3, -0.2, 0.9});
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Vec3 in = -diffuse_direction(normal, decisions_of(i).pair(0));
    const Vec3 out = glass_direction(in, normal, 0.999999);
    if (dot(out, normal) > 0) continue;  // mirrored all the same, at a very flat angle
    EXPECT_NEAR(length(cross(in, normal)), 1.5 * length(cross(out, normal)), 1e-9);
    EXPECT_NEAR(dot(cross(in, normal), out), 0, 1e-9) << "in one plane";
    // And the way back.
    const Vec3 back = glass_direction(-out, normal, 0.999999);
    EXPECT_NEAR(length(back + in), 0, 1e-7);
  }
}

TEST(Diffuse, DirectionsHaveADensityOfTheCosine) {
  const Vec3 normal = normalize(Vec3{-0.5, 0.1, -0.7});
  const Estimate cosine(100000, [&](std::uint64_t i) {
    const Vec3 direction = diffuse_direction(normal, decisions_of(i).pair(0));
    EXPECT_NEAR(length(direction), 1, 1e-12);
    return dot(direction, normal);
  });
  EXPECT_NEAR(cosine.mean, 2.0 / 3, 5 * cosine.deviation);
  const Estimate square(100000, [&](std::uint64_t i) {
    return std::pow(dot(diffuse_direction(normal, decisions_of(i).pair(0)), normal), 2);
  });
  EXPECT_NEAR(square.mean, 0.5, 5 * square.deviation);
}

TEST(World, FindsTheNearestSurfaceOfAll) {
  // Against small steps along the ray: no sign of any shape changes before the distance found.
  const Scene scene = make_scene("cornell", 32, 32);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto place = decisions_of(i).pair(0);
    const Ray ray = scene.camera.ray(32 * place[0], 32 * place[1]);
    const auto surface = scene.world.find(ray, 0);
    if (!surface) continue;
    EXPECT_NEAR(length(surface->point - ray.at(surface->distance)), 0, 1e-12);
    EXPECT_NEAR(length(surface->normal), 1, 1e-12);
    EXPECT_FALSE(scene.world.is_hidden(ray, 0, surface->distance * 0.999999));
    EXPECT_TRUE(scene.world.is_hidden(ray, 0, surface->distance * 1.000001));
    const Vec3 from_glass = ray.at(surface->distance) - Vec3{0.68, 0.33, 0.19};
    EXPECT_GE(length(from_glass), 0.19 - 1e-9) << "nothing is met within the ball from outside";
  }
}

TEST(Lens, RaysOfAPositionMeetInFocus) {
  const Scene scene = make_scene("spheres", 64, 48);
  const Ray first = scene.ray(20, 30, {0.1, 0.2});
  const Vec3 meeting = scene.camera.eye() + scene.focus * scene.camera.direction(20, 30);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Ray ray = scene.ray(20, 30, decisions_of(i).pair(1));
    EXPECT_LE(length(ray.origin - scene.camera.eye()), scene.lens_radius + 1e-12);
    EXPECT_NEAR(length(cross(meeting - ray.origin, ray.direction)), 0, 1e-9);
  }
  EXPECT_GT(length(first.origin - scene.camera.eye()), 0);
}

TEST(Sphere, MovesWhileTheShutterIsOpen) {
  const Sphere ball{{0, 0, 0}, 1, {3, 0, 0}, {}};
  const Ray ray{{3, -5, 0}, {0, 1, 0}};
  EXPECT_EQ(ball.nearest(ray, 0, 100), 100);
  EXPECT_NEAR(ball.nearest(ray, 1, 100), 4, 1e-12);
  EXPECT_NEAR(ball.normal(ray.at(4), 1).y, -1, 1e-12);
  EXPECT_NEAR(ball.nearest({{3, 0, 0}, {0, 1, 0}}, 1, 100), 1, 1e-12) << "from within";
}

}  // namespace
}  // namespace path_tracer
