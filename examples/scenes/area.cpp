// SPDX-License-Identifier: MIT
#include "area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

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

// A convex polygon. A line adds at most one corner: two lines make six of a square.
struct Polygon {
  std::array<Point, 6> corners{};
  std::size_t size = 0;

  void add(const Point& p) { corners[size++] = p; }
};

// The part of a polygon on the side of a line through the origin that its normal points to
// (Sutherland and Hodgman 1974).
Polygon clip(const Polygon& polygon, const Point& normal) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Point& p = polygon.corners[i];
    const Point& q = polygon.corners[(i + 1) % polygon.size];
    const double from = dot(p, normal);
    const double to = dot(q, normal);
    if (from >= 0.0) inside.add(p);
    if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
      const double t = from / (from - to);
      inside.add({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
  }
  return inside;
}

// The area of the polygon's part within the disc about the origin.
double area_in_disc(const Polygon& polygon, double radius) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    twice += twice_triangle(polygon.corners[i], polygon.corners[(i + 1) % polygon.size], radius);
  }
  return std::clamp(0.5 * twice, 0.0, 1.0);
}

Polygon pixel(double left, double top) {
  return {{{{left, top}, {left + 1.0, top}, {left + 1.0, top + 1.0}, {left, top + 1.0}}}, 4};
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
  return area_in_disc(pixel(left, top), radius);
}

double left_area(double at_top, double at_bottom) {
  // The integral of max(x, 0) over the line, which is straight from `from` to `to`.
  const auto positive = [](double from, double to) {
    const double low = std::min(from, to);
    const double high = std::max(from, to);
    if (high <= 0.0) return 0.0;
    return low >= 0.0 ? 0.5 * (low + high) : 0.5 * high * (high / (high - low));
  };
  return std::clamp(positive(at_top, at_bottom) - positive(at_top - 1.0, at_bottom - 1.0), 0.0,
                    1.0);
}

double sector_area(double left, double top, double radius, double begin, double end) {
  const auto direction = [](double turns) {
    const double angle = 2.0 * std::numbers::pi * turns;
    return Point{std::cos(angle), std::sin(angle)};
  };
  const Point first = direction(begin);
  const Point last = direction(end);
  const Polygon half = clip(pixel(left, top), {-first.y, first.x});
  return area_in_disc(clip(half, {last.y, -last.x}), radius);
}

}  // namespace scenes
