// SPDX-License-Identifier: MIT
#include "feature_regression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "low_discrepancy.h"

namespace baselines {
namespace {

constexpr std::size_t most_features = 7;
constexpr std::size_t terms = 1 + most_features;  // unused ones stay 0
constexpr std::size_t columns = terms + 4;        // with the three colours, and one for the width

/// A share of the weights that is added to the normal matrix's diagonal, so that features that are
/// the same everywhere get no slope. Features vary by about 1.
constexpr double ridge = 1e-6;

using Rows = std::array<std::array<float, columns>, terms>;
using Fit = std::array<std::array<float, 4>, terms>;

/// Solves the normal equations by Cholesky's decomposition, for the three colours at once.
Fit solve(const Rows& rows) {
  std::array<std::array<double, columns>, terms> a{};
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t j = 0; j < columns; ++j) a[i][j] = double{rows[i][j]};
    a[i][i] += ridge * double{rows[0][0]};
  }
  // The upper triangle becomes the factor, the colours the solution of the lower system.
  for (std::size_t i = 0; i < terms; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      for (std::size_t j = i; j < columns; ++j) a[i][j] -= a[k][i] * a[k][j];
    }
    // Rounding may leave less than the ridge where features depend on each other.
    const double root = std::sqrt(std::max(a[i][i], ridge * double{rows[0][0]}));
    for (std::size_t j = i; j < columns; ++j) a[i][j] /= root;
    a[i][i] = root;
  }
  Fit fit{};
  for (std::size_t i = terms; i-- > 0;) {
    for (std::size_t c = 0; c < 3; ++c) {
      double value = a[i][terms + c];
      for (std::size_t j = i + 1; j < terms; ++j) value -= a[i][j] * double{fit[j][c]};
      fit[i][c] = static_cast<float>(value / a[i][i]);
    }
  }
  return fit;
}

}  // namespace

Buffer regressed(const Buffer& source, const Buffer& guide, const Buffer& variance,
                 const Buffer& features, const NonLocalMeansSettings& settings) {
  const auto width = static_cast<std::ptrdiff_t>(source.width);
  const auto height = static_cast<std::ptrdiff_t>(source.height);
  const auto search = static_cast<std::ptrdiff_t>(settings.search);
  const auto side = static_cast<std::size_t>(2 * search + 1);

  // [pixel][offset], row by row
  std::vector<float> weights(source.pixels() * side * side);
  for_each_weight(guide, variance, settings,
                  [&](std::ptrdiff_t dx, std::ptrdiff_t dy, std::span<const float> plane) {
                    const std::size_t offset = static_cast<std::size_t>(dy + search) * side +
                                               static_cast<std::size_t>(dx + search);
                    for (std::size_t p = 0; p < plane.size(); ++p) {
                      weights[p * side * side + offset] = plane[p];
                    }
                  });

  // What a pixel of a window has: 1, its features relative to the middle, its colours.
  std::vector<std::array<float, columns>> all(source.pixels());
  for (std::size_t p = 0; p < all.size(); ++p) {
    all[p][0] = 1;
    std::copy_n(&features.values[p * features.channels], features.channels, &all[p][1]);
    std::copy_n(&source.values[p * 3], 3, &all[p][terms]);
  }
  std::vector<std::array<float, 4>> sums(source.pixels());  // the last one of the weights
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    for (std::ptrdiff_t x = 0; x < width; ++x) {
      const auto p = static_cast<std::size_t>(y * width + x);
      const auto for_window = [&](const auto& visit) {
        for (std::ptrdiff_t dy = -std::min(search, y); dy <= std::min(search, height - 1 - y);
             ++dy) {
          for (std::ptrdiff_t dx = -std::min(search, x); dx <= std::min(search, width - 1 - x);
               ++dx) {
            const auto offset = static_cast<std::size_t>(dy + search) * side +
                                static_cast<std::size_t>(dx + search);
            const float weight = weights[p * side * side + offset];
            if (weight == 0) continue;
            const auto q = static_cast<std::size_t>((y + dy) * width + x + dx);
            std::array<float, columns> values = all[q];
            for (std::size_t i = 1; i < terms; ++i) values[i] -= all[p][i];
            visit(q, weight, values);
          }
        }
      };
      Rows rows{};
      for_window([&](std::size_t, float weight, const std::array<float, columns>& values) {
        for (std::size_t i = 0; i < terms; ++i) {
          const float factor = weight * values[i];
          for (std::size_t j = 0; j < columns; ++j) rows[i][j] += factor * values[j];
        }
      });
      const Fit fit = solve(rows);
      for_window([&](std::size_t q, float weight, const std::array<float, columns>& values) {
        std::array<float, 4> estimate{};
        for (std::size_t i = 0; i < terms; ++i) {
          for (std::size_t c = 0; c < 4; ++c) estimate[c] += values[i] * fit[i][c];
        }
        estimate[3] = 1;
        for (std::size_t c = 0; c < 4; ++c) sums[q][c] += weight * estimate[c];
      });
    }
  }
  Buffer result{source.width, source.height, 3, std::vector<float>(source.values.size())};
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = sums[i / 3][i % 3] / sums[i / 3][3];
  }
  return result;
}

Rendering feature_regression(const Radiance& radiance, const Job& job,
                             const FeatureRegressionSettings& settings) {
  if (job.samples < job.width * job.height) return sobol_box(radiance, job);
  Sampler sampler(radiance, job);
  const PixelBuffers buffers = sample_pixels(sampler, job);
  const auto part = [&](std::size_t first, std::size_t count) {
    return PixelBuffers{{buffers.half[0].part(first, count), buffers.half[1].part(first, count)},
                        buffers.variance.part(first, count)};
  };
  Buffer features{job.width, job.height, job.features,
                  std::vector<float>(job.width * job.height * job.features)};
  // Colour, normal and nearness: each group has weights of its own.
  for (const auto& [first, count] : {std::pair<std::size_t, std::size_t>{0, 3}, {3, 3}, {6, 1}}) {
    if (first + count > job.features) break;
    const Buffer group = cross_filtered(part(3 + first, count), settings.features);
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      features.values[i / count * job.features + first + i % count] = group.values[i];
    }
  }
  const PixelBuffers colours = part(0, 3);
  const auto& [a, b] = colours.half;
  Rendering result =
      picture_of(mean_of(regressed(a, b, colours.variance, features, settings.colours),
                         regressed(b, a, colours.variance, features, settings.colours)),
                 sampler);
  for (float& value : result.pixels) value = std::max(value, 0.0f);  // a plane may go below
  return result;
}

}  // namespace baselines
