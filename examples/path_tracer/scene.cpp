// SPDX-License-Identifier: MIT
#include "scene.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scenes/random.h"

namespace path_tracer {
namespace {

Scene cornell(double width, double height) {
  constexpr double depth = 1.0;
  const Material white{{0.73, 0.73, 0.73}};
  const Material red{{0.63, 0.06, 0.05}};
  const Material green{{0.14, 0.45, 0.09}};
  const Material glass{{1, 1, 1}, Scattering::glass};
  const Material lamp{{0.7, 0.7, 0.7}, Scattering::diffuse, {62, 46, 26}};
  constexpr double half = 0.08;  // of the lamp's side

  Scene scene{{}, scenes::Camera({0.5, -1.95, 0.5}, {0.5, 0.5, 0.5}, 0.264, width, height)};
  World& world = scene.world;
  world.add(Rectangle{{0, 0, 0}, {1, 0, 0}, {0, depth, 0}, white});  // floor
  world.add(Rectangle{{0, 0, 1}, {0, depth, 0}, {1, 0, 0}, white});  // ceiling
  world.add(Rectangle{{0, depth, 0}, {1, 0, 0}, {0, 0, 1}, white});  // back
  world.add(Rectangle{{0, 0, 0}, {0, depth, 0}, {0, 0, 1}, red});    // left
  world.add(Rectangle{{1, 0, 0}, {0, 0, 1}, {0, depth, 0}, green});  // right
  world.add(Rectangle{{0.5 - half, 0.5 - half, 0.998}, {0, 2 * half, 0}, {2 * half, 0, 0}, lamp});
  world.add_box({0.33, 0.66, 0}, {0.28, 0.28, 0.56}, -0.3, white);
  world.add(Sphere{{0.68, 0.33, 0.19}, 0.19, {}, glass});
  return scene;
}

Scene spheres(double width, double height) {
  const Vec3 eye{0, -7.5, 2.1};
  const Vec3 target{0, 0, 0.4};
  Scene scene{{}, scenes::Camera(eye, target, 0.3, width, height), 0.09, 0};
  scene.focus = length(target - eye) - 1;
  World& world = scene.world;
  world.horizon = {0.55, 0.62, 0.72};
  world.zenith = {0.12, 0.2, 0.42};
  world.add(Rectangle{{-60, -60, 0}, {120, 0, 0}, {0, 120, 0}, {{0.45, 0.42, 0.38}}});
  const Material lamp{{0.5, 0.5, 0.5}, Scattering::diffuse, {60, 52, 40}};
  world.add(Rectangle{{-3.5, -2.5, 4}, {0, 0.7, 0}, {0.7, 0, 0}, lamp});
  scenes::Random random(7, 0);
  for (int row = -3; row <= 5; ++row) {
    for (int column = -4; column <= 4; ++column) {
      const double radius = 0.22 + 0.16 * random.uniform();
      const Vec3 centre{column + 0.4 * (random.uniform() - 0.5),
                        row + 0.4 * (random.uniform() - 0.5), radius};
      Sphere ball{centre, radius, {}, {}};
      const double angle = 2 * std::numbers::pi * random.uniform();
      for (const auto& [value, phase] :
           {std::pair{&ball.material.colour.x, 0.0}, std::pair{&ball.material.colour.y, 2.1},
            std::pair{&ball.material.colour.z, 4.2}}) {
        *value = 0.45 + 0.35 * std::cos(angle + phase);
      }
      const double kind = random.uniform();
      if (kind > 0.85) {
        ball.material = {{1, 1, 1}, Scattering::glass};
      } else if (kind > 0.7) {
        ball.material = {{0.9, 0.85, 0.75}, Scattering::mirror};
      } else if (kind > 0.5) {
        ball.motion = {0, 0, 0.5 * random.uniform()};
      }
      world.add(ball);
    }
  }
  return scene;
}

}  // namespace

Ray Scene::ray(double x, double y, const std::array<double, 2>& chance) const {
  if (lens_radius == 0) return camera.ray(x, y);
  // All rays of a position meet in the plane that is in focus.
  const Vec3 meeting = camera.eye() + focus * camera.direction(x, y);
  const double radius = lens_radius * std::sqrt(chance[0]);
  const double angle = 2 * std::numbers::pi * chance[1];
  const Vec3 on_lens = camera.eye() + radius * std::cos(angle) * camera.right() +
                       radius * std::sin(angle) * camera.up();
  return {on_lens, normalize(meeting - on_lens)};
}

PathSample Scene::sample(double x, double y, const Decisions& decisions,
                         const PathSettings& settings) const {
  const double time = decisions.pair(Decisions::time_of_shutter)[0];
  return trace(world, ray(x, y, decisions.pair(Decisions::place_on_lens)), time, decisions,
               settings);
}

Scene make_scene(std::string_view name, std::size_t width, std::size_t height) {
  const auto across = static_cast<double>(width), down = static_cast<double>(height);
  if (name == "cornell") return cornell(across, down);
  if (name == "spheres") return spheres(across, down);
  throw std::invalid_argument("unknown scene '" + std::string(name) +
                              "' (known are cornell, spheres)");
}

}  // namespace path_tracer
