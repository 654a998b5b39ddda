// SPDX-License-Identifier: MIT
#include "chess_set.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace scenes::chess {
namespace {

constexpr int kSide = 8;
constexpr double kHalf = 0.5 * kSide;

// From the units of PieceShape to squares.
constexpr double kScale = 1.14;
static_assert(kScale * PieceShape::kMaxRadius <= 0.5, "a piece must not leave its square");

std::size_t square_index(int column, int row) {
  return static_cast<std::size_t>(row * kSide + column);
}

PieceKind kind_of(char lower_case_letter) {
  switch (lower_case_letter) {
    case 'n':
      return PieceKind::kKnight;
    case 'b':
      return PieceKind::kBishop;
    case 'r':
      return PieceKind::kRook;
    case 'q':
      return PieceKind::kQueen;
    case 'k':
      return PieceKind::kKing;
    default:
      return PieceKind::kPawn;
  }
}

// In degrees, from x towards y. Chosen for the look: knights show their profile, crosses their
// face.
double heading(PieceKind kind, bool is_light) {
  switch (kind) {
    case PieceKind::kKnight:
      return is_light ? -38.0 : -150.0;
    case PieceKind::kBishop:
      return is_light ? -15.0 : 165.0;
    case PieceKind::kKing:
      return 20.0;
    default:
      return 0.0;
  }
}

}  // namespace

ChessSet::ChessSet(std::string_view placement) {
  for (const PieceKind kind : {PieceKind::kPawn, PieceKind::kKnight, PieceKind::kBishop,
                               PieceKind::kRook, PieceKind::kQueen, PieceKind::kKing}) {
    shapes_.emplace_back(kind);
    height_ = std::max(height_, kScale * shapes_.back().height());
  }
  int column = 0;
  int row = kSide - 1;
  for (const char letter : placement) {
    if (letter == '/') {
      column = 0;
      --row;
    } else if (letter >= '1' && letter <= '8') {
      column += letter - '0';
    } else {
      place(letter, column++, row);
    }
  }
}

void ChessSet::place(char letter, int column, int row) {
  assert(column >= 0 && column < kSide && row >= 0 && row < kSide);
  const bool is_light = std::isupper(static_cast<unsigned char>(letter)) != 0;
  const auto lower = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  const PieceKind kind = kind_of(lower);
  const double angle = heading(kind, is_light) * (std::numbers::pi / 180.0);
  squares_[square_index(column, row)] = Piece{{column + 0.5 - kHalf, row + 0.5 - kHalf, 0.0},
                                              std::cos(angle),
                                              std::sin(angle),
                                              kind,
                                              is_light};
}

std::optional<Hit> ChessSet::intersect(const Piece& piece, const Ray& ray, double t0,
                                       double t1) const {
  const auto turn = [](const Vec3& v, double cos, double sin) {
    return Vec3{cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z};
  };
  // Only the origin is scaled and not the direction, so that distances are, too.
  const Ray local{turn((1.0 / kScale) * (ray.origin - piece.center), piece.cos, -piece.sin),
                  turn(ray.direction, piece.cos, -piece.sin)};
  const PieceShape& shape = shapes_[static_cast<std::size_t>(piece.kind)];
  const auto hit = shape.intersect(local, t0 / kScale, t1 / kScale);
  if (!hit) return std::nullopt;
  return Hit{kScale * hit->t, turn(hit->normal, piece.cos, piece.sin)};
}

std::optional<ChessSet::PieceHit> ChessSet::intersect(const Ray& ray, double t0, double t1) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Vec3& o = ray.origin;
  const Vec3& d = ray.direction;

  // The stretch of the ray over the board, between its surface and the tallest piece's top.
  const auto cut = [&](double position, double direction, double low, double high) {
    if (direction == 0.0) {
      if (position < low || position > high) t1 = -kNever;
      return;
    }
    const double ta = (low - position) / direction;
    const double tb = (high - position) / direction;
    t0 = std::max(t0, std::min(ta, tb));
    t1 = std::min(t1, std::max(ta, tb));
  };
  cut(o.z, d.z, 0.0, height_);
  cut(o.x, d.x, -kHalf, kHalf);
  cut(o.y, d.y, -kHalf, kHalf);
  if (t0 >= t1) return std::nullopt;

  // A walk from square to square: the next border in x is reached at next_x, the one in y at
  // next_y.
  const auto cell_of = [&](double position) {
    return std::clamp(static_cast<int>(std::floor(position + kHalf)), 0, kSide - 1);
  };
  const auto border_after = [&](int cell, double position, double direction) {
    if (direction == 0.0) return kNever;
    return (cell + (direction > 0.0 ? 1.0 : 0.0) - kHalf - position) / direction;
  };
  const Vec3 entry = ray.at(t0);
  int column = cell_of(entry.x);
  int row = cell_of(entry.y);
  double next_x = border_after(column, o.x, d.x);
  double next_y = border_after(row, o.y, d.y);
  const double step_x = d.x == 0.0 ? kNever : std::abs(1.0 / d.x);
  const double step_y = d.y == 0.0 ? kNever : std::abs(1.0 / d.y);

  while (column >= 0 && column < kSide && row >= 0 && row < kSide) {
    if (const auto& piece = squares_[square_index(column, row)]) {
      if (const auto hit = intersect(*piece, ray, t0, t1)) return PieceHit{*hit, piece->is_light};
    }
    if (std::min(next_x, next_y) > t1) break;
    if (next_x < next_y) {
      next_x += step_x;
      column += d.x > 0.0 ? 1 : -1;
    } else {
      next_y += step_y;
      row += d.y > 0.0 ? 1 : -1;
    }
  }
  return std::nullopt;
}

double ChessSet::openness(double x, double y) const {
  constexpr double kReach = 0.55;  // beyond the foot; foot and reach must stay within one square
  const int column = static_cast<int>(std::floor(x + kHalf));
  const int row = static_cast<int>(std::floor(y + kHalf));
  double open = 1.0;
  for (int j = std::max(row - 1, 0); j <= std::min(row + 1, kSide - 1); ++j) {
    for (int i = std::max(column - 1, 0); i <= std::min(column + 1, kSide - 1); ++i) {
      const auto& piece = squares_[square_index(i, j)];
      if (!piece) continue;
      const double distance = std::hypot(x - piece->center.x, y - piece->center.y);
      const double foot = kScale * shapes_[static_cast<std::size_t>(piece->kind)].base_radius();
      const double gap = std::clamp((distance - foot) / kReach, 0.0, 1.0);
      open *= 1.0 - 0.55 * (1.0 - gap) * (1.0 - gap) * (1.0 - gap);
    }
  }
  return open;
}

}  // namespace scenes::chess
