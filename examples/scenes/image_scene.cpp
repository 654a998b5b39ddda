// SPDX-License-Identifier: MIT
#include "image_scene.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace scenes {
namespace {

float srgb_to_linear(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

bool is_encoded(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space == "sRGB") return true;
  const bool linear = OIIO::Strutil::iequals(space, "linear") || space == "scene_linear";
  return !spec.format.is_floating_point() && !linear;
}

[[noreturn]] void fail(const std::string& file, const OIIO::ImageBuf& picture) {
  throw std::runtime_error("cannot read picture '" + file + "': " + picture.geterror());
}

}  // namespace

ImageScene::ImageScene(const std::string& file, int width, int height) {
  // A device may have no end.
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::runtime_error("cannot read picture '" + file + "': not a regular file");
  }
  // Without this hint the colours would be multiplied by the alpha that is to be ignored.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::ImageBuf stored(file, 0, 0, nullptr, &hints);
  if (!stored.read(0, 0, /*force=*/true, OIIO::TypeDesc::FLOAT)) fail(file, stored);
  const bool encoded = is_encoded(stored.nativespec());

  const OIIO::ImageBuf picture = OIIO::ImageBufAlgo::reorient(stored);
  const OIIO::ROI roi = picture.roi();
  const auto channels = static_cast<std::size_t>(roi.nchannels());
  std::vector<float> values(roi.npixels() * channels);
  if (values.empty() || !picture.get_pixels(roi, OIIO::TypeDesc::FLOAT, values.data())) {
    fail(file, picture);
  }
  columns_ = roi.width();
  rows_ = roi.height();
  columns_per_pixel_ = static_cast<double>(columns_) / width;
  rows_per_pixel_ = static_cast<double>(rows_) / height;

  const std::size_t colors = channels >= 3 ? 3 : 1;
  pixels_.reserve(roi.npixels() * 3);
  for (std::size_t first = 0; first < values.size(); first += channels) {
    for (std::size_t color = 0; color < 3; ++color) {
      const float value = values[first + std::min(color, colors - 1)];
      const float usable = std::isfinite(value) && value > 0.0F ? value : 0.0F;
      pixels_.push_back(encoded ? srgb_to_linear(usable) : usable);
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
