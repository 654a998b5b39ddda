// SPDX-License-Identifier: MIT
#include "pixel_buffers.h"

#include <algorithm>
#include <cstdint>

#include "freqsynth/basis/owen_sobol.h"

namespace baselines {
namespace {

Buffer like(const Buffer& buffer) {
  return {buffer.width, buffer.height, buffer.channels, std::vector<float>(buffer.values.size())};
}

/// Value by value.
template <class Function>
Buffer combine(const Buffer& a, const Buffer& b, const Function& function) {
  Buffer result = like(a);
  std::transform(a.values.begin(), a.values.end(), b.values.begin(), result.values.begin(),
                 function);
  return result;
}

/// Means over 2 radius + 1 values along lines of `length` values that are `stride` apart.
void box_mean_along(std::vector<float>& values, std::size_t first, std::size_t length,
                    std::size_t stride, std::size_t radius, std::vector<double>& sums) {
  sums.assign(length + 1, 0.0);
  for (std::size_t i = 0; i < length; ++i) {
    sums[i + 1] = sums[i] + double{values[first + i * stride]};
  }
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t begin = i - std::min(i, radius);
    const std::size_t end = std::min(i + radius + 1, length);
    values[first + i * stride] =
        static_cast<float>((sums[end] - sums[begin]) / static_cast<double>(end - begin));
  }
}

}  // namespace

Buffer Buffer::part(std::size_t first, std::size_t count) const {
  Buffer result{width, height, count, {}};
  result.values.reserve(pixels() * count);
  for (std::size_t i = first; i < values.size(); i += channels) {
    result.values.insert(result.values.end(), &values[i], &values[i] + count);
  }
  return result;
}

Buffer mean_of(const Buffer& a, const Buffer& b) {
  return combine(a, b, [](float x, float y) { return 0.5f * (x + y); });
}

Buffer box_mean(const Buffer& buffer, std::size_t radius) {
  Buffer result = buffer;
  const auto& [width, height, channels, values] = buffer;
  std::vector<double> sums;
  for (std::size_t i = 0; i < height * channels; ++i) {
    box_mean_along(result.values, i / channels * width * channels + i % channels, width, channels,
                   radius, sums);
  }
  for (std::size_t i = 0; i < width * channels; ++i) {
    box_mean_along(result.values, i, height, width * channels, radius, sums);
  }
  return result;
}

PixelBuffers sample_pixels(Sampler& sampler, const Job& job) {
  const std::size_t channels = 3 + job.features;
  const std::uint64_t pixels = job.width * job.height;
  Buffer first{job.width, job.height, channels, std::vector<float>(pixels * channels)};
  Buffer second = like(first);
  Buffer variance = like(first);  // of the mean of random samples
  std::vector<float> values(channels);
  std::vector<double> sum(channels), half(channels), squares(channels);
  const std::uint64_t whole = job.samples / pixels;
  const std::uint64_t rest = job.samples % pixels;
  for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
    const std::uint64_t count = whole + (pixel + 1) * rest / pixels - pixel * rest / pixels;
    std::fill(sum.begin(), sum.end(), 0.0);
    std::fill(squares.begin(), squares.end(), 0.0);
    for (std::uint64_t i = 0; i < count; ++i) {
      // Runs of a power of two are evenly spread in themselves.
      if (i == count / 2) half = sum;
      const freqsynth::OwenSobol point(pixel, static_cast<std::uint32_t>(i), job.seed);
      sampler.take_with_features(static_cast<double>(pixel % job.width) + point(0),
                                 static_cast<double>(pixel / job.width) + point(1), values);
      for (std::size_t c = 0; c < channels; ++c) {
        sum[c] += double{values[c]};
        squares[c] += double{values[c]} * double{values[c]};
      }
    }
    const double n = static_cast<double>(count);
    const double n_first = static_cast<double>(count / 2);
    for (std::size_t c = 0; c < channels; ++c) {
      const std::size_t at = pixel * channels + c;
      if (count < 2) {
        first.values[at] = second.values[at] = static_cast<float>(sum[c]);
        continue;
      }
      first.values[at] = static_cast<float>(half[c] / n_first);
      second.values[at] = static_cast<float>((sum[c] - half[c]) / (n - n_first));
      const double square = std::max(0.0, squares[c] - sum[c] * sum[c] / n);
      variance.values[at] = static_cast<float>(square / (n - 1) / n_first);
    }
  }
  if (whole < 2) {
    const Buffer mean = box_mean(mean_of(first, second), 1);
    const auto product = [](float x, float y) { return x * y; };
    variance = combine(box_mean(combine(first, second, product), 1), combine(mean, mean, product),
                       [](float squares_mean, float mean_square) {
                         return std::max(0.0f, squares_mean - mean_square);
                       });
    return {{first, second}, variance};
  }
  const Buffer halves = box_mean(
      combine(first, second, [](float a, float b) { return 0.5f * (a - b) * (a - b); }), 10);
  const Buffer samples = box_mean(variance, 10);
  const Buffer scale = combine(halves, samples, [](float a, float b) { return b > 0 ? a / b : 0; });
  variance = combine(box_mean(variance, 1), scale, [](float a, float b) { return a * b; });
  return {{first, second}, variance};
}

Rendering picture_of(const Buffer& buffer, const Sampler& sampler) {
  Rendering rendering = sampler.rendering();
  rendering.pixels = buffer.part(0, 3).values;
  return rendering;
}

}  // namespace baselines
