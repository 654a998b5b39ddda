// SPDX-License-Identifier: MIT
#include "freqsynth/image/guided_regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace freqsynth::detail {
namespace {

using Plane = NoisyPicture::Plane;
using Guide = GuidedRegression::Guide;
using Real = long double;

struct Example {
  NoisyPicture picture;
  std::vector<Plane> guides;  // at samples and at pixels, by turns
};

/// Random samples of two channels and two guides; some pixels have none.
Example random_example(std::size_t width, std::size_t height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Example example;
  NoisyPicture& picture = example.picture;
  picture.width = width;
  picture.height = height;
  const auto plane = [&] {
    Plane values(width * height);
    for (float& value : values) value = uniform(random);
    return values;
  };
  picture.weights = plane();
  for (float& weight : picture.weights) weight = weight < 0.3f ? 0 : 3 * weight;
  for (int c = 0; c < 2; ++c) {
    picture.pixels.push_back(plane());
    Plane& sums = picture.sums.emplace_back(plane());
    for (std::size_t i = 0; i < width * height; ++i) sums[i] *= picture.weights[i];
  }
  for (int i = 0; i < 4; ++i) example.guides.push_back(plane());
  return example;
}

/// Solves a small system by Gauss with pivots.
std::vector<Real> solve(std::vector<std::vector<Real>> matrix, std::vector<Real> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k])) pivot = i;
    }
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Real factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= factor * matrix[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) right[i] -= matrix[i][j] * right[j];
    right[i] /= matrix[i][i];
  }
  return right;
}

/// The prediction of one cell for one pixel, from the definition: minimise the weighted squares of
/// the window, plus ridges, over a level and slopes about the window's weighted means.
Real prediction(const NoisyPicture& picture, const GuidedRegression::Window& window,
                const std::vector<Guide>& guides, const Plane& sums, std::size_t cell_x,
                std::size_t cell_y, std::size_t x, std::size_t y) {
  const std::size_t terms = guides.size() + 2;
  const auto share = [&](std::size_t pixel, std::size_t cell) {
    const auto distance =
        std::abs(static_cast<Real>(pixel / window.cell) - static_cast<Real>(cell));
    return std::max(Real{0}, static_cast<Real>(window.reach) + 1 - distance);
  };
  const auto row_of = [&](std::size_t i, std::size_t j, bool at_samples) {
    std::vector<Real> row;
    for (const Guide& guide : guides) {
      row.push_back((at_samples ? guide.at_samples : guide.at_pixels)[j * picture.width + i]);
    }
    row.push_back((static_cast<Real>(i) + 0.5L) / window.cell);
    row.push_back((static_cast<Real>(j) + 0.5L) / window.cell);
    return row;
  };
  const auto visit = [&](auto&& see) {
    for (std::size_t j = 0; j < picture.height; ++j) {
      for (std::size_t i = 0; i < picture.width; ++i) {
        const Real cells = share(i, cell_x) * share(j, cell_y);
        if (cells > 0) see(cells, j * picture.width + i, row_of(i, j, true));
      }
    }
  };
  Real weight = 0, mean = 0, pixels = 0, sampled = 0;
  std::vector<Real> means(terms), residuals(guides.size());
  visit([&](Real cells, std::size_t pixel, const std::vector<Real>& row) {
    const Real w = picture.weights[pixel];
    pixels += cells;
    if (w == 0) return;
    sampled += cells;
    weight += cells * w;
    mean += cells * sums[pixel];
    for (std::size_t k = 0; k < terms; ++k) means[k] += cells * w * row[k];
    for (std::size_t g = 0; g < guides.size(); ++g) {
      const std::size_t block =
          pixel / picture.width / 8 * (picture.width / 8) + pixel % picture.width / 8;
      Real variance = guides[g].variances ? Real{guides[g].variances[block]} : 0;
      if (guides[g].of_target == 0) {
        const Real left = sums[pixel] / w - guides[g].at_pixels[pixel];
        variance = std::max(variance, w * left * left);
      }
      residuals[g] += cells * variance;
    }
  });
  mean /= weight;
  for (Real& value : means) value /= weight;
  std::vector matrix(terms, std::vector<Real>(terms));
  std::vector<Real> right(terms);
  visit([&](Real cells, std::size_t pixel, const std::vector<Real>& row) {
    const Real w = picture.weights[pixel];
    if (w == 0) return;
    for (std::size_t k = 0; k < terms; ++k) {
      right[k] += cells * (sums[pixel] - w * mean) * (row[k] - means[k]) / weight;
      for (std::size_t l = 0; l < terms; ++l) {
        matrix[k][l] += cells * w * (row[k] - means[k]) * (row[l] - means[l]) / weight;
      }
    }
  });
  for (std::size_t g = 0; g < guides.size(); ++g) {
    const Real noise = residuals[g] / sampled * (pixels / weight);
    matrix[g][g] += guides[g].ridge + guides[g].noise_ridge * noise;
  }
  matrix[terms - 2][terms - 2] += 0.02L;
  matrix[terms - 1][terms - 1] += 0.02L;
  const std::vector<Real> slopes = solve(matrix, right);
  const std::vector<Real> row = row_of(x, y, false);
  Real value = mean;
  for (std::size_t k = 0; k < terms; ++k) value += slopes[k] * (row[k] - means[k]);
  return value;
}

TEST(GuidedRegression, IsTheWeightedLeastSquaresOfEachCell) {
  Example example = random_example(24, 16, 1);
  const NoisyPicture& picture = example.picture;
  const std::vector<float> least = {0, 0.1f, 0, 0.2f, 0.05f, 1};
  std::vector<Guide> guides;
  guides.push_back({example.guides[0].data(), example.guides[1].data(), 0.01, 0.5, least.data()});
  guides.push_back({example.guides[2].data(), example.guides[2].data(), 0, 0.5, least.data(), 0});
  for (const GuidedRegression::Window window : {GuidedRegression::Window{2, 2}, {4, 1}, {8, 0}}) {
    const GuidedRegression regression(picture, window, guides,
                                      {picture.sums[0].data(), picture.sums[1].data()});
    // The noise of a guide goes by the first target; the second one comes along.
    Plane found(24 * 16), second(24 * 16);
    regression.predict(std::array{std::span<float>(found), std::span<float>(second)});
    const auto cells_x = 24 / window.cell, cells_y = 16 / window.cell;
    for (std::size_t y = 0; y < 16; ++y) {
      for (std::size_t x = 0; x < 24; ++x) {
        // Between cells' middles predictions go over into each other linearly.
        Real expected = 0, shares = 0;
        for (std::size_t v = 0; v < cells_y; ++v) {
          for (std::size_t u = 0; u < cells_x; ++u) {
            const auto near = [&](std::size_t pixel, std::size_t cell, std::size_t cells) {
              const Real place = std::clamp((static_cast<Real>(pixel) + 0.5L) / window.cell - 0.5L,
                                            Real{0}, static_cast<Real>(cells - 1));
              return std::max(Real{0}, 1 - std::abs(place - static_cast<Real>(cell)));
            };
            const Real share = near(x, u, cells_x) * near(y, v, cells_y);
            if (share == 0) continue;
            shares += share;
            expected += share * prediction(picture, window, guides, picture.sums[0], u, v, x, y);
          }
        }
        ASSERT_NEAR(static_cast<double>(shares), 1, 1e-6);
        ASSERT_NEAR(found[y * 24 + x], static_cast<double>(expected), 2e-5) << x << ", " << y;
      }
    }
  }
}

TEST(GuidedRegression, IsExactOnTargetsThatAreLinearInAGuide) {
  Example example = random_example(32, 32, 2);
  NoisyPicture& picture = example.picture;
  const Plane& at_samples = example.guides[0];
  const Plane& at_pixels = example.guides[1];
  for (std::size_t i = 0; i < at_samples.size(); ++i) {
    picture.sums[0][i] = picture.weights[i] * (3 * at_samples[i] - 1);
  }
  const GuidedRegression regression(picture, {2, 2}, {{at_samples.data(), at_pixels.data(), 0}},
                                    {picture.sums[0].data()});
  Plane found(32 * 32);
  regression.predict(std::array{std::span<float>(found)});
  for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], 3 * at_pixels[i] - 1, 1e-4f);
}

TEST(GuidedRegression, LeavesPixelsAloneThatNoSampleIsNear) {
  Example example = random_example(64, 8, 3);
  NoisyPicture& picture = example.picture;
  std::fill(picture.weights.begin(), picture.weights.end(), 0.0f);
  picture.weights[3] = 1;
  picture.sums[0][3] = 7;
  const GuidedRegression regression(picture, {2, 2}, {}, {picture.sums[0].data()});
  Plane found(64 * 8, -1.0f);
  regression.predict(std::array{std::span<float>(found)});
  EXPECT_FLOAT_EQ(found[0], 7);
  EXPECT_EQ(found[40], -1);
}

}  // namespace
}  // namespace freqsynth::detail
