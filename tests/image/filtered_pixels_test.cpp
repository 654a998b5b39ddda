// SPDX-License-Identifier: MIT
// Pictures with filters wider than a pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "support/filter_oracle.h"
#include "support/image_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;

constexpr PixelFilter wide[] = {PixelFilter::tent, PixelFilter::gaussian,
                                PixelFilter::blackman_harris, PixelFilter::mitchell};

ReconstructionSettings with(PixelFilter filter, const PixelFilterShape& shape = {}) {
  return {.butterworth = {.enabled = false}, .pixel_filter = filter, .filter_shape = shape};
}

/// Of each pixel of an axis the weights of the cosines of each block, from the definition.
std::vector<Real> axis_weights(std::size_t size, std::size_t out, PixelFilter filter,
                               const PixelFilterShape& shape) {
  const std::size_t blocks = (size + 7) / 8;
  const auto scale = static_cast<Real>(out) / static_cast<Real>(size);
  std::vector<Real> weights(out * blocks * 8);
  for (std::size_t i = 0; i < out; ++i) {
    const Real centre = static_cast<Real>(i) + 0.5L;
    const Real r = oracle::filter_radius(filter, shape);
    const Real inside = oracle::filter_integral(filter, shape, std::max(-r, -centre),
                                                std::min(r, static_cast<Real>(out) - centre), 0, 0);
    for (std::size_t b = 0; b < blocks; ++b) {
      const Real begin = static_cast<Real>(8 * b) * scale;
      const Real end = static_cast<Real>(std::min(8 * b + 8, size)) * scale;
      for (std::size_t u = 0; u < 8; ++u) {
        const Real omega = oracle::pi * static_cast<Real>(u) / (end - begin);
        weights[(i * blocks + b) * 8 + u] =
            oracle::filter_integral(filter, shape, begin - centre, end - centre, omega,
                                    omega * (centre - begin)) /
            inside;
      }
    }
  }
  return weights;
}

/// Pixels from the definition: channel 0.
std::vector<Real> slow_pixels(const FrequencyImage& image, std::size_t width, std::size_t height,
                              PixelFilter filter, const PixelFilterShape& shape) {
  const auto columns = axis_weights(image.width(), width, filter, shape);
  const auto rows = axis_weights(image.height(), height, filter, shape);
  std::vector<Real> pixels(width * height);
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    for (std::size_t by = 0; by < image.blocks_y(); ++by) {
      for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
        const Real* const column = &columns[(p % width * image.blocks_x() + bx) * 8];
        const Real* const row = &rows[(p / width * image.blocks_y() + by) * 8];
        for (std::size_t i = 0; i < max_terms; ++i) {
          const int u = oracle::horizontal(i), v = oracle::vertical(i);
          pixels[p] += oracle::amplitude(i) * static_cast<Real>(image.coefficients(bx, by, 0)[i]) *
                       column[u] * row[v];
        }
      }
    }
  }
  return pixels;
}

struct Size {
  std::size_t width, height, out_width, out_height;
};
constexpr Size sizes[] = {{24, 16, 24, 16}, {20, 13, 20, 13}, {20, 13, 7, 5}, {17, 9, 40, 23},
                          {33, 10, 2, 1},   {1, 1, 1, 1},     {1, 9, 3, 9}};

TEST(FilteredPixels, OfAFunctionAreThoseOfTheDefinition) {
  for (const Size& size : sizes) {
    const auto image = helpers::random_image(size.width, size.height, 2,
                                             CoefficientMeaning::point_function, 8, 0.2f);
    for (const PixelFilter filter : wide) {
      for (const double radius : {0.0, 0.4, 3.0}) {
        const PixelFilterShape shape{.radius = radius};
        std::vector<float> pixels(size.out_width * size.out_height * 2);
        reconstruct(image, with(filter, shape), {pixels.data(), size.out_width, size.out_height});
        const auto expected = slow_pixels(image, size.out_width, size.out_height, filter, shape);
        for (std::size_t p = 0; p < expected.size(); ++p) {
          // That of the box.
          ASSERT_NEAR(pixels[2 * p], static_cast<double>(expected[p]), 20 * oracle::float_rounding)
              << "filter " << static_cast<int>(filter) << ", radius " << radius << ", pixel " << p;
        }
      }
    }
  }
}

/// Means over the pixels of channel 0, row by row.
std::vector<Real> pixel_means(const FrequencyImage& image) {
  std::vector<Real> means;
  for (std::size_t y = 0; y < image.height(); ++y) {
    for (std::size_t x = 0; x < image.width(); ++x) {
      means.push_back(static_cast<Real>(helpers::pixel_mean(image, x, y, 0)));
    }
  }
  return means;
}

/// What each of `size` averages is worth in each filtered pixel of an axis, from the definition.
std::vector<std::vector<Real>> mean_weights(std::size_t size, std::size_t out, PixelFilter filter,
                                            const PixelFilterShape& shape) {
  std::vector<std::vector<Real>> weights(out, std::vector<Real>(size));
  for (std::size_t i = 0; i < size; ++i) {
    std::vector<Real> one(size);
    one[i] = 1;
    const oracle::Histospline spline(one);
    for (std::size_t p = 0; p < out; ++p) {
      weights[p][i] = spline.filtered(p, out, filter, shape);
    }
  }
  return weights;
}

/// Finished pixels, filtered by the definition.
std::vector<Real> slow_finished(const std::vector<Real>& means, const Size& size,
                                PixelFilter filter, const PixelFilterShape& shape) {
  const auto columns = mean_weights(size.width, size.out_width, filter, shape);
  const auto rows = mean_weights(size.height, size.out_height, filter, shape);
  std::vector<Real> pixels(size.out_width * size.out_height);
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    for (std::size_t m = 0; m < means.size(); ++m) {
      pixels[p] += columns[p % size.out_width][m % size.width] *
                   rows[p / size.out_width][m / size.width] * means[m];
    }
  }
  return pixels;
}

/// Least and most of the finished pixels that pixel p of the output may show.
std::pair<Real, Real> range_of(const std::vector<Real>& means, const Size& size, Real radius,
                               std::size_t p) {
  const auto range = [&](std::size_t i, std::size_t from, std::size_t to) {
    const Real scale = static_cast<Real>(to) / static_cast<Real>(from);
    const Real centre = (static_cast<Real>(i) + 0.5L) / scale;
    const Real reach = std::max(radius / scale, Real{1});
    const auto begin =
        static_cast<std::size_t>(std::max(Real{0}, std::floor(centre - reach + 1e-9L)));
    const auto end = static_cast<std::size_t>(std::ceil(centre + reach - 1e-9L));
    return std::pair(begin, std::min(end, from));
  };
  const auto x = range(p % size.out_width, size.width, size.out_width);
  const auto y = range(p / size.out_width, size.height, size.out_height);
  std::pair<Real, Real> found = {1e30L, -1e30L};
  for (std::size_t j = y.first; j < y.second; ++j) {
    for (std::size_t i = x.first; i < x.second; ++i) {
      const Real mean = means[j * size.width + i];
      found = {std::min(found.first, mean), std::max(found.second, mean)};
    }
  }
  return found;
}

TEST(FilteredPixels, OfFinishedPixelsAreThoseOfTheDefinition) {
  std::size_t held = 0;
  for (const Size& size : sizes) {
    const auto image = helpers::random_image(size.width, size.height, 2,
                                             CoefficientMeaning::pixel_average, 8, 0.2f);
    const auto means = pixel_means(image);
    for (const PixelFilter filter : wide) {
      for (const double radius : {0.0, 0.4, 3.0}) {
        const PixelFilterShape shape{.radius = radius};
        std::vector<float> pixels(size.out_width * size.out_height * 2);
        reconstruct(image, with(filter, shape), {pixels.data(), size.out_width, size.out_height});
        const auto expected = slow_finished(means, size, filter, shape);
        for (std::size_t p = 0; p < expected.size(); ++p) {
          Real value = expected[p];
          if (filter != PixelFilter::mitchell) {
            const auto range = range_of(means, size, oracle::filter_radius(filter, shape), p);
            held += value < range.first || value > range.second;
            value = std::clamp(value, range.first, range.second);
          }
          // That of the pixels, 20, and what weights below 1e-8 are worth.
          ASSERT_NEAR(pixels[2 * p], static_cast<double>(value), 30 * oracle::float_rounding)
              << "filter " << static_cast<int>(filter) << ", radius " << radius << ", pixel " << p;
        }
      }
    }
  }
  EXPECT_GT(held, 100u) << "the ranges are tested, too";
}

TEST(FilteredPixels, ConstantsStayAsTheyAre) {
  FrequencyImage image(45, 29, 1);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      image.coefficients(x, y, 0)[0] = 8 * 0.7f;
      image.samples(x, y) = 10;
    }
  }
  for (const PixelFilter filter : wide) {
    for (const double scale : {1.0, 0.3, 2.0}) {
      for (const float pixel : reconstruct(image, with(filter), scale)) {
        // Rounded are the weights of either axis, products, and sums of up to nine blocks.
        ASSERT_NEAR(pixel, 0.7f, 0.7 * 8 * oracle::float_rounding);
      }
    }
  }
}

TEST(FilteredPixels, ConstantFinishedPixelsStayToTheBit) {
  FrequencyImage image(40, 24, 1, CoefficientMeaning::pixel_average);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) image.coefficients(x, y, 0)[0] = 8 * 0.7f;
  }
  const float pixel = reconstruct(image)[0];
  for (const PixelFilter filter : wide) {
    if (filter == PixelFilter::mitchell) continue;
    for (const double scale : {1.0, 0.3, 2.0}) {
      const auto pixels = reconstruct(image, with(filter), scale);
      EXPECT_EQ(pixels, std::vector<float>(pixels.size(), pixel));
    }
  }
}

TEST(FilteredPixels, OfAMirroredImageAreMirrored) {
  const auto image = helpers::random_image(32, 24, 1, CoefficientMeaning::point_function, 8, 0.2f);
  FrequencyImage mirrored(32, 24, 1);
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 4; ++x) {
      for (std::size_t i = 0; i < max_terms; ++i) {
        const float sign = oracle::horizontal(i) % 2 == 0 ? 1 : -1;
        mirrored.coefficients(x, y, 0)[i] = sign * image.coefficients(3 - x, y, 0)[i];
      }
    }
  }
  for (const PixelFilter filter : wide) {
    const auto a = reconstruct(image, with(filter));
    const auto b = reconstruct(mirrored, with(filter));
    for (std::size_t p = 0; p < a.size(); ++p) {
      ASSERT_NEAR(a[p], b[p / 32 * 32 + 31 - p % 32], 20 * oracle::float_rounding);
    }
  }
}

TEST(FilteredPixels, ABoxOfHalfAPixelIsTheBox) {
  const auto image = helpers::random_image(20, 13, 2, CoefficientMeaning::point_function, 8, 0.2f);
  for (const double scale : {1.0, 0.7}) {
    EXPECT_EQ(reconstruct(image, with(PixelFilter::box), scale),
              reconstruct(image, with(PixelFilter::box, {.radius = 0.5}), scale));
    // By the general way, almost of that width.
    const auto box = reconstruct(image, with(PixelFilter::box), scale);
    const auto near_box =
        reconstruct(image, with(PixelFilter::box, {.radius = 0.5 + 1e-12}), scale);
    for (std::size_t i = 0; i < box.size(); ++i) ASSERT_NEAR(box[i], near_box[i], 3e-6);
  }
}

TEST(FilteredPixels, AreNotNegativeWhereTheImageIsNot) {
  FrequencyImage image(24, 24, 2, CoefficientMeaning::pixel_average);
  for (std::size_t c = 0; c < 2; ++c) image.coefficients(1, 1, c)[0] = 8;
  image.set_non_negative(0, true);
  const auto pixels = reconstruct(image, with(PixelFilter::mitchell));
  float least[] = {0, 0}, most = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    least[i % 2] = std::min(least[i % 2], pixels[i]);
    most = std::max(most, pixels[i]);
  }
  EXPECT_EQ(least[0], 0);
  EXPECT_LT(least[1], -0.005f) << "the lobes of the filter";
  EXPECT_GT(most, 1.01f);
}

TEST(FilteredPixels, AreWrittenWithAnyStrides) {
  const auto image = helpers::random_image(20, 13, 2, CoefficientMeaning::point_function, 8, 0.2f);
  const auto expected = reconstruct(image, with(PixelFilter::gaussian));
  // Each value is written or added to, whatever was there.
  std::vector<float> planes(20 * 13 * 2, 1e30f);
  reconstruct(image, with(PixelFilter::gaussian), {planes.data(), 20, 13, 1, 20, 20 * 13});
  for (std::size_t p = 0; p < 20 * 13; ++p) {
    EXPECT_EQ(planes[p], expected[2 * p]);
    EXPECT_EQ(planes[20 * 13 + p], expected[2 * p + 1]);
  }
}

}  // namespace
}  // namespace freqsynth
