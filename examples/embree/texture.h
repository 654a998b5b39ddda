// SPDX-License-Identifier: MIT
/// \file
/// Pictures on surfaces, in all resolutions.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "scenes/vec3.h"

namespace embree_host {

using scenes::Vec3;

/// A picture that repeats in both directions: a pyramid of ever coarser means, so that a look-up
/// over a wide footprint costs as much as one over a small footprint (Williams 1983).
class Texture {
 public:
  /// Colours are colour(u, v) in the middle of each texel. \param side  texels, a power of two
  Texture(std::size_t side, const std::function<Vec3(double u, double v)>& colour);
  /// Of linear colours, row by row from v = 0 on; at least one texel.
  Texture(std::size_t width, std::size_t height, const std::vector<Vec3>& texels);

  /// The mean colour about a place; trilinear between texels and between resolutions.
  /// \param width  of the footprint, in units of u and v, >= 0
  [[nodiscard]] Vec3 colour(double u, double v, double width) const;

 private:
  struct Level {
    std::size_t width = 0, height = 0;
    std::vector<std::array<float, 3>> texels;  // floats: twice as many fit in a cache
    [[nodiscard]] Vec3 texel(std::size_t x, std::size_t y) const;
    [[nodiscard]] Vec3 colour(double u, double v) const;
  };

  void add_coarser();

  std::vector<Level> levels_;  // the finest first
};

/// A texture from a file of any format that OpenImageIO reads; what is display-encoded is decoded.
/// \throws std::runtime_error naming the file and the reason.
[[nodiscard]] Texture read_texture(const std::string& file);

}  // namespace embree_host
