// SPDX-License-Identifier: MIT
/// \file
/// The `image:FILE` scene.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace scenes {

/// A picture from a file, stretched over the whole image and interpolated bilinearly between the
/// centres of its own pixels.
///
/// Pictures of integer type (8 or 16 bits) are taken as sRGB encoded and converted to linear
/// values, unless the file says that it is linear; pictures of floating point type are linear
/// already. One or two channels are gray (and alpha), three or more are red, green and blue; alpha
/// is ignored. Values that are negative or not finite are read as 0.
class ImageScene final : public Scene {
 public:
  /// Reads `file` whole. Throws std::runtime_error naming the file and the reason if it cannot.
  ImageScene(const std::string& file, int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;

 private:
  [[nodiscard]] const float* pixel(int column, int row) const;

  int columns_ = 0;
  int rows_ = 0;
  double columns_per_pixel_ = 0.0;
  double rows_per_pixel_ = 0.0;
  std::vector<float> pixels_;  // interleaved rgb, linear, row by row from the top
};

}  // namespace scenes
