// SPDX-License-Identifier: MIT
// The kernels for many blocks at once, in all versions that this processor can run.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/kernels.h"
#include "support/oracles.h"

namespace freqsynth::detail {
namespace {

constexpr std::size_t rows = 60;

AlignedVector<float> random_values(std::size_t count, unsigned seed) {
  oracle::Random random(seed);
  AlignedVector<float> values(count);
  for (float& value : values) value = random.value();
  return values;
}

AlignedVector<float> innovate(const Kernels& version) {
  const auto factor = random_values(rows, 1), values = random_values(rows * lane_count, 2);
  AlignedVector<float> z(rows * lane_count);
  for (std::size_t i = 0; i < rows; ++i) {
    version.innovate_lanes(factor.data(), i, 0.3f, values.data() + i * lane_count, z.data());
  }
  return z;
}

AlignedVector<float> add(const Kernels& version, std::size_t count) {
  auto sums = random_values((count + 1) * lane_count, 3);
  version.add_lanes(random_values(count, 4).data(), count, random_values(lane_count, 5).data(),
                    sums.data());
  return sums;
}

TEST(LaneKernels, InnovationsAreWhatIsLeftOfEachLane) {
  const auto factor = random_values(rows, 1), values = random_values(rows * lane_count, 2);
  const auto z = innovate(*runnable_kernels().front());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    for (std::size_t i = 0; i < rows; ++i) {
      double left = double{values[i * lane_count + lane]};
      for (std::size_t j = 0; j < i; ++j)
        left -= double{factor[j]} * double{z[j * lane_count + lane]};
      ASSERT_NEAR(z[i * lane_count + lane], 0.3 * left, 4e-6) << i;
    }
  }
}

TEST(LaneKernels, SumsGrowByTheWeightedValuesAndNoOthers) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{7}, std::size_t{64}, std::size_t{144}}) {
    const auto before = random_values((count + 1) * lane_count, 3);
    const auto weights = random_values(count, 4), values = random_values(lane_count, 5);
    const auto sums = add(*runnable_kernels().front(), count);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t p = i / lane_count;
      const double added = p < count ? double{weights[p]} * double{values[i % lane_count]} : 0;
      ASSERT_NEAR(sums[i], double{before[i]} + added, 2e-7);
    }
  }
}

TEST(LaneKernels, AllVersionsGiveTheSameBits) {
  const auto same = [](const AlignedVector<float>& a, const AlignedVector<float>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
  };
  const Kernels& plain = *runnable_kernels().front();
  for (const Kernels* version : runnable_kernels()) {
    EXPECT_TRUE(same(innovate(*version), innovate(plain))) << version->name;
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{7}, std::size_t{64}, std::size_t{144}}) {
      EXPECT_TRUE(same(add(*version, count), add(plain, count))) << version->name;
    }
  }
}

}  // namespace
}  // namespace freqsynth::detail
