// SPDX-License-Identifier: MIT
/// \file
/// The 32 pieces on their squares.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "../vec3.h"
#include "piece_shape.h"

namespace scenes::chess {

/// All pieces of a position, on an 8 x 8 board in the plane z = 0 whose squares have side 1 and
/// whose middle is the origin. White starts at negative y, the a file is at negative x.
///
/// Every piece stays within its square, so that the board is its own acceleration structure: a ray
/// visits the squares in its order and is done at the first piece that it meets.
class ChessSet {
 public:
  struct PieceHit {
    Hit hit;
    bool is_light;
  };

  /// `placement` is the first field of a position in Forsyth-Edwards notation.
  explicit ChessSet(std::string_view placement);

  /// The nearest crossing with any piece within [t0, t1].
  [[nodiscard]] std::optional<PieceHit> intersect(const Ray& ray, double t0, double t1) const;

  /// How much of the sky the pieces leave to the point (x, y) of the board: 1 far from all of them,
  /// less where one rises close by. A smooth guess, good enough to seat the pieces.
  [[nodiscard]] double openness(double x, double y) const;

 private:
  struct Piece {
    Vec3 center;
    double cos;  // of the angle by which the shape is turned about the vertical
    double sin;
    PieceKind kind;
    bool is_light;
  };

  void place(char letter, int column, int row);
  [[nodiscard]] std::optional<Hit> intersect(const Piece& piece, const Ray& ray, double t0,
                                             double t1) const;

  std::vector<PieceShape> shapes_;  // by kind
  std::array<std::optional<Piece>, 64> squares_;
  double height_ = 0.0;
};

}  // namespace scenes::chess
