// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/basis/check.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/block_noise.h"
#include "freqsynth/image/guided_regression.h"
#include "freqsynth/image/lone_peaks.h"
#include "freqsynth/image/rare_light.h"
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

/// Of each value of some rows the least and the greatest of those up to `reach` away along both
/// axes.
/// \param least  like `most`: the rows' results
inline void extremes_near(std::span<const float> values, std::size_t width, std::size_t height,
                          std::size_t reach, std::size_t first, std::size_t last, float* least,
                          float* most) {
  const std::size_t top = first - std::min(first, reach), bottom = std::min(last + reach, height);
  NoisyPicture::Plane low((bottom - top) * width), high(low.size());
  for (std::size_t y = top; y < bottom; ++y) {
    const float* line = &values[y * width];
    float *lows = &low[(y - top) * width], *highs = &high[(y - top) * width];
    std::copy_n(line, width, lows);
    std::copy_n(line, width, highs);
    for (std::size_t shift = 1; shift <= reach && shift < width; ++shift) {
      for (std::size_t x = 0; x + shift < width; ++x) {
        lows[x] = std::min(lows[x], line[x + shift]);
        highs[x] = std::max(highs[x], line[x + shift]);
        lows[x + shift] = std::min(lows[x + shift], line[x]);
        highs[x + shift] = std::max(highs[x + shift], line[x]);
      }
    }
  }
  for (std::size_t y = first; y < last; ++y) {
    float *lows = least + (y - first) * width, *highs = most + (y - first) * width;
    std::copy_n(&low[(y - top) * width], width, lows);
    std::copy_n(&high[(y - top) * width], width, highs);
    for (std::size_t v = y - std::min(y, reach); v < std::min(y + reach + 1, height); ++v) {
      const float *low_line = &low[(v - top) * width], *high_line = &high[(v - top) * width];
      for (std::size_t x = 0; x < width; ++x) {
        lows[x] = std::min(lows[x], low_line[x]);
        highs[x] = std::max(highs[x], high_line[x]);
      }
    }
  }
}

/// Holds pixels within the range of `known` in the 5 x 5 pixels around each: regressions ring
/// beside what is far brighter.
inline void hold_within(const NoisyPicture& picture, std::span<const float> known,
                        std::span<float> pixels, const ExecutorRef& executor) {
  constexpr std::size_t reach = 2, rows = 2 * block_size;
  const std::size_t width = picture.width;
  share_pieces(executor, (picture.height + rows - 1) / rows, [&](std::size_t part) {
    const std::size_t first = part * rows, last = std::min(first + rows, picture.height);
    NoisyPicture::Plane least((last - first) * width), most(least.size());
    extremes_near(known, width, picture.height, reach, first, last, least.data(), most.data());
    for (std::size_t i = 0; i < least.size(); ++i) {
      float& pixel = pixels[first * width + i];
      pixel = std::clamp(pixel, least[i], most[i]);
    }
  });
}

/// Of each block the least value of those in it and in the eight around it.
inline NoisyPicture::Plane least_around(const NoisyPicture::Plane& values, std::size_t blocks_x) {
  NoisyPicture::Plane least(values.size()), most(values.size());
  const std::size_t blocks_y = values.size() / blocks_x;
  extremes_near(values, blocks_x, blocks_y, 1, 0, blocks_y, least.data(), most.data());
  return least;
}

/// What feature_guides() refers to, of each feature.
struct FeatureSamples {
  NoisyPicture::Plane means;      // of the samples of each pixel
  NoisyPicture::Plane variances;  // of each block
};

/// Features as guides. Those that are the same everywhere tell nothing.
inline std::vector<GuidedRegression::Guide> feature_guides(const NoisyPicture& picture,
                                                           std::span<const std::size_t> features,
                                                           std::vector<FeatureSamples>& samples,
                                                           const ExecutorRef& executor) {
  constexpr double ridge = 0.01;  // of the variance over the picture
  constexpr double noise_ridge = 8;
  std::vector<double> spreads(features.size());
  samples.resize(features.size());
  share_pieces(executor, features.size(), [&](std::size_t i) {
    const std::size_t channel = features[i];
    const NoisyPicture::Plane& pixels = picture.pixels[channel];
    spreads[i] = deviation(pixels);
    if (!(spreads[i] > 0)) return;
    // An edge of a feature is in some blocks only, noise of one is around as well.
    samples[i] = {pixels, least_around(picture.variances[channel], picture.width / block_size)};
    auto& means = samples[i].means;
    for (std::size_t k = 0; k < means.size(); ++k) {
      if (picture.weights[k] > 0) means[k] = picture.sums[channel][k] / picture.weights[k];
    }
  });
  std::vector<GuidedRegression::Guide> guides;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (!(spreads[i] > 0)) continue;
    guides.push_back({samples[i].means.data(), picture.pixels[features[i]].data(),
                      ridge * spreads[i] * spreads[i], noise_ridge, samples[i].variances.data()});
  }
  return guides;
}

/// What counts for a fit: more where there are few samples.
inline GuidedRegression::Window window_of(const NoisyPicture& picture) {
  double samples = 0;
  for (const float weight : picture.weights) samples += static_cast<double>(weight);
  constexpr double few = 2;  // for each pixel
  const bool more = samples < few * static_cast<double>(picture.weights.size());
  return {2, more ? 3u : 2u};
}

FREQSYNTH_INLINE void smooth_noise_on(NoisyPicture& picture, std::span<const std::size_t> channels,
                                      std::span<const std::size_t> features,
                                      const ExecutorRef& executor) {
  check_picture(picture, channels);
  check_picture(picture, features);
  if (picture.weights.empty() || channels.empty()) return;

  // In units of the variance of a pixel's mean: ridges, and what steps on borders may be.
  struct Pass {
    double ridge, border;
  };
  constexpr Pass passes[] = {{3, 0.3}, {0.3, 0.3}};
  constexpr double last_border = 0.03;
  // A step that is left in a feature is drawn into all channels. A guide may have none; what is
  // shown of a feature keeps closer to its samples.
  constexpr double feature_border = 1, guide_border = 10;
  const auto close_all = [&](std::size_t channel, double variance) {
    close_borders(picture, picture.sums[channel], variance, picture.pixels[channel], executor);
  };

  // Pixels of many samples follow them closely, and leave nothing over that tells of noise. What a
  // block's fit leaves over does, but where samples are few it has edges in it. The pixels of the
  // second pass are smooth, and tell of noise themselves.
  constexpr float share_of_variance = 0.7f;
  std::vector<NoisyPicture::Plane> variances;
  for (const std::size_t channel : channels) {
    for (float& value : variances.emplace_back(picture.variances[channel])) {
      value *= share_of_variance;
    }
  }

  std::vector<RareLight> rare;
  std::vector<NoisyPicture::Plane> all_sums;  // with the rare light, which picture.sums lack
  std::vector<const float*> sums;
  for (const std::size_t channel : channels) {
    rare.emplace_back(picture, channel, executor);
    all_sums.push_back(rare.back().other_sums());
    picture.sums[channel].swap(all_sums.back());
    sums.push_back(picture.sums[channel].data());
  }
  std::vector<NoisyPicture::Plane> shown;
  for (const std::size_t channel : features) {
    const auto& seamless = picture.seamless;
    const bool borders = std::find(seamless.begin(), seamless.end(), channel) == seamless.end();
    if (borders) close_all(channel, feature_border);
    shown.push_back(picture.pixels[channel]);
    if (borders) close_all(channel, guide_border);
  }
  std::vector<FeatureSamples> feature_samples;
  std::vector<GuidedRegression::Guide> guides =
      feature_guides(picture, features, feature_samples, executor);
  const GuidedRegression::Window window = window_of(picture);
  std::vector<NoisyPicture::Plane> pilots(channels.size()), predictions(channels.size());
  bool first = true;
  for (const Pass& pass : passes) {
    for (std::size_t t = 0; t < channels.size(); ++t) {
      close_all(channels[t], pass.border);
      // A fit that knows of a peak follows it; the samples still have its light, which is spread.
      if (first) pilots[t] = LonePeaks(picture, channels[t]).removed(executor);
      const float* pilot = first ? pilots[t].data() : picture.pixels[channels[t]].data();
      guides.push_back({pilot, pilot, 0, pass.ridge, first ? variances[t].data() : nullptr, t});
    }
    const GuidedRegression regression(picture, window, guides, sums, executor);
    for (std::size_t t = 0; t < channels.size(); ++t) {
      predictions[t] = picture.pixels[channels[t]];
    }
    regression.predict(std::vector<std::span<float>>(predictions.begin(), predictions.end()),
                       executor);
    for (std::size_t t = 0; t < channels.size(); ++t) {
      NoisyPicture::Plane& known = picture.pixels[channels[t]];
      hold_within(picture, known, predictions[t], executor);
      known.swap(predictions[t]);
    }
    guides.clear();
    first = false;
  }
  for (std::size_t t = 0; t < channels.size(); ++t) {
    const std::size_t channel = channels[t];
    const NoisyPicture::Plane& sums_here = picture.sums[channel];
    pool_levels(picture, sums_here, rare[t].any() ? all_sums[t] : sums_here,
                picture.pixels[channel], executor);
    close_all(channel, last_border);
    rare[t].spread(picture.pixels[channel], executor);
    picture.sums[channel] = std::move(all_sums[t]);
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    picture.pixels[features[i]] = std::move(shown[i]);
  }
}

}  // namespace detail

FREQSYNTH_INLINE void smooth_noise(NoisyPicture& picture, std::span<const std::size_t> channels,
                                   std::span<const std::size_t> features) {
  detail::smooth_noise_on(picture, channels, features, {});
}

}  // namespace freqsynth
