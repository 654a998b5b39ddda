// SPDX-License-Identifier: MIT
#include "energy_preserving.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace baselines {
namespace {

/// Pixels of a square window, without those outside the picture.
struct Window {
  Window(const Rendering& rendering, std::size_t x, std::size_t y, std::size_t reach)
      : left(x - std::min(x, reach)),
        top(y - std::min(y, reach)),
        right(std::min(x + reach, rendering.width - 1)),
        bottom(std::min(y + reach, rendering.height - 1)) {}

  [[nodiscard]] std::size_t size() const { return (right - left + 1) * (bottom - top + 1); }

  template <class Visit>
  void for_each(std::size_t width, const Visit& visit) const {
    for (std::size_t row = top; row <= bottom; ++row) {
      for (std::size_t column = left; column <= right; ++column) visit(row * width + column);
    }
  }

  std::size_t left, top, right, bottom;
};

struct Neighbours {
  double mean[3] = {};
  double deviation[3] = {};
};

Neighbours neighbours(const Rendering& rendering, std::size_t x, std::size_t y) {
  const std::size_t self = y * rendering.width + x;
  const Window window(rendering, x, y, 1);
  const double count = static_cast<double>(window.size() - 1);
  Neighbours result;
  double squares[3] = {};
  window.for_each(rendering.width, [&](std::size_t pixel) {
    if (pixel == self) return;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = static_cast<double>(rendering.pixels[pixel * 3 + c]);
      result.mean[c] += value / count;
      squares[c] += value * value / count;
    }
  });
  for (std::size_t c = 0; c < 3; ++c) {
    result.deviation[c] = std::sqrt(std::max(0.0, squares[c] - result.mean[c] * result.mean[c]));
  }
  return result;
}

}  // namespace

Rendering energy_preserving(const Rendering& rendering, const EnergyPreservingSettings& settings) {
  const double energy = std::accumulate(rendering.pixels.begin(), rendering.pixels.end(), 0.0);
  const double visible = settings.visible * energy / static_cast<double>(rendering.pixels.size());
  if (!(visible > 0) || rendering.samples.size() < 2) return rendering;

  std::vector<double> sums(rendering.pixels.begin(), rendering.pixels.end());
  for (std::size_t y = 0; y < rendering.height; ++y) {
    for (std::size_t x = 0; x < rendering.width; ++x) {
      const std::size_t self = (y * rendering.width + x) * 3;
      const Neighbours around = neighbours(rendering, x, y);
      double excess[3];
      double largest = 0;
      bool noisy = false;
      for (std::size_t c = 0; c < 3; ++c) {
        excess[c] = static_cast<double>(rendering.pixels[self + c]) - around.mean[c];
        largest = std::max(largest, std::abs(excess[c]));
        noisy |= std::abs(excess[c]) > std::max(settings.deviations * around.deviation[c], visible);
      }
      if (!noisy) continue;

      std::size_t reach = 1;
      while (reach < settings.reach &&
             static_cast<double>(Window(rendering, x, y, reach).size()) * visible < largest) {
        ++reach;
      }
      const Window window(rendering, x, y, reach);
      const double size = static_cast<double>(window.size());
      // The same share of all components, so that the colour of what is spread does not change.
      const double share = std::min(1.0, size * visible / largest);
      for (std::size_t c = 0; c < 3; ++c) {
        const double spread = excess[c] * share;
        sums[self + c] -= spread;
        window.for_each(rendering.width,
                        [&](std::size_t pixel) { sums[pixel * 3 + c] += spread / size; });
      }
    }
  }
  Rendering filtered = rendering;
  std::transform(sums.begin(), sums.end(), filtered.pixels.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return filtered;
}

}  // namespace baselines
