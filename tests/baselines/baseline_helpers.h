// SPDX-License-Identifier: MIT
/// \file
/// Radiance functions and measures for the tests of the baselines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "baselines/sampler.h"

namespace baselines {

/// A grey radiance given by a function of (x, y).
template <class Function>
Radiance grey(Function function) {
  return [function](double x, double y, std::uint64_t, std::span<float, 3> rgb) {
    std::fill(rgb.begin(), rgb.end(), static_cast<float>(function(x, y)));
  };
}

inline Radiance constant(float red, float green, float blue) {
  return [=](double, double, std::uint64_t, std::span<float, 3> rgb) {
    rgb[0] = red;
    rgb[1] = green;
    rgb[2] = blue;
  };
}

/// A job at a number of samples per pixel, rounded down, but at least one sample.
inline Job job_at(std::size_t width, std::size_t height, double rate, std::uint64_t seed = 1) {
  const double samples = rate * static_cast<double>(width * height);
  return {width, height, std::max(static_cast<std::uint64_t>(samples), std::uint64_t{1}), seed};
}

inline std::uint64_t total_samples(const Rendering& rendering) {
  return std::accumulate(rendering.samples.begin(), rendering.samples.end(), std::uint64_t{0});
}

/// Sum of component `c` over all pixels.
inline double energy(const Rendering& rendering, std::size_t c = 0) {
  double sum = 0;
  for (std::size_t i = c; i < rendering.pixels.size(); i += 3) {
    sum += static_cast<double>(rendering.pixels[i]);
  }
  return sum;
}

/// Means over pixels of a function, by the midpoint rule with 64 x 64 points.
template <class Function>
std::vector<double> pixel_means(std::size_t width, std::size_t height, Function function) {
  constexpr int points = 64;
  std::vector<double> means;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      double sum = 0;
      for (int j = 0; j < points; ++j) {
        for (int i = 0; i < points; ++i) {
          sum += function(static_cast<double>(x) + (i + 0.5) / points,
                          static_cast<double>(y) + (j + 0.5) / points);
        }
      }
      means.push_back(sum / (points * points));
    }
  }
  return means;
}

/// Root of the mean squared difference of the red component from `expected`.
inline double rms_error(const Rendering& rendering, std::span<const double> expected) {
  double sum = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double difference = static_cast<double>(rendering.pixels[i * 3]) - expected[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(expected.size()));
}

/// A slanted edge: 1 on one side, 0 on the other.
inline double slanted_edge(double x, double y) { return x + 0.3 * y < 18.7 ? 1.0 : 0.0; }

/// A picture of one grey value.
inline Rendering grey_picture(std::size_t width, std::size_t height, float value) {
  return {width, height, std::vector<float>(width * height * 3, value),
          std::vector<std::uint32_t>(width * height, 1)};
}

}  // namespace baselines
