// SPDX-License-Identifier: MIT
#include "reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <mutex>
#include <random>
#include <stdexcept>
#include <string>

#include "baselines/sampler.h"

namespace quality {

std::vector<float> Reference::pixels() const {
  std::vector<float> mean(half[0].size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5f * (half[0][i] + half[1][i]);
  return mean;
}

double Reference::standard_error() const {
  double sum = 0;
  for (std::size_t i = 0; i < half[0].size(); ++i) {
    const double difference = double{half[0][i]} - double{half[1][i]};
    sum += difference * difference;
  }
  return half[0].empty() ? 0 : std::sqrt(sum / static_cast<double>(half[0].size())) / 2;
}

Reference render_reference(const baselines::Radiance& radiance, const PixelAverage& exact,
                           const ReferenceSettings& settings, freqsynth::ThreadPool& pool,
                           const std::function<void(double)>& progress) {
  if (settings.samples == 0 || settings.samples % 2 != 0) {
    throw std::invalid_argument(std::to_string(settings.samples) +
                                " samples per pixel of the reference: not an even number from 2");
  }
  const std::size_t samples = settings.samples / 2;
  auto down = static_cast<std::size_t>(std::sqrt(static_cast<double>(samples)));
  while (samples % down != 0) --down;
  const std::size_t across = samples / down;

  Reference reference{settings.width, settings.height, {}};
  const std::size_t values = 3 * settings.width * settings.height;
  for (std::vector<float>& pixels : reference.half) pixels.resize(values);

  const std::uint64_t first = baselines::scatter(~settings.seed);
  const auto render_row = [&](std::size_t y, std::size_t which) {
    std::seed_seq seeds{settings.seed, settings.seed >> 32, std::uint64_t{y}, std::uint64_t{which}};
    std::mt19937_64 random(seeds);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    std::array<float, 3> value{};
    for (std::size_t x = 0; x < settings.width; ++x) {
      const std::size_t pixel = y * settings.width + x;
      if (exact && exact(x, y, value)) {
        std::copy(value.begin(), value.end(), &reference.half[which][3 * pixel]);
        continue;
      }
      std::array<double, 3> sum{};
      for (std::size_t i = 0; i < samples; ++i) {
        const double dx =
            (static_cast<double>(i % across) + uniform()) / static_cast<double>(across);
        const double dy = (static_cast<double>(i / across) + uniform()) / static_cast<double>(down);
        // A sequence of its own for each half of each pixel.
        const std::uint64_t id = (first + 2 * std::uint64_t{pixel} + which) * (1 << 24) + i;
        radiance(static_cast<double>(x) + dx, static_cast<double>(y) + dy, id, value);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += double{value[c]};
      }
      for (std::size_t c = 0; c < 3; ++c) {
        reference.half[which][3 * pixel + c] =
            static_cast<float>(sum[c] / static_cast<double>(samples));
      }
    }
  };

  std::mutex mutex;
  std::exception_ptr error;
  std::size_t row_begin = 0;
  const auto task = [&](std::size_t index) {
    try {
      render_row(row_begin + index / 2, index % 2);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  // A few rows at a time, so that progress can be told in between.
  const std::size_t rows_together = 2 * pool.concurrency();
  for (; row_begin < settings.height; row_begin += rows_together) {
    pool.execute(2 * std::min(rows_together, settings.height - row_begin),
                 freqsynth::TaskRef(task));
    if (error) std::rethrow_exception(error);
    progress(static_cast<double>(row_begin) / static_cast<double>(settings.height));
  }
  return reference;
}

std::uint64_t fingerprint(const baselines::Radiance& radiance, const PixelAverage& exact,
                          std::size_t width, std::size_t height) {
  // FNV-1a over the bytes of the values.
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](const std::array<float, 3>& rgb) {
    for (const float value : rgb) {
      const auto bits = std::bit_cast<std::uint32_t>(value);
      for (unsigned shift = 0; shift < 32; shift += 8) {
        hash = (hash ^ (bits >> shift & 0xff)) * 0x100000001b3;
      }
    }
  };
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (std::uint64_t i = 0; i < 4096; ++i) {
    const double x = uniform() * static_cast<double>(width);
    const double y = uniform() * static_cast<double>(height);
    std::array<float, 3> rgb{};
    radiance(x, y, i, rgb);
    add(rgb);
    if (exact && exact(static_cast<std::size_t>(x), static_cast<std::size_t>(y), rgb)) add(rgb);
  }
  return hash;
}

}  // namespace quality
