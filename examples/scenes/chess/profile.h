// SPDX-License-Identifier: MIT
/// \file
/// Solids of revolution without facets.
#pragma once

#include <cmath>
#include <vector>

#include "../vec3.h"

namespace scenes::chess {

/// A solid of revolution about the z axis, standing on z = 0, as a lathe would turn it.
///
/// Its squared radius is a piecewise quadratic function of the height,
///   r^2(z) = c0 + c1 z + c2 z^2,
/// so that every piece is a quadric: cylinders, cones, spheres, spheroids and hyperboloids are
/// exact, a ray meets a piece at the roots of one quadratic equation, and normals are smooth
/// without any interpolation. Flat rings join pieces of different radius.
class Profile {
 public:
  /// Where a ray crosses the surface; `normal` points outwards and is not normalised.
  struct Crossing {
    double t;
    Vec3 normal;
  };

  /// Begins a profile with the radius `radius` at z = 0. There is no face at z = 0, which stands on
  /// something opaque. The functions below append a piece on top of the last one.
  explicit Profile(double radius);

  /// A cone or cylinder up to radius `radius` at height `z`, which must be above the last height.
  Profile& line(double z, double radius);
  /// A curve up to radius `radius` at height `z` that has radius `middle` half way up.
  Profile& curve(double middle, double z, double radius);
  /// A flat ring at the current height to another radius.
  Profile& step(double radius);
  /// The part above the current height of a ball that continues at the current radius. `radius`
  /// must be at least the current one; the ball's centre lies above the current height.
  Profile& ball(double radius);

  [[nodiscard]] double height() const { return z_; }
  [[nodiscard]] double max_radius() const { return std::sqrt(max_square_); }
  /// Whether `p` lies inside the solid.
  [[nodiscard]] bool contains(const Vec3& p) const;

  /// Calls `found(Crossing)` for every crossing of the ray with the surface within `range`, in no
  /// particular order.
  template <class Found>
  void for_each_crossing(const Ray& ray, Interval range, Found&& found) const;

 private:
  struct Piece {
    double z0, z1;      // height range
    double c0, c1, c2;  // squared radius as a function of z
    double max_square;  // greatest squared radius within the range
  };
  struct Ring {
    double z;
    double inner_square, outer_square;
    double up;  // +1 if it faces up, -1 if it faces down
  };

  void add(double z, double c0, double c1, double c2);

  double z_ = 0.0;
  double radius_;
  double max_square_;
  std::vector<Piece> pieces_;
  std::vector<Ring> rings_;
};

template <class Found>
void Profile::for_each_crossing(const Ray& ray, Interval range, Found&& found) const {
  // Neighbouring pieces overlap by this much, so that no ray slips through where they meet.
  constexpr double kOverlap = 1e-9;
  const Vec3& o = ray.origin;
  const Vec3& d = ray.direction;

  // The squared distance from the axis along the ray is a t^2 + 2 b t + c.
  const double a = d.x * d.x + d.y * d.y;
  const double b = o.x * d.x + o.y * d.y;
  const double c = o.x * o.x + o.y * o.y;
  const double za = o.z + range.t0 * d.z;
  const double zb = o.z + range.t1 * d.z;
  const double low = (za < zb ? za : zb) - kOverlap;
  const double high = (za < zb ? zb : za) + kOverlap;
  const double nearest_square = a > 0.0 ? c - b * b / a - kOverlap : c - kOverlap;

  for (const Piece& piece : pieces_) {
    if (piece.z1 < low || piece.z0 > high || piece.max_square < nearest_square) continue;
    const double qa = a - piece.c2 * d.z * d.z;
    const double qb = b - d.z * (0.5 * piece.c1 + piece.c2 * o.z);
    const double qc = c - (piece.c0 + o.z * (piece.c1 + piece.c2 * o.z));
    const double discriminant = qb * qb - qa * qc;
    if (discriminant < 0.0) continue;
    // The sum of two numbers of the same sign: no cancellation in either root.
    const double q = -(qb + std::copysign(std::sqrt(discriminant), qb));
    const double roots[2] = {q / qa, qc / q};
    for (const double t : roots) {
      const double z = o.z + t * d.z;
      // A division by zero above gives a t that is not finite and fails here.
      if (!(t >= range.t0 - kOverlap && t <= range.t1 + kOverlap)) continue;
      if (!(z >= piece.z0 - kOverlap && z <= piece.z1 + kOverlap)) continue;
      found(Crossing{t, {o.x + t * d.x, o.y + t * d.y, -(0.5 * piece.c1 + piece.c2 * z)}});
    }
  }
  for (const Ring& ring : rings_) {
    if (ring.z < low || ring.z > high || ring.outer_square < nearest_square) continue;
    const double t = (ring.z - o.z) / d.z;
    const double square = c + t * (2.0 * b + t * a);
    if (!(t >= range.t0 - kOverlap && t <= range.t1 + kOverlap)) continue;
    if (square < ring.inner_square - kOverlap || square > ring.outer_square + kOverlap) continue;
    found(Crossing{t, {0.0, 0.0, ring.up}});
  }
}

}  // namespace scenes::chess
