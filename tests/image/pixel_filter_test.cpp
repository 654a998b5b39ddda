// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/image/axis_weights.h"
#include "freqsynth/image/filter_kernel.h"
#include "support/filter_oracle.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Case {
  PixelFilter filter;
  PixelFilterShape shape;
};

const std::vector<Case> cases = {{PixelFilter::box, {}},
                                 {PixelFilter::box, {.radius = 1.25}},
                                 {PixelFilter::tent, {}},
                                 {PixelFilter::tent, {.radius = 2.7}},
                                 {PixelFilter::gaussian, {}},
                                 {PixelFilter::gaussian, {.radius = 2, .sigma = 0.8}},
                                 {PixelFilter::gaussian, {.radius = 3, .sigma = 0.05}},
                                 {PixelFilter::gaussian, {.radius = 1, .sigma = 1000}},
                                 {PixelFilter::blackman_harris, {}},
                                 {PixelFilter::blackman_harris, {.radius = 0.75}},
                                 {PixelFilter::mitchell, {}},
                                 {PixelFilter::mitchell, {.radius = 1.5, .b = 1, .c = 0}},
                                 {PixelFilter::mitchell, {.b = 0, .c = 1}}};

TEST(PixelFilter, IntegralsAreThoseOfTheDefinition) {
  oracle::Random random(5);
  for (const Case& one : cases) {
    const detail::FilterKernel kernel(one.filter, one.shape);
    const auto radius = static_cast<Real>(kernel.radius());
    const auto whole = oracle::filter_integral(one.filter, one.shape, -radius, radius, 0, 0);
    for (int k = 0; k < 8; ++k) {
      // Blocks of 0.4 to 800 pixels of the output.
      const double omega = std::pow(10, random.uniform(-2, 1.3)) * std::numbers::pi / 8;
      const double phase = random.uniform(-10, 10);
      const double begin = k % 3 == 0 ? -10 : random.uniform(-3, 3);
      const double end = k % 4 == 0 ? 10 : begin + random.uniform(0, 3);
      std::array<double, block_size> sums{};
      kernel.integrate(begin, end, omega, phase, sums);
      for (std::size_t u = 0; u < block_size; ++u) {
        const auto frequency = static_cast<Real>(u);
        const Real expected = oracle::filter_integral(one.filter, one.shape, begin, end,
                                                      frequency * static_cast<Real>(omega),
                                                      frequency * static_cast<Real>(phase));
        ASSERT_NEAR(sums[u] / static_cast<double>(whole), static_cast<double>(expected / whole),
                    1e-13)
            << "filter " << static_cast<int>(one.filter) << ", u " << u << ", omega " << omega
            << ", " << begin << " .. " << end;
      }
    }
  }
}

TEST(PixelFilter, AddsToWhatIsThere) {
  const detail::FilterKernel kernel(PixelFilter::tent, {});
  std::array<double, block_size> sums;
  sums.fill(3);
  kernel.integrate(-5, 0, 0, 0, sums);
  for (const double sum : sums) EXPECT_NEAR(sum, 3.5, 1e-15);
  kernel.integrate(1, 2, 0, 0, sums);
  kernel.integrate(2, 1, 0, 0, sums);
  for (const double sum : sums) EXPECT_NEAR(sum, 3.5, 1e-15) << "nothing beyond the radius";
}

TEST(PixelFilter, WeightsOfAPixelAreOneAltogether) {
  for (const Case& one : cases) {
    for (const std::size_t size : {1u, 7u, 8u, 20u, 64u}) {
      for (const std::size_t out : {1u, 3u, 8u, 20u, 64u, 150u}) {
        const auto axis =
            detail::make_axis(size, out, one.filter, one.shape, detail::WeightOrder::by_pixel);
        std::vector<double> sums(out);
        for (const detail::AxisBlock& block : axis) {
          ASSERT_LE(block.first + block.count, out);
          for (std::size_t i = 0; i < block.count; ++i) {
            sums[block.first + i] += double{block.weights[i * block_size]};
          }
        }
        for (const double sum : sums) {
          ASSERT_NEAR(sum, 1, 3 * oracle::float_rounding) << size << " to " << out;
        }
      }
    }
  }
}

TEST(PixelFilter, PixelsAreBegunOnceAndInOrder) {
  for (const Case& one : cases) {
    for (const std::size_t size : {1u, 20u, 64u}) {
      for (const std::size_t out : {1u, 3u, 20u, 64u, 150u}) {
        const auto axis =
            detail::make_axis(size, out, one.filter, one.shape, detail::WeightOrder::by_frequency);
        std::size_t next = 0;
        for (const detail::AxisBlock& block : axis) {
          EXPECT_EQ(block.weights.size(), block_size * detail::padded(block.count));
          EXPECT_EQ(block.first + block.begun, std::min(next, block.first + block.count));
          next = std::max(next, block.first + block.count);
        }
        EXPECT_EQ(next, out);
      }
    }
  }
}

TEST(PixelFilter, RefusesByName) {
  const auto refused = [](PixelFilter filter, const PixelFilterShape& shape, const char* what) {
    EXPECT_THAT([&] { shape.validate(filter); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(what)));
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  refused(PixelFilter::tent, {.radius = -1}, "filter_shape.radius is -1, not 0 or over 0");
  refused(PixelFilter::tent, {.radius = nan}, "filter_shape.radius is nan");
  refused(PixelFilter::tent, {.radius = 32.5}, "filter_shape.radius is 32.5");
  refused(PixelFilter::gaussian, {.sigma = 0}, "filter_shape.sigma is 0, not in 0.05..1000");
  refused(PixelFilter::gaussian, {.sigma = nan}, "filter_shape.sigma is nan");
  refused(PixelFilter::mitchell, {.b = 1.5}, "filter_shape.b is 1.5, not in 0..1");
  refused(PixelFilter::mitchell, {.c = -0.5}, "filter_shape.c is -0.5, not in 0..1");
  refused(static_cast<PixelFilter>(9), {}, "pixel_filter is 9, not none, box, tent");
}

}  // namespace
}  // namespace freqsynth
