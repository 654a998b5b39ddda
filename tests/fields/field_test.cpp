// SPDX-License-Identifier: MIT
// The closed forms of benchmarks/field_cases against sums over many points.

#include "field_cases/field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "field_cases/members.h"
#include "field_cases/named_fields.h"

namespace {

using field_cases::Field;

// The mean of points^2 regular points in a pixel. A prime number keeps them from falling in step
// with fences of k / 16 pixels.
double mean_of_points(const Field& field, double i, double j) {
  constexpr int points = 127;
  double sum = 0;
  for (int b = 0; b < points; ++b) {
    for (int a = 0; a < points; ++a)
      sum += field.value(i + (a + 0.5) / points, j + (b + 0.5) / points);
  }
  return sum / (points * points);
}

// Compares every pixel that a stride hits. An edge along a row of points is off by up to half a
// row, 1/254; the fields of these tests have a few of them in a pixel, but not all off to one side.
void expect_right(const Field& field, double tolerance, std::size_t stride = 13) {
  for (std::size_t k = 0; k < field.width * field.height; k += stride) {
    const auto i = static_cast<double>(k % field.width);
    const auto j = static_cast<double>(k / field.width);
    ASSERT_NEAR(field.average(i, j), mean_of_points(field, i, j), tolerance)
        << field.name << ": pixel " << i << ", " << j;
  }
}

TEST(Field, StepsAverageAcrossPeriods) {
  const field_cases::Steps once = field_cases::between(1.25, 3.5, 2);
  EXPECT_DOUBLE_EQ(once.average(1, 2), 1.5);
  EXPECT_DOUBLE_EQ(once.average(0, 8), 4.5 / 8);
  EXPECT_DOUBLE_EQ(once.average(4, 5), 0);
  const field_cases::Steps fence{-0.3, 0.6, 9, 0, 1};
  EXPECT_DOUBLE_EQ(fence.average(-0.3, 8.7), 1 - 0.6 / 9);
  EXPECT_NEAR(fence.average(0, 1), 0.7, 1e-12);
  EXPECT_NEAR(fence.average(17, 18), 0.7, 1e-12);
  EXPECT_NEAR(fence.average(8, 9), 0.7, 1e-12);
}

TEST(Field, NamedOnesAreTheMeansOfTheirPoints) {
  expect_right(field_cases::rectangle_and_line(0), 1e-9);
  expect_right(field_cases::rectangle_and_line(0.4), 0.01);
  expect_right(field_cases::text_stems(0.37), 0.01);
  expect_right(field_cases::checker_field("checker", 64, 64, 8, 0, 0), 1e-9);
  expect_right(field_cases::checker_field("checker", 64, 64, 5.3, 0.2, 1.7), 0.02);
  expect_right(field_cases::fence(0.25), 0.01, 97);
  expect_right(field_cases::ramp_and_busy_corner(), 0.01, 1009);
}

TEST(Field, SlantedOnesAreTheMeansOfTheirPoints) {
  const Field dark = field_cases::product_field("dark", 32, 32, 0, {});
  expect_right(plus(dark, 1, field_cases::HalfPlane{0.6, -0.8, 3}), 0.01);
  expect_right(plus(dark, 1, field_cases::Disc{15.3, 16.1, 9.7}), 0.01, 3);
  expect_right(plus(dark, 1, field_cases::BarGrating{0.31, -0.17, 0.4, 0.3}), 0.01);
  expect_right(plus(dark, 1, field_cases::BarGrating{-1.9, 0.08, -7, 0.6}), 0.01);
  expect_right(plus(dark, 1, field_cases::SineGrating{1.3, -0.4, 2}), 1e-4);
}

using Family = std::function<Field(std::uint64_t, std::uint64_t)>;

TEST(Members, AreTheMeansOfTheirPoints) {
  const std::vector<Family> families{field_cases::random_rectangles, field_cases::random_lines,
                                     field_cases::random_stems,      field_cases::random_checker,
                                     field_cases::random_fence,      field_cases::random_function,
                                     field_cases::random_narrow,     field_cases::random_dark_half};
  for (const Family& family : families) {
    for (std::uint64_t number = 1; number <= 4; ++number)
      expect_right(family(5, number), 0.03, 131);
  }
  for (int busy = 0; busy <= 4; ++busy) {
    expect_right(field_cases::random_disc(5, 1, 1.2, busy).field, 0.02, 131);
  }
  expect_right(field_cases::random_lamp(5, 1).field(),
               0.01 * field_cases::random_lamp(5, 1).radiance, 131);
}

TEST(Members, DifferByNumberAndBySeedAlone) {
  const auto at = [](std::uint64_t seed, std::uint64_t number) {
    return field_cases::random_function(seed, number).value(20.3, 41.7);
  };
  EXPECT_EQ(at(3, 5), at(3, 5));
  EXPECT_NE(at(3, 5), at(3, 6));
  EXPECT_NE(at(3, 5), at(4, 5));
}

TEST(Members, DrawTheSameNumbersOnEveryMachine) {
  field_cases::Draw draw(0, 0);
  std::mt19937_64 generator(1);
  EXPECT_EQ(draw.real(0, 1), static_cast<double>(generator() >> 11) * 0x1p-53);
  EXPECT_EQ(draw.whole(3, 9), 3 + static_cast<int>(generator() % 7));
  EXPECT_EQ(draw.coin(), (generator() >> 63) != 0);
}

TEST(Members, BadPlacesAreAsManyAsWereAsked) {
  for (const double share : {0.05, 0.5}) {
    int bad = 0;
    for (int k = 0; k < 10000; ++k) {
      bad += field_cases::is_bad_place((k % 100) / 4.0, (k / 100) / 8.0, share);
    }
    EXPECT_NEAR(bad / 10000.0, share, 0.02);
  }
}

}  // namespace
