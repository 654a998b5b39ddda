// SPDX-License-Identifier: MIT
#include "freqsynth/refine/kriging_refiner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using Real = long double;

/// The innovations of differences from the first sample, by Cholesky's factor of their covariance,
/// written out.
std::vector<Real> dense_innovations(const NodePositions& positions, std::size_t of, double noise,
                                    const std::vector<float>& values) {
  const std::size_t n = values.size();
  const auto k = [&](std::size_t i, std::size_t j) {
    const Real s = Real{positions.s(of, i)} - positions.s(of, j);
    const Real t = Real{positions.t(of, i)} - positions.t(of, j);
    return std::exp(-std::hypot(s, t) / Real{0.7}) + (i == j ? Real{noise} : Real{0});
  };
  std::vector<std::vector<Real>> L(n, std::vector<Real>(n));
  std::vector<Real> z(n);
  for (std::size_t i = 1; i < n; ++i) {
    for (std::size_t j = 1; j <= i; ++j) {
      Real sum = k(i, j) - k(i, 0) - k(0, j) + k(0, 0);
      for (std::size_t m = 1; m < j; ++m) sum -= L[i][m] * L[j][m];
      L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
    Real rest = Real{values[i]} - values[0];
    for (std::size_t m = 1; m < i; ++m) rest -= L[i][m] * z[m];
    z[i] = rest / L[i][i];
  }
  return z;
}

TEST(KrigingRefiner, FindsTheInnovationsOfDenseKriging) {
  const NodePositions positions(3, 0.3);
  oracle::Random random(5);
  for (const double noise : {KrigingRefiner::noise_of_detail, KrigingRefiner::noise_of_estimates}) {
    const KrigingRefiner refiner(positions, {1}, noise);
    for (const std::size_t of : {0u, 3u, 11u, 21u}) {
      std::vector<float> values(289);
      for (float& value : values) value = 5 + random.value();
      const std::vector<Real> wanted = dense_innovations(positions, of, noise, values);
      detail::AlignedVector<float> z(296);
      for (std::size_t i = 1; i < values.size(); ++i) {
        const float predicted = refiner.prediction(of, i, z.data());
        z[i] = refiner.innovation(of, i, z.data(), values[i] - values[0]);
        ASSERT_NEAR(z[i], static_cast<float>(wanted[i]), 2e-5f * (1 + std::abs(z[i]))) << i;
        const float pivot = refiner.list(of).row(i).inverse_pivot;
        ASSERT_NEAR(values[i] - values[0], predicted + z[i] / pivot, 1e-5) << i;
      }
    }
  }
}

TEST(KrigingRefiner, EstimatesTheScaleOfTheProcess) {
  const NodePositions positions(3, 0.3);
  const KrigingRefiner refiner(positions, {1});
  oracle::Random random(7);
  std::normal_distribution<float> normal(0, 3);
  // Innovations are what they are made of.
  double squares = 0;
  detail::AlignedVector<float> z(88), of_values(88);
  for (std::size_t i = 1; i < 81; ++i) {
    z[i] = normal(random.engine());
    const float value =
        refiner.prediction(0, i, z.data()) + z[i] / refiner.list(0).row(i).inverse_pivot;
    of_values[i] = refiner.innovation(0, i, of_values.data(), value);
    squares += double{of_values[i]} * double{of_values[i]};
  }
  EXPECT_NEAR(KrigingRefiner::scale(squares, 81, 9), 9, 9 * 4 * std::sqrt(2.0 / 80));
  EXPECT_EQ(KrigingRefiner::scale(0, 1, 5), 5);
  EXPECT_DOUBLE_EQ(KrigingRefiner::scale(6, 5, 3), (6 + 8 * 3) / 12.0);
}

TEST(KrigingRefiner, ExpectsLessErrorWithEachSample) {
  const NodePositions positions(3, 0.3);
  const KrigingRefiner refiner(positions, {1});
  for (std::size_t of = 0; of < positions.classes(); ++of) {
    for (std::size_t n = 2; n <= 81; ++n) {
      EXPECT_LE(refiner.variance(of, n), refiner.variance(of, n - 1)) << of << " " << n;
    }
    EXPECT_LT(refiner.variance(of, 81), 0.1f * refiner.variance(of, 4));
    EXPECT_GT(refiner.variance(of, 81), 0);
  }
  EXPECT_THROW(KrigingRefiner(positions, {1}, -1), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
