// SPDX-License-Identifier: MIT
/// \file
/// What all systems share: random numbers, a radiance function that counts, and stratification.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "rendering.h"

namespace baselines {

using Rgb = std::array<float, 3>;  ///< linear red, green, blue

/// A radiance that was taken, and where.
struct Sample {
  double x = 0;
  double y = 0;
  Rgb rgb{};
};

/// A part of the image plane, in pixels.
struct Rectangle {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;

  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
  [[nodiscard]] double area() const { return width() * height(); }
};

/// The whole image plane of a job.
[[nodiscard]] Rectangle image_plane(const Job& job);

/// Samples per pixel that a job allows.
[[nodiscard]] double rate(const Job& job);

/// Random numbers that are the same on every machine: the distributions of the standard library
/// are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  /// Uniform in 0 .. count - 1; count > 0. The bias is below count / 2^64.
  std::uint64_t below(std::uint64_t count) { return generator_() % count; }

 private:
  std::mt19937_64 generator_;
};

/// Far apart for seeds that are close: the finalizer of SplitMix64 (Steele, Lea and Flood 2014).
[[nodiscard]] std::uint64_t scatter(std::uint64_t seed);

/// The radiance function of a job, called no more often than the job allows. Keeps count of the
/// calls in each pixel and gives each its own id: the number of the pixel, plus an offset that
/// depends on the seed, and the number of the call in it.
class Sampler {
 public:
  /// Both must outlive the sampler.
  /// \throws std::invalid_argument when the function is empty, or the size or the number of samples
  /// is 0.
  Sampler(const Radiance& radiance, const Job& job);

  /// The radiance at (x, y). Positions outside the image, which only rounding brings about, are
  /// moved onto its border.
  /// \throws std::logic_error when left() is 0.
  Sample take(double x, double y);

  /// The same with Job::features behind the radiance. \param values  room for 3 + job.features
  void take_with_features(double x, double y, std::span<float> values);

  /// Takes a sample at a uniformly random position in `area`.
  Sample take_in(const Rectangle& area, Random& random);

  /// Calls that are still allowed.
  [[nodiscard]] std::uint64_t left() const { return job_.samples - taken_; }

  /// A black picture with the counts so far.
  [[nodiscard]] Rendering rendering() const;

 private:
  /// Moves the position of the next sample onto the image and counts it. \return its id
  std::uint64_t count(double& x, double& y);

  const Radiance& radiance_;
  const Job& job_;
  std::uint64_t first_pixel_;
  std::uint64_t taken_ = 0;
  std::vector<std::uint32_t> counts_;
};

using VisitRectangle = std::function<void(const Rectangle&)>;

/// Divides `area` into `count` > 0 rectangles of equal areas, as nearly square as rows of them can
/// be, and visits them row by row. The numbers in two rows differ by at most 1.
void for_each_equal_area(const Rectangle& area, std::uint64_t count, const VisitRectangle& visit);

/// Divides the image into one stratum for each sample of the job, all of the same area. A whole
/// number of samples per pixel gives each pixel its own grid, whose sides are the two nearest
/// factors of that number, the larger one across; any other number gives for_each_equal_area() over
/// the image.
void for_each_stratum(const Job& job, const VisitRectangle& visit);

/// Number of the pixel that contains (x, y). The far borders belong to the last pixels.
[[nodiscard]] std::size_t pixel_at(double x, double y, std::size_t width, std::size_t height);

}  // namespace baselines
