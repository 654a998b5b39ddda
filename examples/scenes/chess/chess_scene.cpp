// SPDX-License-Identifier: MIT
#include "chess_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "table.h"

namespace scenes::chess {
namespace {

// The Giuoco Piano: everything is still on the board, and the middle of it is not empty.
constexpr std::string_view kPlacement = "r1bqk2r/ppp2ppp/2np1n2/2b1p3/2B1P3/2PP1N2/PP3PPP/RNBQ1RK1";

constexpr Vec3 kEye{-2.1, -12.0, 6.4};
constexpr Vec3 kTarget{0.45, 0.5, 1.05};
constexpr double kHalfField = 0.475;  // tangent of half the field of view of the lesser side

struct Lamp {
  Vec3 position;
  Vec3 color;
};
constexpr std::array<Lamp, 2> kLamps = {{
    {{-10.0, -4.0, 13.0}, {1.15, 1.05, 0.88}},
    {{9.0, -9.0, 9.0}, {0.17, 0.20, 0.26}},
}};

constexpr Material kLightPiece{{0.80, 0.66, 0.42}, 0.05, 2.2, 160.0};
constexpr Material kDarkPiece{{0.170, 0.032, 0.022}, 0.06, 2.2, 160.0};

constexpr int kMaxBounces = 5;
// Reflections that add less than this to the picture are faded out and not followed.
constexpr double kLeastWeight = 0.006;
// Secondary rays start this far above their surface.
constexpr double kLift = 5e-5;
constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3 sky(const Vec3& direction) {
  constexpr Vec3 kHorizon{0.46, 0.50, 0.56};
  constexpr Vec3 kZenith{0.08, 0.15, 0.32};
  return mix(kHorizon, kZenith, std::pow(std::max(direction.z, 0.0), 0.6));
}

Vec3 ambient(const Vec3& normal) {
  constexpr Vec3 kFromBelow{0.075, 0.065, 0.055};
  constexpr Vec3 kFromAbove{0.16, 0.185, 0.22};
  return mix(kFromBelow, kFromAbove, 0.5 + 0.5 * normal.z);
}

// The share of light that a clear coat mirrors (Schlick 1994).
double fresnel(double reflectance, double cosine) {
  const double s = 1.0 - cosine;
  const double s2 = s * s;
  return reflectance + (1.0 - reflectance) * s2 * s2 * s;
}

}  // namespace

// What a ray has met.
struct ChessScene::Surface {
  double t = kFar;
  Vec3 point;   // lifted off the surface
  Vec3 normal;  // of unit length, on the ray's side
  Material material{};
  double openness = 1.0;  // share of the sky that is not hidden by things close by
  bool is_ground = false;
};

ChessScene::ChessScene(int width, int height)
    : set_(kPlacement), camera_(kEye, kTarget, kHalfField, width, height) {}

bool ChessScene::find_surface(const Ray& ray, Surface& surface) const {
  std::optional<Hit> nearest = Board::intersect(ray, 0.0, kFar);
  const bool on_board = nearest.has_value();
  if (!on_board) nearest = Ground::intersect(ray, 0.0, kFar);
  const auto piece = set_.intersect(ray, 0.0, nearest ? nearest->t : kFar);
  if (piece) nearest = piece->hit;
  if (!nearest) return false;

  const Vec3 p = ray.at(nearest->t);
  const Vec3 outward = normalize(nearest->normal);
  surface.t = nearest->t;
  surface.normal = dot(outward, ray.direction) > 0.0 ? -outward : outward;
  surface.point = p + kLift * surface.normal;
  surface.is_ground = !piece && !on_board;
  if (piece) {
    surface.material = piece->is_light ? kLightPiece : kDarkPiece;
    surface.openness = 0.55 + 0.45 * smoothstep(0.0, 0.7, p.z);
  } else if (on_board) {
    surface.material = Board::material(p);
    surface.openness = set_.openness(p.x, p.y);
  } else {
    surface.material = Ground::material(p);
    surface.openness = Ground::openness(p);
  }
  return true;
}

bool ChessScene::is_shadowed(const Surface& surface, const Vec3& to_lamp, double distance) const {
  const Ray ray{surface.point, to_lamp};
  // The board is convex and all lamps are above it: it can only hide them from the ground.
  if (surface.is_ground && Board::intersect(ray, 0.0, distance)) return true;
  return set_.intersect(ray, 0.0, distance).has_value();
}

Vec3 ChessScene::lamp_light(const Ray& ray, const Surface& surface) const {
  const Material& material = surface.material;
  Vec3 light;
  for (const Lamp& lamp : kLamps) {
    const Vec3 path = lamp.position - surface.point;
    const double distance = length(path);
    const Vec3 to_lamp = (1.0 / distance) * path;
    const double cosine = dot(surface.normal, to_lamp);
    if (cosine <= 0.0 || is_shadowed(surface, to_lamp, distance)) continue;
    const Vec3 half = normalize(to_lamp - ray.direction);
    const double shine =
        material.highlight * std::pow(std::max(dot(surface.normal, half), 0.0), material.shininess);
    light = light + lamp.color * (cosine * material.color + Vec3{shine, shine, shine});
  }
  return light;
}

Vec3 ChessScene::trace(const Ray& ray, double weight, int bounces) const {
  Surface surface;
  if (!find_surface(ray, surface)) return sky(ray.direction);

  const double cosine = std::clamp(-dot(surface.normal, ray.direction), 0.0, 1.0);
  const double mirrored = fresnel(surface.material.reflectance, cosine);
  Vec3 light = lamp_light(ray, surface) + (1.0 - mirrored) * surface.openness *
                                              (surface.material.color * ambient(surface.normal));

  const double next_weight = weight * mirrored;
  // Fading instead of a sudden end: no contour where the weight crosses the limit.
  const double fade = smoothstep(kLeastWeight, 2.0 * kLeastWeight, next_weight);
  if (bounces > 0 && fade > 0.0) {
    const Vec3 direction = ray.direction + (2.0 * cosine) * surface.normal;
    light = light + fade * mirrored *
                        trace({surface.point, normalize(direction)}, next_weight, bounces - 1);
  }
  if (surface.is_ground) {
    // Haze hides the horizon.
    const double clear = std::exp(-surface.t * surface.t / (60.0 * 60.0));
    light = mix(sky({0.0, 0.0, 0.0}), light, clear);
  }
  return light;
}

void ChessScene::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const Vec3 light = trace(camera_.ray(x, y), 1.0, kMaxBounces);
  store(light, rgb);
}

}  // namespace scenes::chess
