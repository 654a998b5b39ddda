// SPDX-License-Identifier: MIT
#include "window_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace farm {
namespace {

using freqsynth::PixelWindow;
constexpr std::size_t block = 8;  // pixels

/// Part number `index` of `parts` of a length, in whole blocks.
std::pair<std::size_t, std::size_t> part_of(std::size_t length, std::size_t parts,
                                            std::size_t index) {
  const std::size_t blocks = (length + block - 1) / block;
  const auto border = [&](std::size_t i) { return std::min(i * blocks / parts * block, length); };
  return {border(index), border(index + 1)};
}

/// Share of [from, to] that lies in [begin, end].
double overlap(double from, double to, double begin, double end) {
  return std::max(std::min(to, end) - std::max(from, begin), 0.0);
}

/// What a window with its surroundings would have got of the coarse picture's samples.
double weight_of(const PixelWindow& window, const freqsynth::FrequencyImage& coarse,
                 std::size_t step) {
  constexpr double around = block;  // a half of what is sampled, and little
  const auto scale = 1 / static_cast<double>(step);
  const auto width = static_cast<double>(coarse.width());
  const auto height = static_cast<double>(coarse.height());
  const auto x = static_cast<double>(window.x), y = static_cast<double>(window.y);
  const double left = std::max(x - around, 0.0) * scale;
  const double top = std::max(y - around, 0.0) * scale;
  const double right = std::min((x + static_cast<double>(window.width) + around) * scale, width);
  const double bottom = std::min((y + static_cast<double>(window.height) + around) * scale, height);
  double sum = 0;
  for (std::size_t v = 0; v < coarse.blocks_y(); ++v) {
    for (std::size_t u = 0; u < coarse.blocks_x(); ++u) {
      const auto begin_x = static_cast<double>(u * block), begin_y = static_cast<double>(v * block);
      const double end_x = std::min(begin_x + block, width);
      const double end_y = std::min(begin_y + block, height);
      const double area =
          overlap(left, right, begin_x, end_x) * overlap(top, bottom, begin_y, end_y);
      if (area <= 0) continue;
      sum += area * coarse.samples(u, v) / ((end_x - begin_x) * (end_y - begin_y));
    }
  }
  return sum;
}

}  // namespace

std::vector<PixelWindow> cut_windows(std::size_t width, std::size_t height, std::size_t columns,
                                     std::size_t rows) {
  columns = std::min(columns, (width + block - 1) / block);
  rows = std::min(rows, (height + block - 1) / block);
  std::vector<PixelWindow> windows;
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      const auto [left, right] = part_of(width, columns, i);
      const auto [top, bottom] = part_of(height, rows, j);
      windows.push_back({left, top, right - left, bottom - top});
    }
  }
  return windows;
}

std::size_t coarse_step(std::size_t width, std::size_t height) {
  // 8, so that it takes 1/64 of the samples; but three blocks, so that there is something to see,
  // and no more than a megapixel.
  std::size_t step = 8;
  while (step > 2 && std::min(width, height) / step < 24) step /= 2;
  while (width / step * (height / step) > (std::size_t{1} << 20)) step *= 2;
  return step;
}

std::vector<WindowTask> share_out(std::span<const PixelWindow> windows,
                                  const freqsynth::FrequencyImage& coarse, std::size_t step,
                                  std::uint64_t samples) {
  std::vector<double> weights;
  double sum = 0;
  for (const PixelWindow& window : windows) {
    weights.push_back(weight_of(window, coarse, step));
    sum += weights.back();
  }
  std::vector<WindowTask> tasks;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    // At least one for each block, so that there is a picture.
    const double blocks = std::ceil(static_cast<double>(windows[i].width) / block + 4) *
                          std::ceil(static_cast<double>(windows[i].height) / block + 4);
    const double share = sum > 0 ? static_cast<double>(samples) * weights[i] / sum : 0;
    tasks.push_back({windows[i], static_cast<std::uint64_t>(std::max(share, blocks))});
  }
  return tasks;
}

}  // namespace farm
