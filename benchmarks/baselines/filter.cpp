// SPDX-License-Identifier: MIT
#include "filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace baselines {
namespace {

double mitchell_netravali(double x) {
  constexpr double b = 1.0 / 3;
  constexpr double c = 1.0 / 3;
  if (x < 1) {
    return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + 6 - 2 * b) / 6;
  }
  return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b +
          24 * c) /
         6;
}

/// exp(-x^2 / (2 deviation^2)) with a deviation of half a pixel.
double bell(double x) { return std::exp(-2 * x * x); }

}  // namespace

double radius(PixelFilter filter) {
  switch (filter) {
    case PixelFilter::box:
      return 0.5;
    case PixelFilter::tent:
      return 1;
    case PixelFilter::gaussian:
      return 1.5;
    case PixelFilter::mitchell_netravali:
      return 2;
  }
  return 0;
}

double weight(PixelFilter filter, double distance) {
  const double x = std::abs(distance);
  if (x > radius(filter)) return 0;
  switch (filter) {
    case PixelFilter::box:
      return 1;
    case PixelFilter::tent:
      return 1 - x;
    case PixelFilter::gaussian: {
      static const double at_end = bell(radius(PixelFilter::gaussian));
      return bell(x) - at_end;
    }
    case PixelFilter::mitchell_netravali:
      return mitchell_netravali(x);
  }
  return 0;
}

SampleGrid::SampleGrid(std::span<const Sample> samples, std::size_t width, std::size_t height)
    : width_(width), height_(height), starts_(width * height + 1, 0), sorted_(samples.size()) {
  for (const Sample& sample : samples) ++starts_[pixel_at(sample.x, sample.y, width, height) + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
  for (const Sample& sample : samples) {
    sorted_[next[pixel_at(sample.x, sample.y, width, height)]++] = sample;
  }
}

SampleGrid::Range SampleGrid::range(double low, double high, std::size_t size) {
  const double last = static_cast<double>(size - 1);
  return {static_cast<std::size_t>(std::clamp(std::floor(low), 0.0, last)),
          static_cast<std::size_t>(std::clamp(std::floor(high), 0.0, last))};
}

Gathered gather(const SampleGrid& grid, PixelFilter filter, double width, double x, double y) {
  const double reach = radius(filter) * width;
  const double scale = 1 / width;
  Gathered gathered;
  grid.for_each_near({x - reach, y - reach, x + reach, y + reach}, [&](const Sample& sample) {
    const double w =
        weight(filter, (sample.x - x) * scale) * weight(filter, (sample.y - y) * scale);
    if (w == 0) return;
    gathered.weight += w;
    gathered.absolute_weight += std::abs(w);
    gathered.squared_weight += w * w;
    ++gathered.count;
    for (std::size_t c = 0; c < 3; ++c) {
      gathered.sum[c] += w * static_cast<double>(sample.rgb[c]);
    }
  });
  return gathered;
}

double width_for_rate(double rate) { return rate < 1 ? 1 / std::sqrt(rate) : 1; }

void weighted_average(std::span<const Sample> samples, PixelFilter filter,
                      std::span<const float> widths, Rendering& rendering) {
  const SampleGrid grid(samples, rendering.width, rendering.height);
  for (std::size_t row = 0; row < rendering.height; ++row) {
    for (std::size_t column = 0; column < rendering.width; ++column) {
      const std::size_t pixel = row * rendering.width + column;
      const double x = static_cast<double>(column) + 0.5;
      const double y = static_cast<double>(row) + 0.5;
      double width = static_cast<double>(widths[widths.size() == 1 ? 0 : pixel]);
      Gathered gathered = gather(grid, filter, width, x, y);
      while (!gathered.usable()) {
        width *= std::numbers::sqrt2;
        gathered = gather(grid, filter, width, x, y);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        rendering.pixels[pixel * 3 + c] = static_cast<float>(gathered.sum[c] / gathered.weight);
      }
    }
  }
}

}  // namespace baselines
