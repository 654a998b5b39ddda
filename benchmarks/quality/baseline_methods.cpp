#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "methods.h"

namespace quality::detail {
namespace {

/// Samples in jittered cells of equal area, as many as allowed, each for the pixel that it lies in;
/// pixels without one take the value of the nearest cell.
baselines::Rendering jittered_box(const baselines::Radiance& radiance, const baselines::Job& job) {
  const double area = static_cast<double>(job.width * job.height);
  const double cell = std::sqrt(area / static_cast<double>(job.samples));
  const auto across = static_cast<std::size_t>(
      std::max(1.0, std::floor(static_cast<double>(job.width) / cell + 1e-9)));
  const std::size_t down = std::max<std::size_t>(1, static_cast<std::size_t>(job.samples) / across);
  std::mt19937_64 random(job.seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };

  baselines::Rendering result{job.width, job.height, {}, {}};
  result.pixels.resize(3 * job.width * job.height);
  result.samples.resize(job.width * job.height);
  std::vector<float> cells(3 * across * down);
  for (std::size_t i = 0; i < across * down; ++i) {
    const double x = (static_cast<double>(i % across) + uniform()) *
                     static_cast<double>(job.width) / static_cast<double>(across);
    const double y = (static_cast<double>(i / across) + uniform()) *
                     static_cast<double>(job.height) / static_cast<double>(down);
    const std::span<float, 3> rgb = std::span(cells).subspan(3 * i).first<3>();
    radiance(x, y, i, rgb);
    const std::size_t pixel = static_cast<std::size_t>(y) * job.width + static_cast<std::size_t>(x);
    ++result.samples[pixel];
    for (std::size_t c = 0; c < 3; ++c) result.pixels[3 * pixel + c] += rgb[c];
  }
  for (std::size_t pixel = 0; pixel < job.width * job.height; ++pixel) {
    const std::size_t column = (2 * (pixel % job.width) + 1) * across / (2 * job.width);
    const std::size_t row = (2 * (pixel / job.width) + 1) * down / (2 * job.height);
    for (std::size_t c = 0; c < 3; ++c) {
      float& value = result.pixels[3 * pixel + c];
      if (result.samples[pixel] != 0) {
        value /= static_cast<float>(result.samples[pixel]);
      } else {
        value = cells[3 * (row * across + column) + c];
      }
    }
  }
  return result;
}

}  // namespace

void add_baselines(std::vector<Method>& methods) {
  methods.push_back(
      {"jittered-box", "one jittered sample per cell, box filter", "", jittered_box, 0});
}

}  // namespace quality::detail
