// SPDX-License-Identifier: MIT
#include "two_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "multi_stage_filter.h"

namespace baselines {
namespace {

class TwoLevelSampling {
 public:
  TwoLevelSampling(const Radiance& radiance, const Job& job, const TwoLevelSettings& settings)
      : sampler_(radiance, job), random_(job.seed), job_(job), settings_(settings) {
    choose_cells();
    samples_.reserve(job.samples);
    low_.assign(columns_ * rows_, filled(std::numeric_limits<float>::max()));
    high_.assign(columns_ * rows_, filled(std::numeric_limits<float>::lowest()));
    counts_.assign(columns_ * rows_, 0);
  }

  void take_base() {
    for (std::size_t cell = 0; cell < counts_.size(); ++cell) take(cell, per_cell_);
  }

  void take_extra() {
    const std::vector<std::size_t> chosen = cells_to_refine();
    const std::uint64_t each = sampler_.left() / chosen.size();
    const std::uint64_t rest = sampler_.left() % chosen.size();
    for (std::size_t i = 0; i < chosen.size(); ++i) take(chosen[i], each + (i < rest ? 1 : 0));
  }

  [[nodiscard]] Rendering reconstruct() const {
    Rendering rendering = sampler_.rendering();
    if (settings_.multi_stage) {
      multi_stage_filter(samples_, rendering);
    } else {
      weighted_average(samples_, settings_.filter, widths(), rendering);
    }
    return rendering;
  }

 private:
  static Rgb filled(float value) { return {value, value, value}; }

  void choose_cells() {
    const double base = settings_.base_share * static_cast<double>(job_.samples);
    const std::uint64_t pixels = job_.width * job_.height;
    per_cell_ = std::max(static_cast<std::uint64_t>(base) / pixels, std::uint64_t{1});
    columns_ = job_.width;
    rows_ = job_.height;
    if (base < static_cast<double>(pixels)) {
      const double width = static_cast<double>(job_.width);
      const double height = static_cast<double>(job_.height);
      columns_ = static_cast<std::size_t>(
          std::clamp(std::round(std::sqrt(base * width / height)), 1.0, std::max(base, 1.0)));
      columns_ = std::min(columns_, job_.width);
      rows_ = std::clamp(static_cast<std::size_t>(base) / columns_, std::size_t{1}, job_.height);
    }
  }

  [[nodiscard]] Rectangle area_of(std::size_t cell) const {
    const double width = static_cast<double>(job_.width) / static_cast<double>(columns_);
    const double height = static_cast<double>(job_.height) / static_cast<double>(rows_);
    const double x = static_cast<double>(cell % columns_);
    const double y = static_cast<double>(cell / columns_);
    return {x * width, y * height, (x + 1) * width, (y + 1) * height};
  }

  void take(std::size_t cell, std::uint64_t count) {
    if (count == 0) return;
    for_each_equal_area(area_of(cell), count, [&](const Rectangle& stratum) {
      const Sample sample = sampler_.take_in(stratum, random_);
      samples_.push_back(sample);
      for (std::size_t c = 0; c < 3; ++c) {
        low_[cell][c] = std::min(low_[cell][c], sample.rgb[c]);
        high_[cell][c] = std::max(high_[cell][c], sample.rgb[c]);
      }
    });
    counts_[cell] += count;
  }

  /// Largest contrast of a component, relative to its threshold.
  [[nodiscard]] float excess(std::size_t cell) const {
    Rgb low = low_[cell];
    Rgb high = high_[cell];
    if (per_cell_ < settings_.judged) {
      const std::size_t x = cell % columns_;
      const std::size_t y = cell / columns_;
      for (std::size_t row = y - std::min<std::size_t>(y, 1); row <= std::min(y + 1, rows_ - 1);
           ++row) {
        for (std::size_t column = x - std::min<std::size_t>(x, 1);
             column <= std::min(x + 1, columns_ - 1); ++column) {
          for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], low_[row * columns_ + column][c]);
            high[c] = std::max(high[c], high_[row * columns_ + column][c]);
          }
        }
      }
    }
    const Rgb all = contrast(low, high);
    float largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, all[c] / settings_.contrast[c]);
    return largest;
  }

  /// Those of highest contrast first; equals in random order, so that a remainder of the samples
  /// does not always fall to the same part of the picture.
  std::vector<std::size_t> cells_to_refine() {
    std::vector<std::size_t> cells(counts_.size());
    std::iota(cells.begin(), cells.end(), std::size_t{0});
    for (std::size_t i = cells.size(); i > 1; --i) std::swap(cells[i - 1], cells[random_.below(i)]);
    std::vector<float> excesses(cells.size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) excesses[cell] = excess(cell);
    std::stable_sort(cells.begin(), cells.end(),
                     [&](std::size_t a, std::size_t b) { return excesses[a] > excesses[b]; });
    const auto high = static_cast<std::size_t>(
        std::count_if(excesses.begin(), excesses.end(), [](float value) { return value >= 1; }));
    const double most = settings_.most_extra * static_cast<double>(per_cell_);
    const double needed = std::ceil(static_cast<double>(sampler_.left()) / most);
    cells.resize(std::clamp(high,
                            std::min(static_cast<std::size_t>(std::max(needed, 1.0)), cells.size()),
                            cells.size()));
    return cells;
  }

  [[nodiscard]] std::vector<float> widths() const {
    const double cell_area = area_of(0).area();
    std::vector<float> widths(job_.width * job_.height);
    for (std::size_t y = 0; y < job_.height; ++y) {
      for (std::size_t x = 0; x < job_.width; ++x) {
        // The cell at the middle of the pixel.
        const std::size_t column = (2 * x + 1) * columns_ / (2 * job_.width);
        const std::size_t row = (2 * y + 1) * rows_ / (2 * job_.height);
        const double density = static_cast<double>(counts_[row * columns_ + column]) / cell_area;
        widths[y * job_.width + x] = static_cast<float>(width_for_rate(density));
      }
    }
    return widths;
  }

  Sampler sampler_;
  Random random_;
  const Job& job_;
  const TwoLevelSettings& settings_;
  std::size_t columns_ = 0;  // of cells
  std::size_t rows_ = 0;
  std::uint64_t per_cell_ = 0;  // base samples
  std::vector<Sample> samples_;
  std::vector<Rgb> low_;  // least and greatest radiance in each cell
  std::vector<Rgb> high_;
  std::vector<std::uint64_t> counts_;  // samples in each cell
};

}  // namespace

Rgb contrast(const Rgb& low, const Rgb& high) {
  Rgb contrast{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float sum = high[c] + low[c];
    if (sum > 0) contrast[c] = (high[c] - low[c]) / sum;
  }
  return contrast;
}

Rendering two_level(const Radiance& radiance, const Job& job, const TwoLevelSettings& settings) {
  TwoLevelSampling sampling(radiance, job, settings);
  sampling.take_base();
  sampling.take_extra();
  return sampling.reconstruct();
}

}  // namespace baselines
