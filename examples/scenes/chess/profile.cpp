// SPDX-License-Identifier: MIT
#include "profile.h"

#include <algorithm>
#include <cassert>

namespace scenes::chess {

Profile::Profile(double radius) : radius_(radius), max_square_(radius * radius) {}

Profile& Profile::line(double z, double radius) {
  // r = r0 + slope (z - z0), squared.
  const double slope = (radius - radius_) / (z - z_);
  const double at_zero = radius_ - slope * z_;
  add(z, at_zero * at_zero, 2.0 * at_zero * slope, slope * slope);
  radius_ = radius;
  return *this;
}

Profile& Profile::curve(double middle, double z, double radius) {
  // The parabola through the three squared radii, first in s = (z - z0) / (z1 - z0).
  const double q0 = radius_ * radius_;
  const double q1 = middle * middle;
  const double q2 = radius * radius;
  const double bend = 2.0 * (q0 - 2.0 * q1 + q2);
  const double slope = -3.0 * q0 + 4.0 * q1 - q2;
  const double h = z - z_;
  const double c2 = bend / (h * h);
  const double c1 = slope / h - 2.0 * c2 * z_;
  add(z, q0 - z_ * (slope / h - c2 * z_), c1, c2);
  radius_ = radius;
  return *this;
}

Profile& Profile::step(double radius) {
  const double from = radius_ * radius_;
  const double to = radius * radius;
  rings_.push_back({z_, std::min(from, to), std::max(from, to), to < from ? 1.0 : -1.0});
  max_square_ = std::max(max_square_, to);
  radius_ = radius;
  return *this;
}

Profile& Profile::ball(double radius) {
  assert(radius >= radius_);
  const double center = z_ + std::sqrt(radius * radius - radius_ * radius_);
  add(center + radius, radius * radius - center * center, 2.0 * center, -1.0);
  radius_ = 0.0;
  return *this;
}

void Profile::add(double z, double c0, double c1, double c2) {
  assert(z > z_);
  const auto square = [&](double height) { return c0 + height * (c1 + height * c2); };
  double greatest = std::max(square(z_), square(z));
  if (c2 < 0.0) greatest = std::max(greatest, square(std::clamp(-0.5 * c1 / c2, z_, z)));
  pieces_.push_back({z_, z, c0, c1, c2, greatest});
  max_square_ = std::max(max_square_, greatest);
  z_ = z;
}

bool Profile::contains(const Vec3& p) const {
  const double square = p.x * p.x + p.y * p.y;
  for (const Piece& piece : pieces_) {
    if (p.z >= piece.z0 && p.z <= piece.z1) {
      return square < piece.c0 + p.z * (piece.c1 + p.z * piece.c2);
    }
  }
  return false;
}

}  // namespace scenes::chess
