// SPDX-License-Identifier: MIT
/// \file
/// Pictures and small tools that the tests of the engine share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "freqsynth/synthesizer.h"

namespace helpers {

using Point = std::pair<double, double>;

/// A picture with slow and fast parts, an edge, and no symmetry: values about 0 to 2.
inline float picture(double x, double y) {
  const double smooth = 0.5 + 0.3 * std::sin(0.11 * x + 0.05 * y);
  const double edge = 0.7 * x + y > 40 ? 0.4 : 0.0;
  const double ripple = 0.2 * std::cos(0.006 * (x * x + 1.3 * y * y));
  return static_cast<float>(smooth + edge + ripple);
}

/// Root mean square of the pixels' differences from the function's means, of 16 x 16 points each.
template <class Function>
double rmse_of(const std::vector<float>& pixels, std::size_t width, const Function& function) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double mean = 0;
    for (int k = 0; k < 256; ++k) {
      mean += function(static_cast<double>(i % width) + (k % 16 + 0.5) / 16,
                       static_cast<double>(i / width) + (k / 16 + 0.5) / 16) /
              256;
    }
    sum += std::pow(double{pixels[i]} - mean, 2);
  }
  return std::sqrt(sum / static_cast<double>(pixels.size()));
}

inline freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height,
                                                std::size_t channels = 1, std::size_t wave = 0) {
  freqsynth::SynthesisSettings settings;
  settings.width = width;
  settings.height = height;
  settings.channels = channels;
  settings.wave = wave;
  return settings;
}

inline freqsynth::StopRule at_samples(std::uint64_t samples) {
  freqsynth::StopRule stop;
  stop.samples = samples;
  return stop;
}

inline freqsynth::StopRule at_samples_per_pixel(double samples) {
  freqsynth::StopRule stop;
  stop.samples_per_pixel = samples;
  return stop;
}

/// The threshold alone, whatever number of samples blocks have had.
inline freqsynth::StopRule at_threshold(double threshold) {
  freqsynth::StopRule stop;
  stop.aliasing_threshold = threshold;
  stop.least_samples = 0;
  return stop;
}

/// Positions in the order in which run() asks for them for the first time.
template <class Function>
std::vector<Point> asked_points(freqsynth::Synthesizer& engine, const freqsynth::StopRule& stop,
                                Function function) {
  std::vector<Point> points;
  engine.run(
      [&](const freqsynth::Request& request) {
        if (!request.again) points.push_back({request.x, request.y});
        return function(request.x, request.y);
      },
      stop);
  return points;
}

/// Calls of the sampler that succeeded.
inline std::uint64_t calls_of(const freqsynth::Synthesizer& engine) {
  const freqsynth::SynthesisStats stats = engine.stats();
  return stats.samples + stats.probes;
}

/// Samples per block, row by row.
inline std::vector<std::uint32_t> counts_of(const freqsynth::FrequencyImage& image) {
  std::vector<std::uint32_t> counts;
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) counts.push_back(image.samples(x, y));
  }
  return counts;
}

/// All coefficients: block by block, channel by channel.
inline std::vector<float> coefficients_of(const freqsynth::FrequencyImage& image) {
  std::vector<float> all;
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      for (std::size_t c = 0; c < image.channels(); ++c) {
        const auto part = image.coefficients(x, y, c);
        all.insert(all.end(), part.begin(), part.end());
      }
    }
  }
  return all;
}

/// Equal to the bit (coefficients are never NaN, and -0 does not differ from 0 in any sum).
inline bool same_image(const freqsynth::FrequencyImage& a, const freqsynth::FrequencyImage& b) {
  return a.width() == b.width() && a.height() == b.height() && a.channels() == b.channels() &&
         counts_of(a) == counts_of(b) && coefficients_of(a) == coefficients_of(b);
}

inline bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace helpers
