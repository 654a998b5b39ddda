// SPDX-License-Identifier: MIT
#include "dots.h"

#include <algorithm>

#include "area.h"
#include "random.h"

namespace scenes {
namespace {

constexpr int kMostAcross = 7;
// Dots stay out of the outer quarters of their cells, so that cells of this size keep any pixel
// that reaches into two of them clear of dots.
constexpr int kLeastCell = 8;

int cells_along(int size) { return std::clamp(size / kLeastCell, 1, kMostAcross); }

}  // namespace

Dots::Dots(int width, int height)
    : columns_(cells_along(width)),
      rows_(cells_along(height)),
      cell_width_(static_cast<double>(width) / columns_),
      cell_height_(static_cast<double>(height) / rows_) {}

Dots::Position Dots::dot_near(double x, double y) const {
  const int column = std::clamp(static_cast<int>(x / cell_width_), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(y / cell_height_), 0, rows_ - 1);
  Random random(/*seed=*/7, static_cast<std::uint64_t>(row * kMostAcross + column));
  const double s = 0.25 + 0.5 * random.uniform();
  const double t = 0.25 + 0.5 * random.uniform();
  return {(column + s) * cell_width_, (row + t) * cell_height_};
}

void Dots::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const Position dot = dot_near(x, y);
  const double dx = x - dot.x;
  const double dy = y - dot.y;
  const bool inside = dx * dx + dy * dy < kRadius * kRadius;
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(inside ? kBrightness : kBackground));
}

bool Dots::pixel_average(long i, long j, std::span<float, 3> rgb) const {
  const double x = static_cast<double>(i);
  const double y = static_cast<double>(j);
  const Position dot = dot_near(x + 0.5, y + 0.5);
  const double share = disc_area(x - dot.x, y - dot.y, kRadius);
  const double value = kBackground + share * (kBrightness - kBackground);
  std::fill(rgb.begin(), rgb.end(), static_cast<float>(value));
  return true;
}

}  // namespace scenes
