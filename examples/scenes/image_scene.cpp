// SPDX-License-Identifier: MIT
#include "image_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "picture_file.h"

namespace scenes {
namespace {

float srgb_to_linear(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

}  // namespace

ImageScene::ImageScene(const std::string& file, int width, int height) {
  const PictureFile picture = read_picture_file(file);
  columns_ = static_cast<int>(picture.width);
  rows_ = static_cast<int>(picture.height);
  columns_per_pixel_ = static_cast<double>(columns_) / width;
  rows_per_pixel_ = static_cast<double>(rows_) / height;

  pixels_.reserve(picture.width * picture.height * 3);
  for (std::size_t first = 0; first < picture.size(); first += picture.channels) {
    for (std::size_t color = 0; color < 3; ++color) {
      const float value = picture.values[first + std::min(color, picture.channels - 1)];
      const float usable = std::isfinite(value) && value > 0.0F ? value : 0.0F;
      pixels_.push_back(picture.encoded ? srgb_to_linear(usable) : usable);
    }
  }
}

const float* ImageScene::pixel(int column, int row) const {
  const int inside_column = std::clamp(column, 0, columns_ - 1);
  const int inside_row = std::clamp(row, 0, rows_ - 1);
  return &pixels_[3 * (static_cast<std::size_t>(inside_row) * static_cast<std::size_t>(columns_) +
                       static_cast<std::size_t>(inside_column))];
}

void ImageScene::radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const {
  const double column = x * columns_per_pixel_ - 0.5;
  const double row = y * rows_per_pixel_ - 0.5;
  const double left = std::floor(column);
  const double top = std::floor(row);
  const auto s = static_cast<float>(column - left);
  const auto t = static_cast<float>(row - top);
  const int i = static_cast<int>(left);
  const int j = static_cast<int>(top);
  const float* a = pixel(i, j);
  const float* b = pixel(i + 1, j);
  const float* c = pixel(i, j + 1);
  const float* d = pixel(i + 1, j + 1);
  for (std::size_t k = 0; k < 3; ++k) {
    rgb[k] = (1.0F - t) * ((1.0F - s) * a[k] + s * b[k]) + t * ((1.0F - s) * c[k] + s * d[k]);
  }
}

}  // namespace scenes
