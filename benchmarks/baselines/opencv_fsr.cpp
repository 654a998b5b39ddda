// SPDX-License-Identifier: MIT
#include "opencv_fsr.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/xphoto/inpainting.hpp>

#include "filter.h"
#include "sampler.h"
#include "supersampling.h"

namespace baselines {
namespace {

/// The free pixel nearest to `pixel` by the larger of the distances in columns and rows, a random
/// one of several. There must be one.
std::size_t free_pixel_near(std::size_t pixel, const Job& job, const std::vector<bool>& taken,
                            Random& random) {
  const auto width = static_cast<std::ptrdiff_t>(job.width);
  const auto height = static_cast<std::ptrdiff_t>(job.height);
  const std::ptrdiff_t x0 = static_cast<std::ptrdiff_t>(pixel) % width;
  const std::ptrdiff_t y0 = static_cast<std::ptrdiff_t>(pixel) / width;
  std::vector<std::size_t> free;
  for (std::ptrdiff_t distance = 1; free.empty(); ++distance) {
    const std::ptrdiff_t bottom = std::min(y0 + distance, height - 1);
    for (std::ptrdiff_t y = std::max<std::ptrdiff_t>(y0 - distance, 0); y <= bottom; ++y) {
      // Inner rows of the ring have its two ends only.
      const std::ptrdiff_t step = std::abs(y - y0) == distance ? 1 : 2 * distance;
      for (std::ptrdiff_t x = x0 - distance; x <= x0 + distance; x += step) {
        if (x < 0 || x >= width) continue;
        const auto near = static_cast<std::size_t>(y * width + x);
        if (!taken[near]) free.push_back(near);
      }
    }
  }
  return free[random.below(free.size())];
}

std::uint8_t encode_srgb(float linear) {
  const float encoded =
      linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

float decode_srgb(std::uint8_t code) {
  const float encoded = static_cast<float>(code) / 255;
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Radiances that are not numbers become 0.
float clamp_to_display(float linear) { return linear > 0 ? std::min(linear, 1.0f) : 0.0f; }

/// OpenCV divides the image into blocks of 16 x 16 pixels, those into smaller ones, and omits the
/// ones at the borders that are not whole.
constexpr int kBlock = 16;

int missing_to_whole_blocks(int size) { return (kBlock - size % kBlock) % kBlock; }

/// Whether OpenCV finds a known pixel around each block of the smallest size. Where it does not, it
/// divides by 0, and what comes of that spreads to the neighbours.
bool each_block_has_known(const cv::Mat& known) {
  constexpr int smallest = 4;
  constexpr int border = 14;  // to 32 pixels, the size of its Fourier transforms
  const cv::Rect image({0, 0}, known.size());
  for (int y = 0; y < known.rows; y += smallest) {
    for (int x = 0; x < known.cols; x += smallest) {
      constexpr int side = smallest + 2 * border;
      const cv::Rect around(x - border, y - border, side, side);
      if (cv::countNonZero(known(around & image)) == 0) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::size_t> spread_pixels(const Job& job) {
  Random random(job.seed);
  std::vector<bool> taken(job.width * job.height, false);
  std::vector<std::size_t> displaced;
  for_each_stratum(job, [&](const Rectangle& stratum) {
    const double x = stratum.left + random.uniform() * stratum.width();
    const double y = stratum.top + random.uniform() * stratum.height();
    const std::size_t pixel = pixel_at(x, y, job.width, job.height);
    if (taken[pixel]) displaced.push_back(pixel);
    taken[pixel] = true;
  });
  // After all others, so that none of those is displaced in turn.
  for (const std::size_t pixel : displaced) {
    taken[free_pixel_near(pixel, job, taken, random)] = true;
  }
  std::vector<std::size_t> pixels;
  pixels.reserve(job.samples);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (taken[i]) pixels.push_back(i);
  }
  return pixels;
}

Rendering opencv_fsr(const Radiance& radiance, const Job& job) {
  if (job.samples >= job.width * job.height) return supersampling(radiance, job);
  Sampler sampler(radiance, job);
  std::vector<Sample> samples;
  samples.reserve(job.samples);
  const int width = static_cast<int>(job.width);
  const int height = static_cast<int>(job.height);
  cv::Mat known(height, width, CV_8UC1, cv::Scalar::all(0));
  cv::Mat encoded(height, width, CV_8UC3, cv::Scalar::all(0));
  for (const std::size_t pixel : spread_pixels(job)) {
    const auto x = static_cast<int>(pixel % job.width);
    const auto y = static_cast<int>(pixel / job.width);
    Sample& sample = samples.emplace_back(sampler.take(x + 0.5, y + 0.5));
    std::transform(sample.rgb.begin(), sample.rgb.end(), sample.rgb.begin(), clamp_to_display);
    known.at<std::uint8_t>(y, x) = 255;
    // OpenCV's order is blue, green, red.
    std::transform(sample.rgb.rbegin(), sample.rgb.rend(), encoded.at<cv::Vec3b>(y, x).val,
                   encode_srgb);
  }
  Rendering rendering = sampler.rendering();

  // Mirrored, which keeps the density of known pixels.
  const int right = missing_to_whole_blocks(width);
  const int bottom = missing_to_whole_blocks(height);
  cv::copyMakeBorder(known, known, 0, bottom, 0, right, cv::BORDER_REFLECT);
  cv::copyMakeBorder(encoded, encoded, 0, bottom, 0, right, cv::BORDER_REFLECT);
  if (!each_block_has_known(known)) {
    const float widen = static_cast<float>(width_for_rate(rate(job)));
    weighted_average(samples, PixelFilter::box, {&widen, 1}, rendering);
    return rendering;
  }
  // Neither the picture nor the time that is told shall depend on the number of processors.
  cv::setNumThreads(1);
  cv::Mat whole;
  cv::xphoto::inpaint(encoded, known, whole, cv::xphoto::INPAINT_FSR_FAST);

  float* value = rendering.pixels.data();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const cv::Vec3b& bgr = whole.at<cv::Vec3b>(y, x);
      for (int c = 2; c >= 0; --c) *value++ = decode_srgb(bgr[c]);
    }
  }
  for (const Sample& sample : samples) {
    const std::size_t pixel = pixel_at(sample.x, sample.y, job.width, job.height);
    std::copy(sample.rgb.begin(), sample.rgb.end(), &rendering.pixels[3 * pixel]);
  }
  return rendering;
}

}  // namespace baselines
