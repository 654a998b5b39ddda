// SPDX-License-Identifier: MIT
/// \file
/// Where the mouse points as a map of importance.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace live {

/// A rectangle, in pixels: left <= x < right, top <= y < bottom.
struct Frame {
  double left = 0, top = 0, right = 0, bottom = 0;
};

/// A position, in pixels.
struct Point {
  double x = 0, y = 0;
};

/// What deserves more than the rest.
struct Attention {
  std::optional<Frame> frame;
  std::optional<Point> pointer;
};

/// How many times the weight of others.
inline constexpr float attended_weight = 10;
/// How far from the pointer the centres of blocks are that count, in pixels.
inline constexpr double pointer_radius = 32;

/// The importance of blocks, row by row: `attended_weight` where a block has a pixel in the frame,
/// or is near the pointer; otherwise 1.
[[nodiscard]] std::vector<float> importance_of(const Attention& attention, std::size_t width,
                                               std::size_t height);

}  // namespace live
