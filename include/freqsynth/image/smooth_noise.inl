// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/image/block_noise.h"
#include "freqsynth/image/guided_regression.h"
#include "freqsynth/image/smooth_noise.h"

namespace freqsynth {
namespace detail {

/// Standard deviation of a plane's values.
inline double deviation(std::span<const float> plane) {
  double mean = 0, square = 0;
  for (const float value : plane) mean += static_cast<double>(value);
  mean /= static_cast<double>(plane.size());
  for (const float value : plane) square += std::pow(static_cast<double>(value) - mean, 2);
  return std::sqrt(square / static_cast<double>(plane.size()));
}

inline void check_picture(const NoisyPicture& picture, std::span<const std::size_t> channels) {
  const std::size_t pixels = picture.width * picture.height;
  if (picture.width % block_size != 0 || picture.height % block_size != 0) {
    refuse("the noisy picture has " + std::to_string(picture.width) + " x " +
           std::to_string(picture.height) + " pixels, not multiples of 8");
  }
  bool fits = picture.weights.size() == pixels && picture.sums.size() == picture.pixels.size() &&
              picture.variances.size() == picture.pixels.size();
  for (const auto& plane : picture.sums) fits = fits && plane.size() == pixels;
  for (const auto& plane : picture.pixels) fits = fits && plane.size() == pixels;
  for (const auto& plane : picture.variances) fits = fits && plane.size() == pixels / max_terms;
  if (!fits) refuse("the planes of the noisy picture do not have its size");
  for (const std::size_t channel : channels) {
    if (channel < picture.pixels.size()) continue;
    refuse("the noisy picture has no channel " + std::to_string(channel));
  }
}

/// Calls take(a, b) with each value of a line of `length` values and with those up to `reach` away.
template <class Take>
void visit_near(std::size_t length, std::size_t reach, Take&& take) {
  for (std::size_t i = 0; i < length; ++i) {
    for (std::size_t j = i - std::min(i, reach); j < std::min(i + reach + 1, length); ++j) {
      take(i, j);
    }
  }
}

/// Holds pixels within the range of `known` in the 5 x 5 pixels around each: regressions ring
/// beside what is far brighter.
inline void hold_within(const NoisyPicture& picture, std::span<const float> known,
                        std::span<float> pixels) {
  constexpr std::size_t reach = 2;
  const std::size_t width = picture.width;
  NoisyPicture::Plane low(known.begin(), known.end()), high = low;
  for (std::size_t y = 0; y < picture.height; ++y) {
    const std::size_t row = y * width;
    visit_near(width, reach, [&](std::size_t x, std::size_t other) {
      low[row + x] = std::min(low[row + x], known[row + other]);
      high[row + x] = std::max(high[row + x], known[row + other]);
    });
  }
  NoisyPicture::Plane least = low, most = high;
  visit_near(picture.height, reach, [&](std::size_t y, std::size_t other) {
    for (std::size_t x = 0; x < width; ++x) {
      least[y * width + x] = std::min(least[y * width + x], low[other * width + x]);
      most[y * width + x] = std::max(most[y * width + x], high[other * width + x]);
    }
  });
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = std::clamp(pixels[i], least[i], most[i]);
  }
}

/// Of each block the least value of those in it and in the eight around it.
inline NoisyPicture::Plane least_around(const NoisyPicture::Plane& values, std::size_t blocks_x) {
  const std::size_t blocks_y = values.size() / blocks_x;
  NoisyPicture::Plane lines = values;
  for (std::size_t y = 0; y < blocks_y; ++y) {
    visit_near(blocks_x, 1, [&](std::size_t x, std::size_t other) {
      float& least = lines[y * blocks_x + x];
      least = std::min(least, values[y * blocks_x + other]);
    });
  }
  NoisyPicture::Plane all = lines;
  visit_near(blocks_y, 1, [&](std::size_t y, std::size_t other) {
    for (std::size_t x = 0; x < blocks_x; ++x) {
      float& least = all[y * blocks_x + x];
      least = std::min(least, lines[other * blocks_x + x]);
    }
  });
  return all;
}

/// What feature_guides() refers to, of each feature.
struct FeatureSamples {
  NoisyPicture::Plane means;      // of the samples of each pixel
  NoisyPicture::Plane variances;  // of each block
};

/// Features as guides. Those that are the same everywhere tell nothing.
inline std::vector<GuidedRegression::Guide> feature_guides(const NoisyPicture& picture,
                                                           std::span<const std::size_t> features,
                                                           std::vector<FeatureSamples>& samples) {
  constexpr double ridge = 0.01;  // of the variance over the picture
  constexpr double noise_ridge = 4;
  std::vector<GuidedRegression::Guide> guides;
  samples.reserve(features.size());
  for (const std::size_t channel : features) {
    const NoisyPicture::Plane& pixels = picture.pixels[channel];
    const double spread = deviation(pixels);
    if (!(spread > 0)) continue;
    // An edge of a feature is in some blocks only, noise of one is around as well.
    auto& [means, variances] = samples.emplace_back(FeatureSamples{
        pixels, least_around(picture.variances[channel], picture.width / block_size)});
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (picture.weights[i] > 0) means[i] = picture.sums[channel][i] / picture.weights[i];
    }
    guides.push_back(
        {means.data(), pixels.data(), ridge * spread * spread, noise_ridge, variances.data()});
  }
  return guides;
}

FREQSYNTH_INLINE void smooth_noise_on(NoisyPicture& picture, std::span<const std::size_t> channels,
                                      std::span<const std::size_t> features,
                                      const ExecutorRef& executor) {
  static_cast<void>(executor);
  check_picture(picture, channels);
  check_picture(picture, features);
  if (picture.weights.empty() || channels.empty()) return;

  // In units of the variance of a pixel's mean: ridges, and what steps on borders may be.
  struct Pass {
    double ridge, border;
  };
  constexpr Pass passes[] = {{3, 1}, {0.6, 0.3}};
  constexpr double last_border = 0.1;
  const auto close_all = [&](std::size_t channel, double variance) {
    close_borders(picture, picture.sums[channel], variance, picture.pixels[channel]);
  };

  // Pixels of many samples follow them closely, and leave nothing over that tells of noise. What a
  // block's fit leaves over does, but of samples that are evenly spread it says too much.
  constexpr float share_of_variance = 0.35f;
  std::vector<NoisyPicture::Plane> variances;
  for (const std::size_t channel : channels) {
    for (float& value : variances.emplace_back(picture.variances[channel])) {
      value *= share_of_variance;
    }
  }

  std::vector<const float*> sums;
  for (const std::size_t channel : channels) sums.push_back(picture.sums[channel].data());
  for (const std::size_t channel : features) close_all(channel, passes[0].border);
  std::vector<FeatureSamples> feature_samples;
  std::vector<GuidedRegression::Guide> guides = feature_guides(picture, features, feature_samples);
  for (const Pass& pass : passes) {
    for (std::size_t t = 0; t < channels.size(); ++t) {
      close_all(channels[t], pass.border);
      const float* pilot = picture.pixels[channels[t]].data();
      guides.push_back({pilot, pilot, 0, pass.ridge, variances[t].data(), t});
    }
    const GuidedRegression regression(picture, {2, 2}, guides, sums);
    std::vector<NoisyPicture::Plane> predictions;
    for (std::size_t t = 0; t < channels.size(); ++t) {
      const NoisyPicture::Plane& pilot = picture.pixels[channels[t]];
      regression.predict(t, predictions.emplace_back(pilot));
      hold_within(picture, pilot, predictions.back());
    }
    for (std::size_t t = 0; t < channels.size(); ++t) {
      picture.pixels[channels[t]] = std::move(predictions[t]);
    }
    guides.clear();
  }
  for (const std::size_t channel : channels) {
    pool_levels(picture, picture.sums[channel], picture.pixels[channel]);
    close_all(channel, last_border);
  }
}

}  // namespace detail

FREQSYNTH_INLINE void smooth_noise(NoisyPicture& picture, std::span<const std::size_t> channels,
                                   std::span<const std::size_t> features) {
  detail::smooth_noise_on(picture, channels, features, {});
}

}  // namespace freqsynth
