// SPDX-License-Identifier: MIT
#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace scenes::chess {
namespace {

constexpr double kSquares = 4.0;  // half the width of the 8 squares
constexpr double kTopHalf = 4.46;
constexpr double kChamfer = 0.09;
constexpr double kSideHalf = kTopHalf + kChamfer;
constexpr double kTile = 2.0;
// The ground ends where the haze has long hidden it, before cells get too many to count.
constexpr double kGroundEnd = 1e6;

// The half space dot(normal, p) <= offset.
struct HalfSpace {
  Vec3 normal;
  double offset;
};

constexpr HalfSpace kBoardSides[] = {
    {{0.0, 0.0, 1.0}, 0.0},        {{1.0, 0.0, 0.0}, kSideHalf},
    {{-1.0, 0.0, 0.0}, kSideHalf}, {{0.0, 1.0, 0.0}, kSideHalf},
    {{0.0, -1.0, 0.0}, kSideHalf}, {{1.0, 0.0, 1.0}, kTopHalf},
    {{-1.0, 0.0, 1.0}, kTopHalf},  {{0.0, 1.0, 1.0}, kTopHalf},
    {{0.0, -1.0, 1.0}, kTopHalf},  {{0.0, 0.0, -1.0}, Board::kThickness},
};

// Whether the checker cell of side 1 that holds (x, y) is an odd one.
bool is_odd_cell(double x, double y) {
  const auto cell =
      static_cast<std::int64_t>(std::floor(x)) + static_cast<std::int64_t>(std::floor(y));
  return (cell & 1) != 0;
}

}  // namespace

std::optional<Hit> Board::intersect(const Ray& ray, double t0, double t1) {
  const Vec3* entered = nullptr;
  for (const auto& [normal, offset] : kBoardSides) {
    const double speed = dot(normal, ray.direction);
    const double room = offset - dot(normal, ray.origin);
    if (speed < 0.0) {
      if (room / speed > t0) {
        t0 = room / speed;
        entered = &normal;
      }
    } else if (speed > 0.0) {
      t1 = std::min(t1, room / speed);
    } else if (room < 0.0) {
      return std::nullopt;
    }
    if (t0 > t1) return std::nullopt;
  }
  if (entered == nullptr) return std::nullopt;
  return Hit{t0, *entered};
}

Material Board::material(const Vec3& p) {
  constexpr Vec3 kLight{0.74, 0.67, 0.54};
  constexpr Vec3 kDark{0.050, 0.120, 0.098};
  constexpr Vec3 kFrame{0.150, 0.060, 0.028};
  constexpr Vec3 kInlay{0.60, 0.45, 0.22};
  const double reach = std::max(std::abs(p.x), std::abs(p.y));
  if (reach < kSquares) {
    // a1, at negative x and y, is dark.
    return {is_odd_cell(p.x, p.y) ? kLight : kDark, 0.13, 0.5, 120.0};
  }
  const bool is_inlay =
      reach < kSquares + 0.03 || (reach > kSquares + 0.13 && reach < kSquares + 0.17);
  return {is_inlay ? kInlay : kFrame, 0.10, 0.5, 120.0};
}

std::optional<Hit> Ground::intersect(const Ray& ray, double t0, double t1) {
  if (ray.direction.z >= 0.0) return std::nullopt;
  const double t = (-Board::kThickness - ray.origin.z) / ray.direction.z;
  if (!(t >= t0 && t < std::min(t1, kGroundEnd))) return std::nullopt;
  return Hit{t, {0.0, 0.0, 1.0}};
}

Material Ground::material(const Vec3& p) {
  constexpr Vec3 kLight{0.245, 0.23, 0.215};
  constexpr Vec3 kDark{0.115, 0.125, 0.145};
  // Turned, so that its lines do not run along with the board's.
  const double u = (p.x + p.y) * (0.5 * std::numbers::sqrt2 / kTile);
  const double v = (p.x - p.y) * (0.5 * std::numbers::sqrt2 / kTile);
  return {is_odd_cell(u, v) ? kLight : kDark, 0.03, 0.15, 40.0};
}

double Ground::openness(const Vec3& p) {
  const double dx = std::max(std::abs(p.x) - kSideHalf, 0.0);
  const double dy = std::max(std::abs(p.y) - kSideHalf, 0.0);
  const double near = std::clamp(1.0 - std::hypot(dx, dy) / (2.5 * Board::kThickness), 0.0, 1.0);
  return 1.0 - 0.5 * near * near;
}

}  // namespace scenes::chess
