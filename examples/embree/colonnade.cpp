// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model.h"
#include "scenes/random.h"

namespace embree_host {
namespace {

constexpr double turn = 2 * std::numbers::pi;

double hash(int x, int y, int seed) {
  scenes::Random random(static_cast<std::uint64_t>(seed),
                        static_cast<std::uint64_t>(x) * 1000003u + static_cast<std::uint64_t>(y));
  return random.uniform();
}

/// Smooth noise that repeats after `period` cells, in 0..1.
double noise(double x, double y, int period, int seed) {
  const double i = std::floor(x), j = std::floor(y);
  const auto cell = [&](int a, int b) {
    const auto wrap = [&](double t, int step) {
      return ((static_cast<int>(t) + step) % period + period) % period;
    };
    return hash(wrap(i, a), wrap(j, b), seed);
  };
  const double s = scenes::smoothstep(0, 1, x - i), t = scenes::smoothstep(0, 1, y - j);
  return std::lerp(std::lerp(cell(0, 0), cell(1, 0), s), std::lerp(cell(0, 1), cell(1, 1), s), t);
}

double grain(double u, double v, int seed) {
  double sum = 0;
  for (int octave = 0; octave < 4; ++octave) {
    const int period = 8 << octave;
    sum += noise(u * period, v * period, period, seed + octave) / (2 << octave);
  }
  return sum;  // 0 .. 15/16
}

/// Slabs of four by four a repeat, with joints.
Vec3 paving(double u, double v) {
  const double row = std::floor(4 * v);
  const double across = 4 * u + 0.5 * std::fmod(row, 2);
  const double s = across - std::floor(across), t = 4 * v - row;
  const double joint = std::min({s, 1 - s, t, 1 - t});
  const double tint =
      0.75 + 0.35 * hash(static_cast<int>(std::floor(across)) % 4, static_cast<int>(row), 11);
  const double shade = tint * (0.7 + 0.5 * grain(u, v, 3)) * (joint < 0.02 ? 0.35 : 1);
  return shade * Vec3{0.62, 0.54, 0.44};
}

Vec3 marble(double u, double v) {
  const double vein = std::abs(std::sin(turn * (u + v) + 9 * grain(u, v, 23)));
  return (0.72 + 0.2 * std::pow(vein, 0.4)) * Vec3{0.92, 0.9, 0.86};
}

Vec3 glaze(double u, double v) {
  const bool odd = (static_cast<int>(16 * u) + static_cast<int>(4 * v)) % 2 != 0;
  const double tint = 0.85 + 0.3 * grain(u, v, 41);
  return tint * (odd ? Vec3{0.75, 0.16, 0.07} : Vec3{0.8, 0.5, 0.16});
}

enum : std::uint32_t { ground, stone, knot, ball };

void add_column(Model& model, double x, double y, double foot) {
  constexpr double height = 6, radius = 0.5;
  model.add_box({x - 0.7, y - 0.7, foot}, {x + 0.7, y + 0.7, foot + 0.2}, 1.5, stone);
  model.add_box({x - 0.7, y - 0.7, foot + height}, {x + 0.7, y + 0.7, foot + height + 0.25}, 1.5,
                stone);
  // Fluted, and narrower at the top. 20 flutes of 6 pieces.
  model.add_surface(120, 20, {2, 4}, stone, [&](double s, double t) {
    const double flute = std::abs(std::sin(10 * turn * s));
    const double round = radius * (1 - 0.18 * t * t) * (1 - 0.09 * flute);
    return Vec3{x + round * std::cos(turn * s), y + round * std::sin(turn * s),
                foot + 0.2 + (height - 0.4) * t};
  });
  // The cushion below the slab.
  model.add_surface(60, 6, {2, 0.3}, stone, [&](double s, double t) {
    const double round = 0.41 + 0.27 * std::sin(turn / 4 * t);
    return Vec3{x + round * std::cos(turn * s), y + round * std::sin(turn * s),
                foot + height - 0.2 + 0.2 * t};
  });
}

/// A tube along a closed curve that goes three times around while it turns twice (a trefoil).
void add_knot(Model& model, const Vec3& centre, double size) {
  const auto curve = [&](double s) {
    const double angle = turn * s;
    const double wide = 2 + std::cos(3 * angle);
    return centre +
           size * Vec3{wide * std::cos(2 * angle), std::sin(3 * angle), wide * std::sin(2 * angle)};
  };
  model.add_surface(360, 30, {12, 1}, knot, [&](double s, double t) {
    const Vec3 along = normalize(curve(s + 1e-4) - curve(s - 1e-4));
    const Vec3 side = normalize(cross(along, Vec3{0, 1, 0}));
    const Vec3 up = cross(side, along);
    return curve(s) + 0.42 * size * (std::cos(turn * t) * side + std::sin(turn * t) * up);
  });
}

void add_ball(Model& model, const Vec3& centre, double radius) {
  model.add_surface(48, 24, {4, 2}, ball, [&](double s, double t) {
    const double round = radius * std::sin(turn / 2 * t);
    return centre + Vec3{round * std::cos(turn * s), round * std::sin(turn * s),
                         -radius * std::cos(turn / 2 * t)};
  });
}

}  // namespace

Model make_colonnade(View& view) {
  Model model;
  model.textures = {Texture(512, paving), Texture(512, marble), Texture(256, glaze)};
  model.materials = {{{1, 1, 1}, 0}, {{0.9, 0.86, 0.78}, 1}, {{1, 1, 1}, 2}, {{0.2, 0.42, 0.5}, 1}};
  model.add_rectangle({-300, -300, 0}, {600, 0, 0}, {0, 600, 0}, 5, ground);
  for (int step = 0; step < 3; ++step) {
    const double out = 0.5 * (3 - step);
    model.add_box({-5 - out, -13 - out, 0.25 * step}, {5 + out, 13 + out, 0.25 * (step + 1)}, 3,
                  stone);
  }
  constexpr double floor = 0.75;
  for (int row = 0; row < 7; ++row) {
    for (const double x : {-4.0, 4.0}) add_column(model, x, 4.0 * row - 12, floor);
  }
  for (const double x : {-4.0, 4.0}) {
    model.add_box({x - 0.6, -12.8, floor + 6.25}, {x + 0.6, 12.8, floor + 7.2}, 3, stone);
  }
  model.add_box({-1.3, -3.3, floor}, {1.3, -0.7, floor + 0.9}, 2, stone);
  add_knot(model, {0, -2, floor + 2.55}, 0.55);
  for (int i = 0; i < 6; ++i) {
    const double radius = 0.35 + 0.3 * hash(i, 0, 5);
    add_ball(model, {-2.2 + 4.4 * hash(i, 1, 5), -11 + 3.2 * i, floor + radius}, radius);
  }
  view = {{-1.6, -18.5, 2.3}, {0.35, 0, 3.35}, 0.42};
  return model;
}

}  // namespace embree_host
