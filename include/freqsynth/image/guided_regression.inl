// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "freqsynth/basis/float_bits.h"
#include "freqsynth/image/guided_regression.h"

namespace freqsynth {
namespace detail {

/// Solves a symmetric positive definite system in place, by Cholesky's factors. `matrix` is n x n,
/// of which the lower triangle counts; `right` has n rows, one column per right side.
/// \return false when the matrix is not positive definite
inline bool solve_in_place(std::span<double> matrix, std::span<double> right, std::size_t n) {
  const std::size_t sides = right.size() / n;
  for (std::size_t j = 0; j < n; ++j) {
    double* row = &matrix[j * n];
    for (std::size_t k = 0; k < j; ++k) row[j] -= row[k] * row[k];
    if (!(row[j] > 0)) return false;
    row[j] = std::sqrt(row[j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      double* lower = &matrix[i * n];
      for (std::size_t k = 0; k < j; ++k) lower[j] -= lower[k] * row[k];
      lower[j] /= row[j];
    }
  }
  for (std::size_t c = 0; c < sides; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      double& value = right[i * sides + c];
      for (std::size_t k = 0; k < i; ++k) value -= matrix[i * n + k] * right[k * sides + c];
      value /= matrix[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      double& value = right[i * sides + c];
      for (std::size_t k = i + 1; k < n; ++k) value -= matrix[k * n + i] * right[k * sides + c];
      value /= matrix[i * n + i];
    }
  }
  return true;
}

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
                                                    std::vector<const float*> sums)
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
  fit_all();
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

/// \param windows  pixels of the window, by the weights of its cells
FREQSYNTH_INLINE void GuidedRegression::fit_cell(std::span<const double> sums, double windows,
                                                 std::span<float> out) {
  const double weight = sums[0];
  const std::size_t targets = sums_.size();
  const double* means = &sums[first_term()];
  const double* pairs = &sums[first_pair()];
  const double* products = &sums[first_product()];
  for (std::size_t i = 0; i < terms_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      matrix_[i * terms_ + j] = *pairs++ / weight - means[i] / weight * (means[j] / weight);
    }
    double ridge = 0.02;  // of positions, in cells
    if (i < guides_.size()) {
      const double noise = sums[first_variance() + i] / sums[1];
      ridge = guides_[i].ridge + guides_[i].noise_ridge * noise * windows / weight;
    }
    double& variance = matrix_[i * terms_ + i];
    variance = std::max(variance, 0.0) + ridge;
    // Guides that are constant, without noise.
    if (!(variance > 0)) variance = 1;
    for (std::size_t t = 0; t < targets; ++t) {
      right_[i * targets + t] =
          *products++ / weight - means[i] / weight * (sums[first_target() + t] / weight);
    }
  }
  if (!solve_in_place(matrix_, right_, terms_)) std::fill(right_.begin(), right_.end(), 0.0);
  for (std::size_t t = 0; t < targets; ++t) {
    double level = sums[first_target() + t] / weight;
    for (std::size_t i = 0; i < terms_; ++i) {
      const double slope = right_[i * targets + t];
      level -= slope * means[i] / weight;
      out[t * slopes_ + i + 1] = static_cast<float>(slope);
    }
    out[t * slopes_] = static_cast<float>(level);
  }
}

FREQSYNTH_INLINE void GuidedRegression::fit_all() {
  const std::size_t reach = window_.reach;
  const std::size_t targets = sums_.size();
  matrix_.resize(terms_ * terms_);
  right_.resize(terms_ * targets);
  fits_.assign(cells_x_ * cells_y_ * targets * slopes_, std::numeric_limits<float>::quiet_NaN());
  // The weight of a cell falls linearly with the distance along each axis.
  const auto share = [=](std::size_t a, std::size_t b) {
    return static_cast<double>(reach + 1 - (a > b ? a - b : b - a));
  };
  const auto around = [=](std::size_t cell, std::size_t cells) {
    return std::pair{cell - std::min(cell, reach), std::min(cell + reach + 1, cells)};
  };
  std::vector<std::vector<double>> rows(2 * reach + 1);  // of cells, by turns
  for (auto& row : rows) row.resize(cells_x_ * moments_);
  std::vector<double> column(cells_x_ * moments_), window(moments_);
  std::size_t collected = 0;
  for (std::size_t y = 0; y < cells_y_; ++y) {
    const auto [top, bottom] = around(y, cells_y_);
    for (; collected < bottom; ++collected) collect(collected, rows[collected % rows.size()]);
    std::fill(column.begin(), column.end(), 0.0);
    double shares_y = 0;
    for (std::size_t row = top; row < bottom; ++row) {
      const double weight = share(row, y);
      const std::vector<double>& sums = rows[row % rows.size()];
      for (std::size_t i = 0; i < column.size(); ++i) column[i] += weight * sums[i];
      shares_y += weight;
    }
    for (std::size_t x = 0; x < cells_x_; ++x) {
      const auto [left, right] = around(x, cells_x_);
      std::fill(window.begin(), window.end(), 0.0);
      double shares_x = 0;
      for (std::size_t cell = left; cell < right; ++cell) {
        const double weight = share(cell, x);
        const double* sums = &column[cell * moments_];
        for (std::size_t i = 0; i < moments_; ++i) window[i] += weight * sums[i];
        shares_x += weight;
      }
      if (!(window[0] > 1e-3)) continue;
      const double pixels = static_cast<double>(window_.cell * window_.cell) * shares_x * shares_y;
      const std::span out(&fits_[(y * cells_x_ + x) * targets * slopes_], targets * slopes_);
      fit_cell(window, pixels, out);
      // From here on positions count from the cell's centre.
      const double centre_x = middle_of_cell(x, cells_x_), centre_y = middle_of_cell(y, cells_y_);
      for (std::size_t t = 0; t < targets; ++t) {
        float* fit = &out[t * slopes_];
        fit[0] += static_cast<float>(static_cast<double>(fit[slopes_ - 2]) * centre_x +
                                     static_cast<double>(fit[slopes_ - 1]) * centre_y);
      }
    }
  }
}

FREQSYNTH_INLINE void GuidedRegression::predict(std::size_t target, std::span<float> pixels) const {
  // The two cells along an axis whose centres are nearest, and the second one's share.
  struct Beside {
    std::size_t first, second;
    float share;
  };
  const auto beside = [&](std::size_t pixel, std::size_t cells) -> Beside {
    const auto from_first =
        (static_cast<float>(pixel) + 0.5f) / static_cast<float>(window_.cell) - 0.5f;
    if (from_first <= 0) return {0, 0, 0};
    const auto first = static_cast<std::size_t>(from_first);
    return {first, std::min(first + 1, cells - 1), from_first - static_cast<float>(first)};
  };
  for (std::size_t y = 0; y < picture_.height; ++y) {
    const Beside rows = beside(y, cells_y_);
    for (std::size_t x = 0; x < picture_.width; ++x) {
      const Beside columns = beside(x, cells_x_);
      const std::size_t pixel = y * picture_.width + x;
      float sum = 0, shares = 0;
      const auto add = [&](std::size_t cell_x, std::size_t cell_y, float share) {
        const float* fit = &fits_[((cell_y * cells_x_ + cell_x) * sums_.size() + target) * slopes_];
        if (!(share > 0) || is_nan(fit[0])) return;
        const auto distance = [&](std::size_t at, std::size_t cell) {
          return (static_cast<float>(at) + 0.5f) / static_cast<float>(window_.cell) -
                 static_cast<float>(cell) - 0.5f;
        };
        float value = fit[0] + fit[slopes_ - 2] * distance(x, cell_x) +
                      fit[slopes_ - 1] * distance(y, cell_y);
        for (std::size_t g = 0; g < guides_.size(); ++g) {
          value += fit[g + 1] * guides_[g].at_pixels[pixel];
        }
        sum += share * value;
        shares += share;
      };
      add(columns.first, rows.first, (1 - columns.share) * (1 - rows.share));
      add(columns.second, rows.first, columns.share * (1 - rows.share));
      add(columns.first, rows.second, (1 - columns.share) * rows.share);
      add(columns.second, rows.second, columns.share * rows.share);
      if (shares > 0) pixels[pixel] = sum / shares;
    }
  }
}

}  // namespace detail
}  // namespace freqsynth
