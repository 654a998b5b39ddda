// SPDX-License-Identifier: MIT
#include "model.h"

#include <cmath>

namespace embree_host {
namespace {

std::array<float, 3> as_floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// The direction across a grid of points at a node, over the ends where the grid closes.
template <class Point>
Vec3 slope_of(std::size_t index, std::size_t count, const Point& point) {
  const bool closes = length(point(count) - point(0)) < 1e-9;
  const std::size_t before = index > 0 ? index - 1 : closes ? count - 1 : 0;
  const std::size_t after = index < count ? index + 1 : closes ? 1 : count;
  return point(after) - point(before);
}

}  // namespace

void Model::add_surface(std::size_t across, std::size_t up, std::array<double, 2> uv,
                        std::uint32_t material, const std::function<Vec3(double, double)>& point) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const auto rough = [&](std::size_t i, std::size_t j) {
    return point(static_cast<double>(i) / static_cast<double>(across),
                 static_cast<double>(j) / static_cast<double>(up));
  };
  // Where the surface closes, and at poles, points are the same to the bit: there is no gap.
  const auto at = [&](std::size_t i, std::size_t j) {
    if (length(rough(0, j) - rough(i, j)) < 1e-9) i = 0;
    if (length(rough(i, 0) - rough(i, j)) < 1e-9) j = 0;
    return rough(i, j);
  };
  for (std::size_t j = 0; j <= up; ++j) {
    for (std::size_t i = 0; i <= across; ++i) {
      const Vec3 normal = cross(slope_of(i, across, [&](std::size_t k) { return at(k, j); }),
                                slope_of(j, up, [&](std::size_t k) { return at(i, k); }));
      const double s = static_cast<double>(i) / static_cast<double>(across);
      const double t = static_cast<double>(j) / static_cast<double>(up);
      vertices.push_back({as_floats(at(i, j)),
                          as_floats(normalize(normal)),
                          {static_cast<float>(uv[0] * s), static_cast<float>(uv[1] * t)}});
    }
  }
  const auto row = static_cast<std::uint32_t>(across + 1);
  for (std::uint32_t j = 0; j < up; ++j) {
    for (std::uint32_t i = 0; i < across; ++i) {
      const std::uint32_t corner = first + j * row + i;
      triangles.push_back({{corner, corner + 1, corner + row + 1}});
      triangles.push_back({{corner, corner + row + 1, corner + row}});
    }
  }
  material_of.resize(triangles.size(), material);
}

void Model::add_rectangle(const Vec3& corner, const Vec3& across, const Vec3& up, double scale,
                          std::uint32_t material) {
  add_surface(1, 1, {length(across) / scale, length(up) / scale}, material,
              [&](double s, double t) { return corner + s * across + t * up; });
}

void Model::add_box(const Vec3& least, const Vec3& most, double scale, std::uint32_t material) {
  const Vec3 size = most - least;
  const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  add_rectangle(least, x, z, scale, material);           // front
  add_rectangle(least + x, y, z, scale, material);       // right
  add_rectangle(least + x + y, -x, z, scale, material);  // back
  add_rectangle(least + y, -y, z, scale, material);      // left
  add_rectangle(least + z, x, y, scale, material);       // top
  add_rectangle(least + y, x, -y, scale, material);      // bottom
}

}  // namespace embree_host
