#include "area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace scenes {
namespace {

struct Point {
  double x, y;
};

double dot(const Point& p, const Point& q) { return p.x * q.x + p.y * q.y; }
double cross(const Point& p, const Point& q) { return p.x * q.y - p.y * q.x; }

// Twice the signed area of the disc's part within the triangle (origin, p, q).
double twice_triangle(const Point& p, const Point& q, double radius) {
  const double square = radius * radius;
  const auto sector = [&](const Point& from, const Point& to) {
    return square * std::atan2(cross(from, to), dot(from, to));
  };
  const Point d{q.x - p.x, q.y - p.y};
  const double a = dot(d, d);
  const double b = dot(p, d);
  const double discriminant = b * b - a * (dot(p, p) - square);
  if (discriminant <= 0.0) return sector(p, q);
  const double t0 = (-b - std::sqrt(discriminant)) / a;
  const double t1 = (-b + std::sqrt(discriminant)) / a;
  if (t1 <= 0.0 || t0 >= 1.0) return sector(p, q);
  const double in = std::max(t0, 0.0);
  const double out = std::min(t1, 1.0);
  const Point u{p.x + in * d.x, p.y + in * d.y};
  const Point v{p.x + out * d.x, p.y + out * d.y};
  // A side that begins or ends inside the disc has no sector there.
  return (t0 > 0.0 ? sector(p, u) : 0.0) + cross(u, v) + (t1 < 1.0 ? sector(v, q) : 0.0);
}

}  // namespace

double half_plane_area(double a, double b, double c) {
  // The square is symmetric: let the normal point right and down.
  if (a < 0.0) {
    c -= a;
    a = -a;
  }
  if (b < 0.0) {
    c -= b;
    b = -b;
  }
  // The triangle that the line cuts off the quadrant x, y > 0, without what lies beyond x = 1 and
  // y = 1; what lies beyond both was taken away twice.
  const auto square = [](double s) { return s > 0.0 ? s * s : 0.0; };
  const double twice = square(c) - square(c - a) - square(c - b) + square(c - a - b);
  return std::clamp(twice / (2.0 * a * b), 0.0, 1.0);
}

double disc_area(double left, double top, double radius) {
  const std::array<Point, 4> corners = {
      {{left, top}, {left + 1.0, top}, {left + 1.0, top + 1.0}, {left, top + 1.0}}};
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    twice += twice_triangle(corners[i], corners[(i + 1) % corners.size()], radius);
  }
  return std::clamp(0.5 * twice, 0.0, 1.0);
}

}  // namespace scenes
