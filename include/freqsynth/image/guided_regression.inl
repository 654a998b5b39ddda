// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "freqsynth/basis/float_bits.h"
#include "freqsynth/basis/kernels.h"
#include "freqsynth/engine/shared_work.h"
#include "freqsynth/image/guided_regression.h"

namespace freqsynth {
namespace detail {

/// Positions are in cells from the middle of the picture: here of a cell's middle,
inline double middle_of_cell(std::size_t cell, std::size_t cells) {
  return static_cast<double>(cell) + 0.5 - 0.5 * static_cast<double>(cells);
}
/// and of a pixel's.
inline double middle_of_pixel(std::size_t pixel, std::size_t pixels, std::size_t cell) {
  return (static_cast<double>(pixel) + 0.5 - 0.5 * static_cast<double>(pixels)) /
         static_cast<double>(cell);
}

FREQSYNTH_INLINE GuidedRegression::GuidedRegression(const NoisyPicture& picture,
                                                    const Window& window, std::vector<Guide> guides,
                                                    std::vector<const float*> sums,
                                                    const ExecutorRef& executor)
    : picture_(picture),
      window_(window),
      guides_(std::move(guides)),
      sums_(std::move(sums)),
      cells_x_(picture.width / window_.cell),
      cells_y_(picture.height / window_.cell),
      terms_(guides_.size() + 2),
      moments_(2 + sums_.size() + guides_.size() + terms_ + terms_ * (terms_ + 1) / 2 +
               terms_ * sums_.size()),
      slopes_(terms_ + 1) {
  if (cells_x_ * cells_y_ == 0) return;
  const auto blends = [&](std::size_t pixels, std::size_t cells) {
    return blends_along(pixels, window_.cell, cells, static_cast<float>(cells));
  };
  columns_ = blends(picture.width, cells_x_);
  lines_ = blends(picture.height, cells_y_);
  fits_.assign(cells_x_ * cells_y_ * sums_.size() * slopes_,
               std::numeric_limits<float>::quiet_NaN());
  // Each part sums up the cells above and below it anew.
  constexpr std::size_t part = 32;
  share_work(executor, (cells_y_ + part - 1) / part, [&](WorkPieces& parts) {
    Work work;
    for (std::size_t i; parts.take(i);) {
      fit_rows(i * part, std::min((i + 1) * part, cells_y_), work);
    }
  });
}

FREQSYNTH_INLINE void GuidedRegression::collect(std::size_t cell_y, std::span<double> row) const {
  std::fill(row.begin(), row.end(), 0.0);
  std::vector<double> terms(terms_);
  for (std::size_t y = cell_y * window_.cell; y < (cell_y + 1) * window_.cell; ++y) {
    for (std::size_t x = 0; x < picture_.width; ++x) {
      const std::size_t pixel = y * picture_.width + x;
      const auto weight = static_cast<double>(picture_.weights[pixel]);
      if (!(weight > 0)) continue;
      double* m = &row[x / window_.cell * moments_];
      m[0] += weight;
      m[1] += 1;
      for (std::size_t g = 0; g < guides_.size(); ++g) {
        terms[g] = static_cast<double>(guides_[g].at_samples[pixel]);
      }
      terms[terms_ - 2] = middle_of_pixel(x, picture_.width, window_.cell);
      terms[terms_ - 1] = middle_of_pixel(y, picture_.height, window_.cell);
      for (std::size_t t = 0; t < sums_.size(); ++t) {
        m[first_target() + t] += static_cast<double>(sums_[t][pixel]);
      }
      const std::size_t block = y / block_size * (picture_.width / block_size) + x / block_size;
      for (std::size_t g = 0; g < guides_.size(); ++g) {
        const Guide& guide = guides_[g];
        double variance = guide.variances ? static_cast<double>(guide.variances[block]) : 0;
        if (guide.of_target != no_target) {
          const double left = static_cast<double>(sums_[guide.of_target][pixel]) / weight -
                              static_cast<double>(guide.at_pixels[pixel]);
          variance = std::max(variance, weight * left * left);
        }
        m[first_variance() + g] += variance;
      }
      double* pairs = m + first_pair();
      double* products = m + first_product();
      for (std::size_t i = 0; i < terms_; ++i) {
        const double weighted = weight * terms[i];
        m[first_term() + i] += weighted;
        for (std::size_t j = 0; j <= i; ++j) *pairs++ += weighted * terms[j];
        for (const float* sums : sums_) *products++ += terms[i] * static_cast<double>(sums[pixel]);
      }
    }
  }
}

/// Fits the up to four cells of a row that have been summed up.
FREQSYNTH_INLINE void GuidedRegression::fit_cells(std::size_t y, Work& work) {
  constexpr std::size_t lanes = 4;
  const std::size_t targets = sums_.size();
  const auto sum = [&](std::size_t moment) { return &work.sums[moment * lanes]; };
  const double* const weight = sum(0);
  const double* const sampled = sum(1);
  const double* pairs = sum(first_pair());
  const double* products = sum(first_product());
  const auto means = [&](std::size_t i) { return sum(first_term() + i); };
  for (std::size_t i = 0; i < terms_; ++i) {
    for (std::size_t j = 0; j <= i; ++j, pairs += lanes) {
      double* entry = &work.matrix[(i * terms_ + j) * lanes];
      const double *a = means(i), *b = means(j);
      for (std::size_t k = 0; k < lanes; ++k) {
        entry[k] = pairs[k] / weight[k] - a[k] / weight[k] * (b[k] / weight[k]);
      }
    }
    double* variance = &work.matrix[(i * terms_ + i) * lanes];
    for (std::size_t k = 0; k < lanes; ++k) {
      double ridge = 0.02;  // of positions, in cells
      if (i < guides_.size()) {
        const double noise = sum(first_variance() + i)[k] / sampled[k];
        ridge = guides_[i].ridge + guides_[i].noise_ridge * noise * work.pixels[k] / weight[k];
      }
      variance[k] = std::max(variance[k], 0.0) + ridge;
      // Guides that are constant, without noise.
      if (!(variance[k] > 0)) variance[k] = 1;
    }
    for (std::size_t t = 0; t < targets; ++t, products += lanes) {
      double* side = &work.right[(i * targets + t) * lanes];
      const double *a = means(i), *b = sum(first_target() + t);
      for (std::size_t k = 0; k < lanes; ++k) {
        side[k] = products[k] / weight[k] - a[k] / weight[k] * (b[k] / weight[k]);
      }
    }
  }
  solve_four(work.matrix.data(), work.right.data(), terms_, targets, work.definite.data());
  for (std::size_t k = 0; k < work.count; ++k) {
    const std::size_t x = work.cells[k];
    // Positions are to count from the cell's centre.
    const double centre_x = middle_of_cell(x, cells_x_), centre_y = middle_of_cell(y, cells_y_);
    for (std::size_t t = 0; t < targets; ++t) {
      float* fit = &fits_[((y * cells_x_ + x) * targets + t) * slopes_];
      double level = sum(first_target() + t)[k] / weight[k];
      for (std::size_t i = 0; i < terms_; ++i) {
        const double slope = work.definite[k] > 0 ? work.right[(i * targets + t) * lanes + k] : 0;
        level -= slope * means(i)[k] / weight[k];
        fit[i + 1] = static_cast<float>(slope);
      }
      fit[0] = static_cast<float>(level);
      fit[0] += static_cast<float>(static_cast<double>(fit[slopes_ - 2]) * centre_x +
                                   static_cast<double>(fit[slopes_ - 1]) * centre_y);
    }
  }
  work.count = 0;
}

FREQSYNTH_INLINE void GuidedRegression::fit_rows(std::size_t first, std::size_t last, Work& work) {
  const std::size_t reach = window_.reach;
  work.rows.resize(2 * reach + 1);
  for (auto& row : work.rows) row.resize(cells_x_ * moments_);
  work.column.resize(cells_x_ * moments_);
  work.window.resize(moments_);
  constexpr std::size_t lanes = 4;
  work.sums.assign(moments_ * lanes, 1.0);
  work.matrix.resize(terms_ * terms_ * lanes);
  work.right.resize(terms_ * sums_.size() * lanes);
  work.pixels.fill(1);
  std::size_t collected = first - std::min(first, reach);
  for (std::size_t y = first; y < last; ++y) {
    for (; collected < std::min(y + reach + 1, cells_y_); ++collected) {
      collect(collected, work.rows[collected % work.rows.size()]);
    }
    fit_row(y, work);
  }
}

FREQSYNTH_INLINE void GuidedRegression::fit_row(std::size_t y, Work& work) {
  constexpr std::size_t lanes = 4;
  const std::size_t reach = window_.reach;
  // The weight of a cell falls linearly with the distance along each axis.
  const auto share = [=](std::size_t a, std::size_t b) {
    return static_cast<double>(reach + 1 - (a > b ? a - b : b - a));
  };
  const auto around = [=](std::size_t cell, std::size_t cells) {
    return std::pair{cell - std::min(cell, reach), std::min(cell + reach + 1, cells)};
  };
  const auto [top, bottom] = around(y, cells_y_);
  std::fill(work.column.begin(), work.column.end(), 0.0);
  double shares_y = 0;
  for (std::size_t row = top; row < bottom; ++row) {
    const double weight = share(row, y);
    add_scaled(work.rows[row % work.rows.size()].data(), weight, work.column.size(),
               work.column.data());
    shares_y += weight;
  }
  for (std::size_t x = 0; x < cells_x_; ++x) {
    const auto [left, right] = around(x, cells_x_);
    std::fill(work.window.begin(), work.window.end(), 0.0);
    double shares_x = 0;
    for (std::size_t cell = left; cell < right; ++cell) {
      const double weight = share(cell, x);
      add_scaled(&work.column[cell * moments_], weight, moments_, work.window.data());
      shares_x += weight;
    }
    if (!(work.window[0] > 1e-3)) continue;
    const std::size_t lane = work.count++;
    for (std::size_t i = 0; i < moments_; ++i) work.sums[i * lanes + lane] = work.window[i];
    work.pixels[lane] = static_cast<double>(window_.cell * window_.cell) * shares_x * shares_y;
    work.cells[lane] = x;
    if (work.count == lanes) fit_cells(y, work);
  }
  if (work.count > 0) fit_cells(y, work);
}

FREQSYNTH_INLINE void GuidedRegression::predict(std::span<const std::span<float>> pixels,
                                                const ExecutorRef& executor) const {
  FREQSYNTH_ASSERT(pixels.size() == sums_.size());
  if (columns_.empty()) return;
  share_pieces(executor, picture_.height / block_size, [&](std::size_t row) {
    for (std::size_t y = row * block_size; y < (row + 1) * block_size; ++y) {
      predict_row(y, pixels);
    }
  });
}

FREQSYNTH_INLINE void GuidedRegression::predict_row(
    std::size_t y, std::span<const std::span<float>> pixels) const {
  struct Cell {
    const float* fit;
    float share, right, down;  // the last two: from the cell's centre, in cells
  };
  std::vector<float> guides(guides_.size());
  const auto distance = [&](std::size_t at, std::size_t cell) {
    return (static_cast<float>(at) + 0.5f) / static_cast<float>(window_.cell) -
           static_cast<float>(cell) - 0.5f;
  };
  const LinearBlend<float>& rows = lines_[y];
  const float down_first = distance(y, rows.first), down_second = distance(y, rows.second);
  for (std::size_t x = 0; x < picture_.width; ++x) {
    const LinearBlend<float>& columns = columns_[x];
    const std::size_t pixel = y * picture_.width + x;
    std::array<Cell, 4> cells;
    std::size_t count = 0;
    const auto add = [&](std::size_t cell_x, float right, std::size_t cell_y, float down,
                         float share) {
      const float* fit = &fits_[(cell_y * cells_x_ + cell_x) * sums_.size() * slopes_];
      if (share > 0 && !is_nan(fit[0])) cells[count++] = {fit, share, right, down};
    };
    const float first = distance(x, columns.first), second = distance(x, columns.second);
    add(columns.first, first, rows.first, down_first, (1 - columns.share) * (1 - rows.share));
    add(columns.second, second, rows.first, down_first, columns.share * (1 - rows.share));
    add(columns.first, first, rows.second, down_second, (1 - columns.share) * rows.share);
    add(columns.second, second, rows.second, down_second, columns.share * rows.share);
    if (count == 0) continue;
    for (std::size_t g = 0; g < guides.size(); ++g) guides[g] = guides_[g].at_pixels[pixel];
    for (std::size_t target = 0; target < pixels.size(); ++target) {
      float sum = 0, shares = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const float* fit = cells[k].fit + target * slopes_;
        float value = fit[0] + fit[slopes_ - 2] * cells[k].right + fit[slopes_ - 1] * cells[k].down;
        for (std::size_t g = 0; g < guides.size(); ++g) value += fit[g + 1] * guides[g];
        sum += cells[k].share * value;
        shares += cells[k].share;
      }
      pixels[target][pixel] = sum / shares;
    }
  }
}

}  // namespace detail
}  // namespace freqsynth
