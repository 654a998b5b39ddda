// SPDX-License-Identifier: MIT
#include "texture.h"

#include <OpenImageIO/color.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/picture_file.h"

namespace embree_host {
namespace {

std::array<float, 3> stored(const Vec3& colour) {
  return {static_cast<float>(colour.x), static_cast<float>(colour.y), static_cast<float>(colour.z)};
}

}  // namespace

Texture::Texture(std::size_t side, const std::function<Vec3(double, double)>& colour) {
  Level level{side, side, {}};
  const auto texels = static_cast<double>(side);
  for (std::size_t i = 0; i < side * side; ++i) {
    level.texels.push_back(stored(colour((static_cast<double>(i % side) + 0.5) / texels,
                                         (static_cast<double>(i / side) + 0.5) / texels)));
  }
  levels_.push_back(std::move(level));
  add_coarser();
}

Texture::Texture(std::size_t width, std::size_t height, const std::vector<Vec3>& texels) {
  levels_.push_back({width, height, {}});
  for (const Vec3& texel : texels) levels_.back().texels.push_back(stored(texel));
  add_coarser();
}

void Texture::add_coarser() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{
        std::max<std::size_t>(fine.width / 2, 1), std::max<std::size_t>(fine.height / 2, 1), {}};
    // Each texel is the mean of those it covers: two by two, or three where the number is odd.
    for (std::size_t y = 0; y < coarse.height; ++y) {
      const std::size_t top = y * fine.height / coarse.height;
      const std::size_t bottom = (y + 1) * fine.height / coarse.height;
      for (std::size_t x = 0; x < coarse.width; ++x) {
        const std::size_t left = x * fine.width / coarse.width;
        const std::size_t right = (x + 1) * fine.width / coarse.width;
        Vec3 sum;
        for (std::size_t j = top; j < bottom; ++j) {
          for (std::size_t i = left; i < right; ++i) sum = sum + fine.texel(i, j);
        }
        coarse.texels.push_back(
            stored(1 / static_cast<double>((right - left) * (bottom - top)) * sum));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Vec3 Texture::Level::texel(std::size_t x, std::size_t y) const {
  const auto& [red, green, blue] = texels[y * width + x];
  return {double{red}, double{green}, double{blue}};
}

Vec3 Texture::Level::colour(double u, double v) const {
  const auto place = [](double t, std::size_t size) {
    const double texel = (t - std::floor(t)) * static_cast<double>(size) - 0.5;
    const double below = std::floor(texel);
    const auto first = static_cast<std::size_t>(below + static_cast<double>(size)) % size;
    return std::pair{first, texel - below};
  };
  const auto [left, x] = place(u, width);
  const auto [top, y] = place(v, height);
  const std::size_t right = (left + 1) % width, bottom = (top + 1) % height;
  return mix(mix(texel(left, top), texel(right, top), x),
             mix(texel(left, bottom), texel(right, bottom), x), y);
}

Vec3 Texture::colour(double u, double v, double width) const {
  const auto finest = static_cast<double>(std::max(levels_[0].width, levels_[0].height));
  const double level = std::log2(std::max(width * finest, 1.0));
  const auto last = static_cast<double>(levels_.size() - 1);
  if (!(level < last)) return levels_.back().texel(0, 0);
  const double below = std::floor(level);
  const auto index = static_cast<std::size_t>(below);
  return mix(levels_[index].colour(u, v), levels_[index + 1].colour(u, v), level - below);
}

Texture read_texture(const std::string& file) {
  const scenes::PictureFile picture = scenes::read_picture_file(file);
  std::vector<Vec3> texels(picture.width * picture.height);
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      const float* values = picture.values.get() + (y * picture.width + x) * picture.channels;
      const auto value = [&](std::size_t c) {
        const float stored = values[picture.channels == 3 ? c : 0];
        return static_cast<double>(picture.encoded ? OIIO::sRGB_to_linear(stored) : stored);
      };
      // Files begin at the top, where v is 1.
      texels[(picture.height - 1 - y) * picture.width + x] = {value(0), value(1), value(2)};
    }
  }
  return {picture.width, picture.height, texels};
}

}  // namespace embree_host
