// SPDX-License-Identifier: MIT
#include "multi_stage_filter.h"

#include <algorithm>

namespace baselines {
namespace {

/// Values of cells, and which cells have one.
struct Stage {
  Stage(std::size_t w, std::size_t h) : width(w), height(h), values(w * h), counts(w * h, 0) {}

  void add(std::size_t cell, const Rgb& value) {
    for (std::size_t c = 0; c < 3; ++c) values[cell][c] += value[c];
    ++counts[cell];
  }

  void average() {
    for (std::size_t cell = 0; cell < values.size(); ++cell) {
      if (counts[cell] < 2) continue;
      for (float& value : values[cell]) value /= static_cast<float>(counts[cell]);
    }
  }

  std::size_t width;
  std::size_t height;
  std::vector<Rgb> values;
  std::vector<std::uint32_t> counts;
};

Stage local_averages(std::span<const Sample> samples, std::size_t width, std::size_t height,
                     std::size_t cells_per_pixel) {
  Stage stage(width * cells_per_pixel, height * cells_per_pixel);
  const double scale = static_cast<double>(cells_per_pixel);
  for (const Sample& sample : samples) {
    stage.add(pixel_at(sample.x * scale, sample.y * scale, stage.width, stage.height), sample.rgb);
  }
  stage.average();
  return stage;
}

/// The next stage: boxes twice as wide.
Stage widened(const Stage& stage) {
  Stage wide(stage.width / 2, stage.height / 2);
  for (std::size_t y = 0; y < stage.height; ++y) {
    for (std::size_t x = 0; x < stage.width; ++x) {
      const std::size_t cell = y * stage.width + x;
      if (stage.counts[cell] > 0) wide.add(y / 2 * wide.width + x / 2, stage.values[cell]);
    }
  }
  wide.average();
  return wide;
}

/// Mean around an empty pixel.
Rgb mean_around(const Stage& pixels, std::size_t x, std::size_t y) {
  for (std::size_t reach = 1;; reach *= 2) {
    double sum[3] = {};
    std::size_t count = 0;
    const std::size_t bottom = std::min(y + reach, pixels.height - 1);
    const std::size_t right = std::min(x + reach, pixels.width - 1);
    for (std::size_t row = y - std::min(y, reach); row <= bottom; ++row) {
      for (std::size_t column = x - std::min(x, reach); column <= right; ++column) {
        const std::size_t pixel = row * pixels.width + column;
        if (pixels.counts[pixel] == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(pixels.values[pixel][c]);
        ++count;
      }
    }
    if (count == 0) continue;
    Rgb mean;
    for (std::size_t c = 0; c < 3; ++c) {
      mean[c] = static_cast<float>(sum[c] / static_cast<double>(count));
    }
    return mean;
  }
}

}  // namespace

void multi_stage_filter(std::span<const Sample> samples, Rendering& rendering) {
  const Stage pixels =
      widened(widened(local_averages(samples, rendering.width, rendering.height, 4)));
  for (std::size_t y = 0; y < pixels.height; ++y) {
    for (std::size_t x = 0; x < pixels.width; ++x) {
      const std::size_t pixel = y * pixels.width + x;
      const Rgb value = pixels.counts[pixel] > 0 ? pixels.values[pixel] : mean_around(pixels, x, y);
      std::copy(value.begin(), value.end(), &rendering.pixels[pixel * 3]);
    }
  }
}

}  // namespace baselines
