// SPDX-License-Identifier: MIT
#include "low_discrepancy.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "filter.h"
#include "freqsynth/basis/owen_sobol.h"
#include "sampler.h"

namespace baselines {
namespace {

/// Square of the shortest vector of the lattice that (width / count, height generator / count) and
/// (0, height) make, by Lagrange's reduction.
double shortest(std::uint64_t generator, std::uint64_t count, double width, double height) {
  const double n = static_cast<double>(count);
  UnitPoint a{width / n, height * (static_cast<double>(generator) / n)};
  UnitPoint b{0, height};
  const auto dot = [](const UnitPoint& p, const UnitPoint& q) { return p[0] * q[0] + p[1] * q[1]; };
  for (;;) {
    if (dot(a, a) > dot(b, b)) std::swap(a, b);
    const double times = std::round(dot(a, b) / dot(a, a));
    if (times == 0) return dot(a, a);
    const UnitPoint rest{b[0] - times * a[0], b[1] - times * a[1]};
    // Only rounding keeps it from becoming shorter.
    if (dot(rest, rest) >= dot(b, b)) return dot(a, a);
    b = rest;
  }
}

std::vector<UnitPoint> lattice(std::uint64_t count, std::uint64_t generator) {
  std::vector<UnitPoint> points;
  points.reserve(count);
  const double n = static_cast<double>(count);
  std::uint64_t row = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    points.push_back({(static_cast<double>(k) + 0.5) / n, (static_cast<double>(row) + 0.5) / n});
    row = row < count - generator ? row + generator : row - (count - generator);
  }
  return points;
}

/// Takes a sample at each of the points that points_in(x) gives for the pixels, or else for the
/// image, and averages them.
template <class PointsIn>
Rendering box_of(const Radiance& radiance, const Job& job, const PointsIn& points_in) {
  Sampler sampler(radiance, job);
  std::vector<Sample> samples;
  samples.reserve(job.samples);
  const std::uint64_t pixels = job.width * job.height;
  if (job.samples % pixels == 0) {
    for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
      for (const auto& [x, y] : points_in(pixel, job.samples / pixels, UnitPoint{1, 1})) {
        samples.push_back(sampler.take(static_cast<double>(pixel % job.width) + x,
                                       static_cast<double>(pixel / job.width) + y));
      }
    }
  } else {
    const UnitPoint size{static_cast<double>(job.width), static_cast<double>(job.height)};
    for (const auto& [x, y] : points_in(0, job.samples, size)) {
      samples.push_back(sampler.take(size[0] * x, size[1] * y));
    }
  }
  Rendering rendering = sampler.rendering();
  const float width = static_cast<float>(width_for_rate(rate(job)));
  weighted_average(samples, PixelFilter::box, {&width, 1}, rendering);
  return rendering;
}

}  // namespace

std::uint64_t lattice_generator(std::uint64_t count, double width, double height) {
  std::uint64_t best = 1;
  double best_distance = 0;
  for (std::uint64_t generator = 1; generator < std::max<std::uint64_t>(count, 2); ++generator) {
    if (std::gcd(generator, count) != 1) continue;
    const double distance = shortest(generator, count, width, height);
    // By more than rounding, so that mirror images count as equal.
    if (distance > best_distance * (1 + 1e-9)) {
      best = generator;
      best_distance = distance;
    }
  }
  return best;
}

std::vector<UnitPoint> rotated_grid_points(std::uint64_t count) {
  if (count == 4) return {{0.125, 0.625}, {0.375, 0.125}, {0.625, 0.875}, {0.875, 0.375}};
  return lattice(count, lattice_generator(count));
}

Rendering rotated_grid(const Radiance& radiance, const Job& job) {
  std::vector<UnitPoint> points;
  return box_of(radiance, job,
                [&](std::uint64_t, std::uint64_t count,
                    const UnitPoint& size) -> const std::vector<UnitPoint>& {
                  if (points.empty()) {
                    points = size == UnitPoint{1, 1}
                                 ? rotated_grid_points(count)
                                 : lattice(count, lattice_generator(count, size[0], size[1]));
                  }
                  return points;
                });
}

Rendering sobol_box(const Radiance& radiance, const Job& job) {
  std::vector<UnitPoint> points;
  return box_of(radiance, job,
                [&](std::uint64_t pixel, std::uint64_t count,
                    const UnitPoint&) -> const std::vector<UnitPoint>& {
                  points.resize(count);
                  for (std::uint64_t i = 0; i < count; ++i) {
                    const freqsynth::OwenSobol point(pixel, static_cast<std::uint32_t>(i),
                                                     job.seed);
                    points[i] = {point(0), point(1)};
                  }
                  return points;
                });
}

}  // namespace baselines
