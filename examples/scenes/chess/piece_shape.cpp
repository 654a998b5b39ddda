// SPDX-License-Identifier: MIT
#include "piece_shape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "horse_head.h"

namespace scenes::chess {
namespace {

// The foot that all pieces share but for its size: a plinth, a bulge, and a ring under the body.
Profile foot(double radius) {
  Profile profile(radius);
  profile.line(0.05, radius).step(0.96 * radius);
  profile.curve(0.99 * radius, 0.13, 0.90 * radius);
  profile.curve(0.83 * radius, 0.20, 0.66 * radius);
  profile.step(0.70 * radius).curve(0.73 * radius, 0.235, 0.70 * radius);
  return profile;
}

// A collar as wide as `radius` and `height` high, from which the profile goes on at radius `next`.
void collar(Profile& profile, double radius, double height, double next) {
  profile.step(0.93 * radius);
  profile.curve(radius, profile.height() + height, 0.93 * radius);
  profile.step(next);
}

Profile pawn() {
  Profile profile = foot(0.27);
  profile.step(0.175).curve(0.105, 0.50, 0.085);
  collar(profile, 0.155, 0.045, 0.085);
  profile.curve(0.08, 0.57, 0.085).ball(0.15);
  return profile;
}

Profile knight() {
  Profile profile = foot(0.31);
  profile.step(0.225).curve(0.21, 0.29, 0.16).step(0.0);
  return profile;
}

Profile bishop() {
  Profile profile = foot(0.30);
  profile.step(0.195).curve(0.112, 0.72, 0.095);
  collar(profile, 0.185, 0.045, 0.12);
  profile.curve(0.125, 0.80, 0.11);
  collar(profile, 0.15, 0.03, 0.095);
  profile.curve(0.155, 0.98, 0.155).curve(0.118, 1.15, 0.045);
  profile.step(0.03).curve(0.03, 1.165, 0.03).ball(0.045);
  return profile;
}

Profile rook() {
  Profile profile = foot(0.31);
  profile.step(0.23).curve(0.165, 0.68, 0.165);
  collar(profile, 0.215, 0.04, 0.18);
  profile.curve(0.195, 0.79, 0.235).line(0.98, 0.235).step(0.0);
  return profile;
}

Profile queen() {
  Profile profile = foot(0.34);
  profile.step(0.225).curve(0.125, 0.92, 0.105);
  collar(profile, 0.215, 0.045, 0.14);
  profile.curve(0.145, 1.01, 0.125);
  collar(profile, 0.17, 0.03, 0.11);
  profile.curve(0.135, 1.30, 0.215).step(0.185);
  profile.curve(0.14, 1.37, 0.05).ball(0.06);
  return profile;
}

Profile king() {
  Profile profile = foot(0.35);
  profile.step(0.235).curve(0.13, 1.00, 0.11);
  collar(profile, 0.225, 0.045, 0.15);
  profile.curve(0.155, 1.09, 0.13);
  collar(profile, 0.18, 0.03, 0.12);
  profile.curve(0.16, 1.38, 0.20).step(0.19);
  profile.curve(0.155, 1.46, 0.065).step(0.05).curve(0.042, 1.49, 0.05).step(0.0);
  return profile;
}

Profile profile_of(PieceKind kind) {
  switch (kind) {
    case PieceKind::kPawn:
      return pawn();
    case PieceKind::kKnight:
      return knight();
    case PieceKind::kBishop:
      return bishop();
    case PieceKind::kRook:
      return rook();
    case PieceKind::kQueen:
      return queen();
    case PieceKind::kKing:
      break;
  }
  return king();
}

std::vector<Solid> added_to(PieceKind kind) {
  std::vector<Solid> added;
  if (kind == PieceKind::kQueen) {
    constexpr int kPoints = 9;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kPoints;
      added.push_back(Ball{{0.195 * std::cos(angle), 0.195 * std::sin(angle), 1.315}, 0.042});
    }
  } else if (kind == PieceKind::kKing) {
    added.push_back(Box({0.0, 0.0, 1.59}, {0.03, 0.028, 0.12}));
    added.push_back(Box({0.0, 0.0, 1.61}, {0.088, 0.0275, 0.03}));
  }
  return added;
}

std::vector<Solid> removed_from(PieceKind kind) {
  std::vector<Solid> removed;
  if (kind == PieceKind::kRook) {
    removed.push_back(Cylinder{0.165, 0.88, 1.1});
    removed.push_back(Box({0.0, 0.0, 1.0}, {0.5, 0.045, 0.10}));
    removed.push_back(Box({0.0, 0.0, 1.0}, {0.045, 0.5, 0.10}));
  } else if (kind == PieceKind::kBishop) {
    removed.push_back(Box({0.13, 0.0, 1.10}, {0.018, 0.3, 0.12}, 0.6));
  }
  return removed;
}

// The farthest that anything of the piece gets from its axis: crowns are narrower than feet.
double reach_of(PieceKind kind, const Profile& profile) {
  return kind == PieceKind::kKnight ? std::max(kHorseHeadReach, profile.max_radius())
                                    : profile.max_radius();
}

double top_of(PieceKind kind, const Profile& profile) {
  if (kind == PieceKind::kKnight) return kHorseHeadTop;
  if (kind == PieceKind::kKing) return 1.72;
  return profile.height();
}

Passage pass(const Solid& solid, const Ray& ray) {
  return std::visit([&](const auto& s) { return s.pass(ray); }, solid);
}

bool contains(const Solid& solid, const Vec3& p) {
  return std::visit([&](const auto& s) { return s.contains(p); }, solid);
}

}  // namespace

PieceShape::PieceShape(PieceKind kind)
    : profile_(profile_of(kind)),
      added_(added_to(kind)),
      removed_(removed_from(kind)),
      has_horse_head_(kind == PieceKind::kKnight),
      base_radius_(profile_.max_radius()),
      bounds_{reach_of(kind, profile_) + 1e-3, -1e-3, top_of(kind, profile_) + 1e-3} {
  assert(bounds_.radius <= kMaxRadius);
}

bool PieceShape::is_removed(const Vec3& p, const Solid* except) const {
  for (const Solid& solid : removed_) {
    if (&solid != except && contains(solid, p)) return true;
  }
  return false;
}

std::optional<Hit> PieceShape::intersect(const Ray& ray, double t0, double t1) const {
  const Passage through = bounds_.pass(ray);
  const Interval range{std::max(t0, through.t0), std::min(t1, through.t1)};
  if (range.t0 >= range.t1) return std::nullopt;

  Hit nearest{t1, {}};
  const auto is_nearer = [&](double t) { return t >= t0 && t < nearest.t; };

  profile_.for_each_crossing(ray, range, [&](const Profile::Crossing& crossing) {
    if (is_nearer(crossing.t) && !is_removed(ray.at(crossing.t), nullptr)) {
      nearest = {crossing.t, crossing.normal};
    }
  });
  for (const Solid& solid : added_) {
    const Passage passage = pass(solid, ray);
    if (passage.t0 < passage.t1 && is_nearer(passage.t0)) nearest = {passage.t0, passage.normal0};
  }
  // Where the ray leaves a removed solid it enters what is left of the profile: a wall of the hole.
  for (const Solid& solid : removed_) {
    const Passage passage = pass(solid, ray);
    if (!(passage.t0 < passage.t1) || !is_nearer(passage.t1)) continue;
    const Vec3 p = ray.at(passage.t1);
    if (profile_.contains(p) && !is_removed(p, &solid)) nearest = {passage.t1, -passage.normal1};
  }
  if (has_horse_head_) {
    if (const auto hit = intersect_horse_head(ray, {range.t0, std::min(range.t1, nearest.t)})) {
      nearest = *hit;
    }
  }
  if (nearest.t >= t1) return std::nullopt;
  return nearest;
}

}  // namespace scenes::chess
