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
  const std::size_t channels = buffer.channels;
  const std::size_t line = buffer.width * channels;
  // sums[i + channels] = sums[i] + value i, along a line; then the same of whole lines.
  std::vector<double> sums(line + channels);
  for (std::size_t y = 0; y < buffer.height; ++y) {
    float* const values = &result.values[y * line];
    for (std::size_t i = 0; i < line; ++i) sums[i + channels] = sums[i] + double{values[i]};
    for (std::size_t x = 0; x < buffer.width; ++x) {
      const std::size_t begin = x - std::min(x, radius);
      const std::size_t end = std::min(x + radius + 1, buffer.width);
      const double share = 1 / static_cast<double>(end - begin);
      for (std::size_t c = 0; c < channels; ++c) {
        values[x * channels + c] =
            static_cast<float>((sums[end * channels + c] - sums[begin * channels + c]) * share);
      }
    }
  }
  sums.assign((buffer.height + 1) * line, 0.0);
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    sums[i + line] = sums[i] + double{result.values[i]};
  }
  for (std::size_t y = 0; y < buffer.height; ++y) {
    const std::size_t begin = y - std::min(y, radius);
    const std::size_t end = std::min(y + radius + 1, buffer.height);
    const double share = 1 / static_cast<double>(end - begin);
    for (std::size_t i = 0; i < line; ++i) {
      result.values[y * line + i] =
          static_cast<float>((sums[end * line + i] - sums[begin * line + i]) * share);
    }
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
