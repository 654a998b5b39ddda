// SPDX-License-Identifier: MIT
#include "non_local_means.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "low_discrepancy.h"

namespace baselines {
namespace {

/// Calls visit(pixel, other) for all pixels whose other one, at the offset, is in the image.
template <class Visit>
void for_each_pair(const Buffer& buffer, std::ptrdiff_t dx, std::ptrdiff_t dy, const Visit& visit) {
  const auto width = static_cast<std::ptrdiff_t>(buffer.width);
  const auto height = static_cast<std::ptrdiff_t>(buffer.height);
  for (std::ptrdiff_t y = std::max<std::ptrdiff_t>(0, -dy); y < std::min(height, height - dy);
       ++y) {
    for (std::ptrdiff_t x = std::max<std::ptrdiff_t>(0, -dx); x < std::min(width, width - dx);
         ++x) {
      visit(static_cast<std::size_t>(y * width + x),
            static_cast<std::size_t>((y + dy) * width + x + dx));
    }
  }
}

}  // namespace

void for_each_weight(const Buffer& guide, const Buffer& variance,
                     const NonLocalMeansSettings& settings,
                     const std::function<void(std::ptrdiff_t dx, std::ptrdiff_t dy,
                                              std::span<const float> weights)>& visit) {
  const auto search = static_cast<std::ptrdiff_t>(settings.search);
  const auto square_k = static_cast<float>(settings.k * settings.k);
  const float share = 1 / static_cast<float>(guide.channels);
  for (std::ptrdiff_t dy = -search; dy <= search; ++dy) {
    for (std::ptrdiff_t dx = -search; dx <= search; ++dx) {
      if (std::abs(dx) >= static_cast<std::ptrdiff_t>(guide.width) ||
          std::abs(dy) >= static_cast<std::ptrdiff_t>(guide.height)) {
        continue;
      }
      // Equation 3 of the paper: squared differences less what noise alone makes of them, in units
      // of the variance. Patches are cut off at the image's border.
      Buffer distance{guide.width, guide.height, 2, std::vector<float>(2 * guide.pixels())};
      for_each_pair(guide, dx, dy, [&](std::size_t p, std::size_t q) {
        float sum = 0;
        for (std::size_t c = 0; c < guide.channels; ++c) {
          const float a = variance.values[p * guide.channels + c];
          const float b = variance.values[q * guide.channels + c];
          const float difference =
              guide.values[p * guide.channels + c] - guide.values[q * guide.channels + c];
          sum += (difference * difference - (a + std::min(a, b))) / (1e-10f + square_k * (a + b));
        }
        // One pixel that differs by that much is enough for a weight of 0.
        distance.values[2 * p] = std::min(sum * share, 1e4f);
        distance.values[2 * p + 1] = 1;
      });
      distance = box_mean(distance, settings.patch);
      std::vector<float> weights(guide.pixels());
      for_each_pair(guide, dx, dy, [&](std::size_t p, std::size_t) {
        weights[p] = std::exp(-std::max(0.0f, distance.values[2 * p] / distance.values[2 * p + 1]));
      });
      visit(dx, dy, weights);
    }
  }
}

Buffer filtered(const Buffer& source, const Buffer& guide, const Buffer& variance,
                const NonLocalMeansSettings& settings) {
  std::vector<float> sums(source.pixels());
  Buffer result{source.width, source.height, source.channels,
                std::vector<float>(source.values.size())};
  for_each_weight(guide, variance, settings,
                  [&](std::ptrdiff_t dx, std::ptrdiff_t dy, std::span<const float> weights) {
                    for_each_pair(source, dx, dy, [&](std::size_t p, std::size_t q) {
                      sums[p] += weights[p];
                      for (std::size_t c = 0; c < source.channels; ++c) {
                        result.values[p * source.channels + c] +=
                            weights[p] * source.values[q * source.channels + c];
                      }
                    });
                  });
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] /= sums[i / source.channels];  // at least 1, of the pixel itself
  }
  return result;
}

Buffer cross_filtered(const PixelBuffers& buffers, const NonLocalMeansSettings& settings) {
  const auto& [a, b] = buffers.half;
  return mean_of(filtered(a, b, buffers.variance, settings),
                 filtered(b, a, buffers.variance, settings));
}

Rendering non_local_means(const Radiance& radiance, const Job& job,
                          const NonLocalMeansSettings& settings) {
  if (job.samples < job.width * job.height) return sobol_box(radiance, job);
  Job plain = job;
  plain.features = 0;
  Sampler sampler(radiance, plain);
  return picture_of(cross_filtered(sample_pixels(sampler, plain), settings), sampler);
}

}  // namespace baselines
