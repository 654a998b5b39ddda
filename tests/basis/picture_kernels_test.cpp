// SPDX-License-Identifier: MIT
// The kernels that hold pixels within what samples have shown, each version against its definition.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/kernels.h"
#include "support/kernel_cases.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using detail::AlignedBlock;
using detail::Kernels;
using detail::PaddedBlock;

class PictureKernels : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    version_ = kernel_cases::find(GetParam());
    if (version_ == nullptr) GTEST_SKIP() << "this processor, or this build, has no " << GetParam();
  }

  const Kernels* version_ = nullptr;
};

INSTANTIATE_TEST_SUITE_P(Kernels, PictureKernels, testing::Values("plain", "avx2", "avx512"),
                         [](const auto& version) { return std::string(version.param); });

/// Means of some pixels, many of them equal, and pixels near them.
struct Values {
  explicit Values(unsigned seed) {
    oracle::Random random(seed);
    const std::size_t levels = 1 + random.below(20), missing = random.below(10);
    for (std::size_t i = 0; i < max_terms; ++i) {
      known[i] = random.below(10) >= missing;
      shares[i] = known[i] ? static_cast<float>(random.uniform(0.1, 2)) : 0;
      sums[i] = static_cast<float>(random.below(levels)) * 0.37f - 2;
      pixels[i] = static_cast<float>(random.uniform(-3, 6));
    }
  }
  [[nodiscard]] float mean(std::size_t i) const { return sums[i] * shares[i]; }
  /// Those that are known of the 3 x 3 pixels around one, in order.
  [[nodiscard]] std::vector<float> around(std::size_t pixel) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < max_terms; ++i) {
      const auto distance = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
      if (known[i] && distance(i % 8, pixel % 8) < 2 && distance(i / 8, pixel / 8) < 2) {
        values.push_back(mean(i));
      }
    }
    std::sort(values.begin(), values.end());
    return values;
  }

  std::array<bool, max_terms> known{};
  AlignedBlock shares, sums, pixels;
};

TEST_P(PictureKernels, RangesAreThoseOfSortedValues) {
  constexpr float slack = 0.4f;
  for (unsigned seed = 0; seed < 500; ++seed) {
    const Values values(seed);
    std::vector<float> all;
    AlignedBlock counts;
    for (std::size_t i = 0; i < max_terms; ++i) {
      if (values.known[i]) all.push_back(values.mean(i));
      counts[i] = static_cast<float>(values.around(i).size());
    }
    std::sort(all.begin(), all.end());
    PaddedBlock low, high;
    version_->known_means(values.sums.data(), values.shares.data(), low, high);
    if (all.empty()) continue;
    std::array<float, 2> ends;
    version_->least_and_most(low, high, ends.data());
    ASSERT_EQ(ends[0], all.front());
    ASSERT_EQ(ends[1], all.back());
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
      ASSERT_EQ(version_->value_of_rank(low, rank, ends[0], ends[1]), all[rank]) << rank;
    }

    AlignedBlock least, most, pixels = values.pixels;
    const bool outside =
        version_->extremes_around(low, high, pixels.data(), least.data(), most.data());
    const std::array<float, 2> whole = {-1.5f, 2.5f};
    version_->clamp_around(low, least.data(), most.data(), counts.data(), slack, whole.data(),
                           pixels.data());
    bool expected_outside = false;
    for (std::size_t i = 0; i < max_terms; ++i) {
      const std::vector<float> around = values.around(i);
      const float pixel = values.pixels[i];
      if (!around.empty()) {
        ASSERT_EQ(least[i], around.front());
        ASSERT_EQ(most[i], around.back());
      }
      float from = whole[0], to = whole[1];
      if (around.size() >= 4) {
        const float median = around[around.size() / 2];
        from = around.front() - slack * (median - around.front());
        to = around.back() + slack * (around.back() - median);
      }
      const bool inside = !around.empty() && pixel >= around.front() && pixel <= around.back();
      expected_outside = expected_outside || !inside;
      ASSERT_EQ(pixels[i], inside ? pixel : std::clamp(pixel, from, to)) << "pixel " << i;
    }
    ASSERT_EQ(outside, expected_outside);
  }
}

TEST_P(PictureKernels, TermsShrinkAndMeansCount) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    oracle::Random random(seed);
    AlignedBlock coefficients, filter, variances, means, weights, pixels, out;
    for (std::size_t i = 0; i < max_terms; ++i) {
      coefficients[i] = random.below(5) == 0 ? 0 : random.value();
      filter[i] = random.value();
      variances[i] = static_cast<float>(random.uniform(0, 2));
      means[i] = random.value();
      weights[i] = random.below(3) == 0 ? 0 : static_cast<float>(random.uniform(0, 3));
      pixels[i] = random.value();
    }
    const float scale = 0.1f, doubt = random.below(2) == 0 ? 0.0f : 0.5f;
    version_->shrink_terms(coefficients.data(), filter.data(), variances.data(), scale, out.data());
    for (std::size_t i = 0; i < max_terms; ++i) {
      const float square = coefficients[i] * coefficients[i], error = scale * variances[i];
      const float share = square > error ? 1 - error / square : 0;
      ASSERT_EQ(out[i], coefficients[i] * filter[i] * share);
    }
    AlignedBlock more = pixels;
    version_->add_means(means.data(), weights.data(), doubt, more.data());
    for (std::size_t i = 0; i < max_terms; ++i) {
      const float added = weights[i] > 0 ? means[i] * weights[i] / (weights[i] + doubt) : 0;
      ASSERT_EQ(more[i], weights[i] > 0 ? pixels[i] + added : pixels[i]);
    }
  }
}

TEST_P(PictureKernels, FlatPixelsAreHeld) {
  constexpr std::size_t side = block_size + 2;
  constexpr float unknown = PaddedBlock::none, alike = 0.05f, off = 0.3f;
  for (unsigned seed = 0; seed < 300; ++seed) {
    oracle::Random random(seed);
    const std::size_t levels = 1 + random.below(3), missing = random.below(4);
    std::array<float, side * side> means;
    for (float& mean : means) {
      mean = random.below(10) < missing ? unknown
                                        : static_cast<float>(random.below(levels)) +
                                              static_cast<float>(random.uniform(0, 0.06));
    }
    AlignedBlock pixels;
    for (float& pixel : pixels) pixel = static_cast<float>(random.uniform(-1, 3));
    // Not on any border in memory.
    std::array<float, max_terms + 1> memory{};
    float* const held = memory.data() + 1;
    std::copy(pixels.begin(), pixels.end(), held);
    version_->hold_flat(means.data(), side, alike, off, held);
    for (std::size_t i = 0; i < max_terms; ++i) {
      const std::size_t middle = (i / 8 + 1) * side + i % 8 + 1;
      const float own = means[middle];
      float low = own, high = own, expected = pixels[i];
      int count = 0;
      for (const std::size_t row : {middle - side, middle, middle + side}) {
        for (std::size_t at = row - 1; at <= row + 1; ++at) {
          if (!(std::abs(means[at] - own) <= alike)) continue;
          low = std::min(low, means[at]);
          high = std::max(high, means[at]);
          ++count;
        }
      }
      const float clamped = std::clamp(expected, low, high);
      const bool near = std::abs(expected - clamped) <= off;
      if (own != unknown && count >= 3 && (count == 9 || near)) expected = clamped;
      ASSERT_EQ(held[i], expected) << "pixel " << i;
    }
  }
}

TEST_P(PictureKernels, ResidualsOfAnyNumberOfAmplitudes) {
  for (std::size_t used = 0; used <= max_terms; ++used) {
    oracle::Random random(static_cast<unsigned>(used));
    detail::AlignedVector<float> matrix(max_terms * max_terms);
    for (float& value : matrix) value = random.value();
    AlignedBlock amplitudes{}, shares, found;
    std::array<float, max_terms + 1> sums;  // those from the second on
    for (std::size_t i = 0; i < used; ++i) amplitudes[i] = random.value();
    for (float& share : shares) share = random.value();
    for (float& sum : sums) sum = random.value();
    version_->residual_means(matrix.data(), amplitudes.data(), sums.data() + 1, shares.data(),
                             found.data());
    for (std::size_t j = 0; j < max_terms; ++j) {
      double rest = double{sums[j + 1]};
      for (std::size_t i = 0; i < max_terms; ++i) {
        rest -= double{matrix[j * max_terms + i]} * double{amplitudes[i]};
      }
      ASSERT_NEAR(double{found[j]}, rest * double{shares[j]}, 1e-5) << used << ", row " << j;
    }
  }
}

TEST_P(PictureKernels, TransformsToTheBitsOfThePlainOne) {
  AlignedBlock unit{}, found, expected;
  detail::AlignedArray<double, max_terms> cosines, scales;
  oracle::Random random(5);
  for (std::size_t i = 0; i < max_terms; ++i) {
    cosines[i] = random.uniform(-1, 1);
    scales[i] = random.uniform(0, 1);
  }
  for (int round = 0; round < 200; ++round) {
    for (float& value : unit) value = random.value();
    version_->forward_transform(unit.data(), cosines.data(), scales.data(), found.data());
    kernel_cases::plain().forward_transform(unit.data(), cosines.data(), scales.data(),
                                            expected.data());
    for (std::size_t i = 0; i < max_terms; ++i) {
      double sum = 0;
      for (std::size_t y = 0; y < block_size; ++y) {
        for (std::size_t x = 0; x < block_size; ++x) {
          sum += double{unit[y * 8 + x]} * cosines[x * 8 + i % 8] * cosines[y * 8 + i / 8];
        }
      }
      ASSERT_NEAR(double{found[i]}, scales[i] * sum, 1e-5);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(found[i]), std::bit_cast<std::uint32_t>(expected[i]));
    }
  }
}

TEST_P(PictureKernels, SolveFourSystemsAtOnce) {
  constexpr std::size_t lanes = 4, sides = 3;
  oracle::Random random(8);
  for (std::size_t n = 1; n <= 14; ++n) {
    // Of the third system the last pivot is below zero.
    detail::AlignedVector<double> matrix(n * n * lanes), right(n * sides * lanes);
    for (std::size_t k = 0; k < lanes; ++k) {
      std::vector<double> root(n * n);
      for (double& value : root) value = random.uniform(-1, 1);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          double sum = i == j ? 0.5 : 0;
          for (std::size_t m = 0; m < n; ++m) sum += root[i * n + m] * root[j * n + m];
          if (k == 2 && i == j && i + 1 == n) sum = -1;
          matrix[(i * n + j) * lanes + k] = sum;
        }
      }
    }
    for (double& value : right) value = random.uniform(-1, 1);
    detail::AlignedVector<double> factors = matrix, found = right;
    detail::AlignedArray<double, lanes> definite;
    version_->solve_four(factors.data(), found.data(), n, sides, definite.data());
    for (std::size_t k = 0; k < lanes; ++k) {
      ASSERT_EQ(definite[k], k == 2 ? 0 : 1) << n;
      if (k == 2) continue;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < sides; ++c) {
          double sum = 0;
          for (std::size_t j = 0; j < n; ++j) {
            sum += matrix[(i * n + j) * lanes + k] * found[(j * sides + c) * lanes + k];
          }
          ASSERT_NEAR(sum, right[(i * sides + c) * lanes + k], 1e-10) << n;
        }
      }
    }
    detail::AlignedVector<double> plain = right;
    factors = matrix;
    kernel_cases::plain().solve_four(factors.data(), plain.data(), n, sides, definite.data());
    ASSERT_TRUE(found == plain) << n;
  }
}

TEST_P(PictureKernels, AddScaledNumbersAnywhere) {
  oracle::Random random(4);
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<double> values(count + 2), sums(count + 2);
    for (double& value : values) value = random.uniform(-1, 1);
    for (double& value : sums) value = random.uniform(-1, 1);
    std::vector<double> expected = sums;
    for (std::size_t i = 1; i <= count; ++i) {
      volatile double product = 0.3 * values[i];
      expected[i] += product;
    }
    version_->add_scaled(values.data() + 1, 0.3, count, sums.data() + 1);
    ASSERT_EQ(sums, expected) << count;
  }
}

}  // namespace
}  // namespace freqsynth
