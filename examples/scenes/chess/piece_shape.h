// SPDX-License-Identifier: MIT
/// \file
/// The six kinds of chess pieces.
#pragma once

#include <optional>
#include <vector>

#include "../solids.h"
#include "../vec3.h"
#include "profile.h"

namespace scenes::chess {

enum class PieceKind { kPawn, kKnight, kBishop, kRook, kQueen, kKing };

/// The shape of one kind of piece, standing upright on the origin. Shared by all pieces of the
/// kind.
class PieceShape {
 public:
  /// Every shape stays within this distance of its axis.
  static constexpr double kMaxRadius = 0.38;

  explicit PieceShape(PieceKind kind);

  [[nodiscard]] double height() const { return bounds_.z1; }
  /// The radius of the foot, the widest part that was turned.
  [[nodiscard]] double base_radius() const { return base_radius_; }

  /// The nearest crossing of the ray with the shape's surface within [t0, t1].
  [[nodiscard]] std::optional<Hit> intersect(const Ray& ray, double t0, double t1) const;

 private:
  [[nodiscard]] bool is_removed(const Vec3& p, const Solid* except) const;

  Profile profile_;
  std::vector<Solid> added_;    // crowns and crosses
  std::vector<Solid> removed_;  // cut out of the profile: slots, wells
  bool has_horse_head_;
  double base_radius_;
  Cylinder bounds_;
};

}  // namespace scenes::chess
