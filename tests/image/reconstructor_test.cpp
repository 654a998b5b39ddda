// SPDX-License-Identifier: MIT
#include "freqsynth/image/reconstructor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/image_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using oracle::Real;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr ButterworthSettings unfiltered{false, 0.8, 2};

ReconstructionSettings with(PixelFilter filter,
                            const ButterworthSettings& butterworth = unfiltered) {
  ReconstructionSettings settings;
  settings.butterworth = butterworth;
  settings.pixel_filter = filter;
  return settings;
}

/// Values of a few units.
FrequencyImage random_image(std::size_t width, std::size_t height, std::size_t channels,
                            CoefficientMeaning meaning = CoefficientMeaning::point_function) {
  return helpers::random_image(width, height, channels, meaning, 8, 0.2f);
}

/// The magnitudes of 64 amplitudes add up to less than 20 for such images, of which a rounding or
/// two in each term might leave 20 or 40. Measured: 16.
constexpr double tolerance = 20 * oracle::float_rounding;

/// A place on one axis of `size` pixels: the block it lies in and that block's cosines there.
struct Place {
  Place(Real at, std::size_t in_block, std::size_t size) : block(in_block) {
    const std::size_t begin = 8 * block;
    const auto length = static_cast<Real>(std::min(begin + 8, size) - begin);
    for (std::size_t k = 0; k < 8; ++k) {
      cosines[k] =
          std::cos(oracle::pi * static_cast<Real>(k) * (at - static_cast<Real>(begin)) / length);
    }
  }

  std::size_t block;
  std::array<Real, 8> cosines;
  Real weight = 1;
};

/// The filtered function, from the formulas.
class Function {
 public:
  Function(const FrequencyImage& image, const ButterworthSettings& butterworth)
      : image_(&image), amplitudes_(image.blocks_x() * image.blocks_y() * image.channels()) {
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) {
        const Real cutoff = static_cast<Real>(butterworth.cutoff) *
                            std::sqrt(static_cast<Real>(image.samples(x, y)));
        for (std::size_t c = 0; c < image.channels(); ++c) {
          for (std::size_t i = 0; i < max_terms; ++i) {
            Real& amplitude = amplitudes_[index(x, y, c)][i];
            amplitude = oracle::amplitude(i) * static_cast<Real>(image.coefficients(x, y, c)[i]);
            if (!butterworth.enabled) continue;
            const Real d = std::hypot(static_cast<Real>(oracle::horizontal(i)),
                                      static_cast<Real>(oracle::vertical(i)));
            amplitude /= 1 + std::pow(d / cutoff, 2 * static_cast<Real>(butterworth.order));
          }
        }
      }
    }
  }

  [[nodiscard]] double at(const Place& x, const Place& y, std::size_t channel) const {
    const auto& amplitudes = amplitudes_[index(x.block, y.block, channel)];
    Real sum = 0;
    for (std::size_t i = 0; i < max_terms; ++i) {
      sum += amplitudes[i] * x.cosines[static_cast<std::size_t>(oracle::horizontal(i))] *
             y.cosines[static_cast<std::size_t>(oracle::vertical(i))];
    }
    return static_cast<double>(sum);
  }

  [[nodiscard]] double at(Real x, Real y, std::size_t channel) const {
    return at(place(x, image_->width()), place(y, image_->height()), channel);
  }

 private:
  static Place place(Real at, std::size_t size) {
    return {at, std::min(static_cast<std::size_t>(at / 8), (size - 1) / 8), size};
  }
  [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t channel) const {
    return (y * image_->blocks_x() + x) * image_->channels() + channel;
  }

  const FrequencyImage* image_;
  std::vector<std::array<Real, max_terms>> amplitudes_;
};

/// Gauss-Legendre nodes for the mean over [begin, end] of an axis of `size` pixels: 5 in each piece
/// of at most an eighth of a block (the function is smooth there: the error is below 1e-7).
std::vector<Place> nodes_of(Real begin, Real end, std::size_t size) {
  constexpr Real places[] = {0, 0.538469310105683091L, 0.906179845938663993L};
  constexpr Real weights[] = {0.568888888888888889L, 0.478628670499366468L, 0.236926885056189088L};
  std::vector<Place> nodes;
  for (std::size_t block = 0; 8 * block < size; ++block) {
    const auto left = static_cast<Real>(8 * block);
    const Real eighth = (std::min(left + 8, static_cast<Real>(size)) - left) / 8;
    for (int k = 0; k < 8; ++k) {
      const Real from = std::max(begin, left + static_cast<Real>(k) * eighth);
      const Real to = std::min(end, left + static_cast<Real>(k + 1) * eighth);
      if (from >= to) continue;
      const Real middle = (from + to) / 2, half = (to - from) / 2;
      for (int node = -2; node <= 2; ++node) {
        const Real offset = static_cast<Real>(node < 0 ? -1 : 1) * places[std::abs(node)];
        nodes.emplace_back(middle + half * offset, block, size);
        nodes.back().weight = half * weights[std::abs(node)] / (end - begin);
      }
    }
  }
  return nodes;
}

struct Scaling {
  std::size_t width, height;
  double scale;
};

class AnyResolution : public testing::TestWithParam<Scaling> {};
INSTANTIATE_TEST_SUITE_P(Scales, AnyResolution,
                         testing::Values(Scaling{16, 8, 1}, Scaling{20, 13, 1}, Scaling{20, 13, 2},
                                         Scaling{20, 13, 0.5}, Scaling{23, 13, 3.0 / 7},
                                         Scaling{31, 26, 1.0 / 8}, Scaling{33, 40, 1.0 / 16},
                                         Scaling{13, 9, 2.5}, Scaling{1, 1, 1}, Scaling{1, 1, 3},
                                         Scaling{7, 9, 1}, Scaling{7, 9, 0.01}));

TEST_P(AnyResolution, BoxIsTheMeanOverThePixelsArea) {
  const auto [width, height, scale] = GetParam();
  const FrequencyImage image = random_image(width, height, 2);
  for (const ButterworthSettings& butterworth : {unfiltered, ButterworthSettings{}}) {
    const Function function(image, butterworth);
    const auto pixels = reconstruct(image, with(PixelFilter::box, butterworth), scale);
    const auto out_width = static_cast<std::size_t>(std::ceil(static_cast<double>(width) * scale));
    const auto out_height =
        static_cast<std::size_t>(std::ceil(static_cast<double>(height) * scale));
    ASSERT_EQ(pixels.size(), out_width * out_height * 2);
    const Real step_x = static_cast<Real>(width) / static_cast<Real>(out_width);
    const Real step_y = static_cast<Real>(height) / static_cast<Real>(out_height);
    for (std::size_t j = 0; j < out_height; ++j) {
      const auto rows =
          nodes_of(static_cast<Real>(j) * step_y, static_cast<Real>(j + 1) * step_y, height);
      for (std::size_t i = 0; i < out_width; ++i) {
        const auto columns =
            nodes_of(static_cast<Real>(i) * step_x, static_cast<Real>(i + 1) * step_x, width);
        const std::size_t channel = (i + j) % 2;
        Real mean = 0;
        for (const Place& row : rows) {
          for (const Place& column : columns) {
            mean +=
                row.weight * column.weight * static_cast<Real>(function.at(column, row, channel));
          }
        }
        ASSERT_NEAR(pixels[(j * out_width + i) * 2 + channel], static_cast<double>(mean), tolerance)
            << "pixel " << i << ", " << j;
      }
    }
  }
}

TEST_P(AnyResolution, NoFilterIsTheValueAtThePixelsCentre) {
  const auto [width, height, scale] = GetParam();
  const FrequencyImage image = random_image(width, height, 2);
  for (const ButterworthSettings& butterworth : {unfiltered, ButterworthSettings{}}) {
    const Function function(image, butterworth);
    const auto pixels = reconstruct(image, with(PixelFilter::none, butterworth), scale);
    const std::size_t out_width = scaled_size(width, scale);
    const std::size_t out_height = scaled_size(height, scale);
    for (std::size_t j = 0; j < out_height; ++j) {
      for (std::size_t i = 0; i < out_width; ++i) {
        const double x = (2 * static_cast<double>(i) + 1) * static_cast<double>(width) /
                         (2 * static_cast<double>(out_width));
        const double y = (2 * static_cast<double>(j) + 1) * static_cast<double>(height) /
                         (2 * static_cast<double>(out_height));
        std::array<float, 2> values;
        evaluate(image, butterworth, x, y, values);
        for (std::size_t c = 0; c < 2; ++c) {
          const float pixel = pixels[(j * out_width + i) * 2 + c];
          ASSERT_NEAR(pixel, values[c], tolerance);
          ASSERT_NEAR(pixel, function.at(x, y, c), tolerance);
        }
      }
    }
  }
}

TEST_P(AnyResolution, BoxConservesTheMean) {
  const auto [width, height, scale] = GetParam();
  const FrequencyImage image = random_image(width, height, 1);
  const auto mean_of = [](const std::vector<float>& pixels) {
    double sum = 0;
    for (const float pixel : pixels) sum += double{pixel};
    return sum / static_cast<double>(pixels.size());
  };
  const auto scaled = reconstruct(image, with(PixelFilter::box), scale);
  const auto own = reconstruct(image, with(PixelFilter::box), 1);
  // The roundings of the pixels even out. Measured: 0.7 of one.
  EXPECT_NEAR(mean_of(scaled), mean_of(own), oracle::float_rounding);
}

TEST(Reconstructor, BoxIsTheSincFactorOfEveryTerm) {
  for (std::size_t term = 0; term < max_terms; ++term) {
    FrequencyImage image(8, 8, 1);
    image.coefficients(0, 0, 0)[term] = 4;
    const auto points = reconstruct(image, with(PixelFilter::none));
    const auto means = reconstruct(image, with(PixelFilter::box));
    const auto sinc = [](int frequency) {
      const Real z = oracle::pi * static_cast<Real>(frequency) / 16;
      return frequency == 0 ? Real{1} : std::sin(z) / z;
    };
    const auto factor =
        static_cast<double>(sinc(oracle::horizontal(term)) * sinc(oracle::vertical(term)));
    // Of one term, up to 1. Measured: 1.7 roundings.
    for (std::size_t i = 0; i < 64; ++i) {
      EXPECT_NEAR(means[i], factor * points[i], 2.2 * oracle::float_rounding);
    }
  }
}

TEST(Reconstructor, PixelAveragesAreNotFilteredTwice) {
  const FrequencyImage image = random_image(20, 13, 2, CoefficientMeaning::pixel_average);
  const auto pixels = reconstruct(image, with(PixelFilter::box));
  for (std::size_t y = 0; y < 13; ++y) {
    for (std::size_t x = 0; x < 20; ++x) {
      for (std::size_t c = 0; c < 2; ++c) {
        ASSERT_NEAR(pixels[(y * 20 + x) * 2 + c], helpers::pixel_mean(image, x, y, c), tolerance);
      }
    }
  }
}

TEST(Reconstructor, BandLimitedPictureIsExactWhenSampledEnough) {
  // A sum of a block's own 64 terms in every block, continued evenly: one function of the whole
  // plane.
  oracle::Random random(77);
  const auto function = random.values<64>();
  const auto value = [&](double x, double y) {
    return static_cast<float>(oracle::block_value(function, x / 8, y / 8));
  };
  SynthesisSettings settings = helpers::settings_of(24, 16);
  settings.max_samples_per_block = 289;
  Synthesizer engine(settings);
  engine.run(value, StopRule{});
  const FrequencyImage image = engine.image();
  const auto pixels = reconstruct(image, with(PixelFilter::none));
  // The function stays below 10. The roundings of its 289 samples even out: measured, 7 are left.
  const double fit = 10 * oracle::float_rounding;
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 24; ++x) {
      const double px = static_cast<double>(x) + 0.5, py = static_cast<double>(y) + 0.5;
      ASSERT_NEAR(pixels[y * 24 + x], value(px, py), fit) << x << ", " << y;
    }
  }
}

TEST(Reconstructor, EvaluatesPointsUpToTheBorder) {
  const FrequencyImage image = random_image(20, 13, 3);
  const Function function(image, ButterworthSettings{});
  for (const double x : {0.0, 3.3, 8.0, 19.99, 20.0}) {
    for (const double y : {0.0, 7.999, 8.0, 13.0}) {
      std::array<float, 3> values;
      evaluate(image, ButterworthSettings{}, x, y, values);
      for (std::size_t c = 0; c < 3; ++c) {
        // Summed in double: the float amplitudes' roundings only. Measured: 3.1.
        EXPECT_NEAR(values[c], function.at(x, y, c), 3.8 * oracle::float_rounding);
      }
    }
  }
}

}  // namespace
}  // namespace freqsynth
