// SPDX-License-Identifier: MIT
#include "dippe_wold.h"

#include <stdexcept>

#include "supersampling.h"

namespace baselines {
namespace {

struct Average {
  double rgb[3] = {};
  double noise_gain = 0;  // variance of the average for samples of variance 1
};

Average average(const Gathered& gathered) {
  Average average;
  for (std::size_t c = 0; c < 3; ++c) average.rgb[c] = gathered.sum[c] / gathered.weight;
  average.noise_gain = gathered.squared_weight / (gathered.weight * gathered.weight);
  return average;
}

double squared_difference(const Average& a, const Average& b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a.rgb[c] - b.rgb[c]) * (a.rgb[c] - b.rgb[c]);
  return sum;
}

/// Variance of the samples in a square window, summed over the components.
double variance(const SampleGrid& grid, double x, double y, double reach) {
  double count = 0;
  double sum[3] = {};
  double squares[3] = {};
  const Rectangle window{x - reach, y - reach, x + reach, y + reach};
  grid.for_each_near(window, [&](const Sample& sample) {
    if (sample.x < window.left || sample.x > window.right || sample.y < window.top ||
        sample.y > window.bottom) {
      return;
    }
    ++count;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = static_cast<double>(sample.rgb[c]);
      sum[c] += value;
      squares[c] += value * value;
    }
  });
  double total = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    total += std::max(0.0, squares[c] - sum[c] * sum[c] / count) / (count - 1);
  }
  return total;
}

float chosen_width(const SampleGrid& grid, double x, double y, double base,
                   const DippeWoldSettings& settings) {
  std::vector<Gathered> gathered;
  double reach = 0;  // of the window that tells the variance
  for (const double width : settings.widths) {
    gathered.push_back(gather(grid, settings.filter, base * width, x, y));
    if (reach == 0 && gathered.back().count >= 4) reach = radius(settings.filter) * base * width;
  }
  // Too few samples to tell anything: as wide as possible.
  if (reach == 0) return static_cast<float>(base * settings.widths.back());
  const double spread = variance(grid, x, y, reach);
  std::size_t chosen = 0;
  while (chosen + 1 < gathered.size()) {
    const Gathered& next = gathered[chosen + 1];
    if (gathered[chosen].usable() && next.usable()) {
      const Average narrow = average(gathered[chosen]);
      const double noise = spread * narrow.noise_gain;
      const double signal = squared_difference(narrow, average(next));
      if (signal >= settings.threshold * noise) break;
    }
    ++chosen;
  }
  return static_cast<float>(base * settings.widths[chosen]);
}

}  // namespace

std::vector<float> dippe_wold_widths(std::span<const Sample> samples, std::size_t width,
                                     std::size_t height, const DippeWoldSettings& settings) {
  if (settings.widths.empty()) throw std::invalid_argument("at least one width is needed");
  const SampleGrid grid(samples, width, height);
  const double base =
      width_for_rate(static_cast<double>(samples.size()) / static_cast<double>(width * height));
  std::vector<float> widths(width * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      widths[y * width + x] = chosen_width(grid, static_cast<double>(x) + 0.5,
                                           static_cast<double>(y) + 0.5, base, settings);
    }
  }
  return widths;
}

Rendering dippe_wold(const Radiance& radiance, const Job& job, const DippeWoldSettings& settings) {
  Sampler sampler(radiance, job);
  const std::vector<Sample> samples = supersamples(sampler, job, true);
  Rendering rendering = sampler.rendering();
  const std::vector<float> widths = dippe_wold_widths(samples, job.width, job.height, settings);
  weighted_average(samples, settings.filter, widths, rendering);
  return rendering;
}

}  // namespace baselines
