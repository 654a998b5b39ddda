// SPDX-License-Identifier: MIT
// Exponentials and cosines of many numbers are those of one, in all versions that this processor
// can run.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "freqsynth/basis/covariance.h"
#include "freqsynth/basis/kernels.h"
#include "support/oracles.h"

namespace freqsynth::detail {
namespace {

using Function = void (*)(const double*, std::size_t, double*);

/// Values of each version, for all counts up to 40 and from everywhere in a register, are those of
/// `one` to the bit; and nothing is written behind them.
void expect_values_of(double (*one)(double), Function Kernels::*many,
                      const std::vector<double>& numbers) {
  std::vector<double> expected(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) expected[i] = one(numbers[i]);
  for (const Kernels* version : runnable_kernels()) {
    std::vector<double> values(numbers.size() + 1, 7);
    (version->*many)(numbers.data(), numbers.size(), values.data());
    EXPECT_EQ(std::memcmp(values.data(), expected.data(), expected.size() * sizeof(double)), 0)
        << version->name;
    EXPECT_EQ(values.back(), 7) << version->name;
    for (std::size_t count = 0; count <= 40; ++count) {
      std::vector<double> some(numbers.begin() + 3, numbers.begin() + 44);
      (version->*many)(some.data(), count, some.data());
      for (std::size_t i = 0; i < some.size(); ++i) {
        EXPECT_EQ(some[i], i < count ? expected[i + 3] : numbers[i + 3]) << version->name;
      }
    }
  }
}

TEST(FunctionKernels, ExponentialsAreThoseOfOneNumber) {
  std::vector<double> numbers = {0,
                                 1e-300,
                                 0.5 * std::numbers::ln2,
                                 std::numbers::ln2,
                                 699.999,
                                 700,
                                 701,
                                 1e300,
                                 std::numeric_limits<double>::infinity()};
  oracle::Random random(3);
  for (int i = 0; i < 20000; ++i) numbers.push_back(std::abs(double{random.value()}) * (i % 700));
  expect_values_of(&exp_minus, &Kernels::exponentials, numbers);
}

TEST(FunctionKernels, CosinesAreThoseOfOneNumber) {
  std::vector<double> numbers = {0, 0.25, -0.25, 0.5, -0.5, 0.75, 1, -1, 1e9, -1e9};
  oracle::Random random(4);
  for (int i = 0; i < 20000; ++i) numbers.push_back(double{random.value()} * (i % 300));
  expect_values_of(&cos_turns, &Kernels::cosines, numbers);
}

TEST(FunctionKernels, FluxDensitiesAreIntegralsOverDiscs) {
  std::vector<double> distances;
  for (double q = 0.001; q < 30; q *= 1.07) distances.push_back(q);
  for (const bool rough : {true, false}) {
    // Of exp(-q), or (1 + q) exp(-q), times q, integrated: the coefficients of q^(k + 2).
    double series[flux_series], factorial = 1;
    for (std::size_t k = 0; k < flux_series; ++k) {
      const auto order = static_cast<double>(k);
      if (k > 0) factorial *= -order;
      series[k] = (rough ? 1 : 1 - order) / (factorial * (order + 2));
    }
    std::vector<double> first;
    for (const Kernels* version : runnable_kernels()) {
      std::vector<double> densities(distances.size() + 1, 7);
      version->flux_densities(distances.data(), distances.size(), series, rough, densities.data());
      EXPECT_EQ(densities.back(), 7) << version->name;
      for (std::size_t i = 0; i < distances.size(); ++i) {
        // Simpson's rule.
        constexpr int steps = 2000;
        long double sum = 0;
        for (int step = 0; step <= steps; ++step) {
          const long double x = static_cast<long double>(distances[i]) * step / steps;
          const long double value = x * std::exp(-x) * (rough ? 1 : 1 + x);
          sum += value * (step == 0 || step == steps ? 1 : step % 2 == 0 ? 2 : 4);
        }
        const long double expected = sum / (3.0L * steps * static_cast<long double>(distances[i]));
        EXPECT_NEAR(densities[i] / static_cast<double>(expected), 1, 1e-9) << distances[i];
      }
      if (first.empty()) first = densities;
      EXPECT_EQ(densities, first) << version->name;
    }
  }
}

TEST(FunctionKernels, FluxDensitiesAreThoseOfTheirFormula) {
  std::vector<double> series(flux_series), distances = {0, 1e-9, 0.699999, 0.7, 1, 699, 701, 1e9};
  for (std::size_t k = 0; k < flux_series; ++k) {
    series[k] = 1 / static_cast<double>(k + 2) - 0.125 * static_cast<double>(k % 3);
  }
  oracle::Random random(5);
  for (int i = 0; i < 1001; ++i) distances.push_back(std::abs(double{random.value()}) * (i % 40));
  for (const bool rough : {false, true}) {
    for (const Kernels* version : runnable_kernels()) {
      std::vector<double> densities(distances.size() + 1, 7);
      version->flux_densities(distances.data(), distances.size(), series.data(), rough,
                              densities.data());
      for (std::size_t i = 0; i < distances.size(); ++i) {
        const double q = distances[i], left = exp_minus(q);
        double expected = 0;
        if (q < 0.7) {
          for (std::size_t k = flux_series; k-- > 0;) expected = expected * q + series[k];
        } else {
          expected =
              rough ? (1 - (1 + q) * left) / (q * q) : (3 - (q * q + 3 * q + 3) * left) / (q * q);
        }
        EXPECT_EQ(densities[i], expected) << version->name << ", " << q;
      }
      EXPECT_EQ(densities.back(), 7) << version->name;
    }
  }
}

}  // namespace
}  // namespace freqsynth::detail
