// SPDX-License-Identifier: MIT
/// \file
/// What is to be rendered: triangles, their materials and their textures. z is up.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "texture.h"

namespace embree_host {

/// What a surface is made of. All surfaces are diffuse.
struct Material {
  Vec3 colour{0.7, 0.7, 0.7};          ///< share of the light that is scattered, in 0..1
  std::optional<std::size_t> texture;  ///< its colours are multiplied by `colour`
};

/// The corner of triangles.
struct Vertex {
  std::array<float, 3> point{};   ///< as Embree gets it
  std::array<float, 3> normal{};  ///< of unit length; zero: that of the triangle
  std::array<float, 2> uv{};
};

/// A triangle; counter-clockwise as seen from outside.
struct Triangle {
  std::array<std::uint32_t, 3> corners{};
};

/// Where a camera is to stand.
struct View {
  Vec3 eye{0, -1, 0};
  Vec3 target{0, 0, 0};
  double half_field = 0.5;  ///< tangent of half the field of view of the lesser side
};

/// Triangles with materials.
struct Model {
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> material_of;  ///< one for each triangle
  std::vector<Material> materials;
  std::vector<Texture> textures;

  /// A curved surface point(s, t), s and t in [0, 1], as across x up pieces of two triangles each.
  /// Its outside is where cross(d/ds, d/dt) points to; normals are smooth, also across seams where
  /// the surface closes.
  /// \param uv  what a surface's s and t of 1 are in u and v
  void add_surface(std::size_t across, std::size_t up, std::array<double, 2> uv,
                   std::uint32_t material, const std::function<Vec3(double s, double t)>& point);
  /// A box of six faces; a unit of u and v is `scale` long.
  void add_box(const Vec3& least, const Vec3& most, double scale, std::uint32_t material);
  /// A flat piece with corner + s across + t up, of two triangles.
  void add_rectangle(const Vec3& corner, const Vec3& across, const Vec3& up, double scale,
                     std::uint32_t material);
};

/// A colonnade with a knot in it, of about 100,000 triangles, and the place to look from.
[[nodiscard]] Model make_colonnade(View& view);

/// Reads a Wavefront OBJ file with its materials: Kd, map_Kd. y is up in such files.
/// \param view  is set so that all of it is seen
/// \throws std::runtime_error naming the file and the reason, also when the program was built
///         without tinyobjloader.
[[nodiscard]] Model read_obj(const std::string& file, View& view);

}  // namespace embree_host
