// SPDX-License-Identifier: MIT
#include "freqsynth/image/bank_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

std::vector<UnitPoint> points(std::size_t count) {
  SampleSequence sequence;
  return sequence_points(sequence, count);
}

PriorBank small_bank() {
  PriorBank bank;
  bank.add(Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003));
  bank.add(Covariance::isotropic(CovarianceShape::matern52, 6, 1e-8));
  return bank;
}

/// A picture's samples, where those of a block are values of a function of x and y in pixels.
struct Sampled {
  std::size_t columns, rows;
  std::vector<std::vector<float>> values;
  std::vector<BlockSamples> blocks;

  template <class Function>
  Sampled(std::size_t width, std::size_t height, std::span<const UnitPoint> positions,
          Function function)
      : columns((width + 7) / 8), rows((height + 7) / 8), values(columns * rows) {
    for (std::size_t b = 0; b < values.size(); ++b) {
      const std::size_t left = b % columns * 8, top = b / columns * 8;
      const auto w = static_cast<double>(std::min<std::size_t>(8, width - left));
      const auto h = static_cast<double>(std::min<std::size_t>(8, height - top));
      for (const UnitPoint& p : positions) {
        const double x = static_cast<double>(left) + p.s * w;
        const double y = static_cast<double>(top) + p.t * h;
        for (const double value : {function(x, y), 2 - function(x, y)}) {
          values[b].push_back(static_cast<float>(value));
        }
      }
      blocks.push_back({values[b].data(), positions.size()});
    }
  }
};

std::vector<float> render(const BankPictures& pictures, const Sampled& sampled, std::size_t width,
                          std::size_t height, std::span<float> errors = {}) {
  std::vector<float> pixels(2 * width * height, -1);
  pictures.render(sampled.blocks, {pixels.data(), width, height}, 2, errors);
  return pixels;
}

double wave(double x, double y) { return std::sin(0.21 * x + 0.3) * std::cos(0.17 * y) + 0.02 * x; }

TEST(BankPictures, WithoutRingAndBlendingABlockIsItsOwnEstimate) {
  const auto at = points(13);
  BankPictureSettings settings;
  settings.bank = small_bank();
  settings.ring = false;
  settings.blend = 0;
  const BankPictures pictures(at, settings);
  const Sampled sampled(24, 16, at, wave);
  std::vector<float> errors(24 * 16);
  const auto pixels = render(pictures, sampled, 24, 16, errors);
  const BankLists lists(small_bank(), at, AverageGrid::of_node(8));
  for (std::size_t b = 0; b < 6; ++b) {
    std::vector<float> averages(128), squared(64);
    BankNode nodes[] = {
        {sampled.values[b].data(), 13, nullptr, averages.data(), nullptr, squared.data(), nullptr}};
    BankEstimator(lists, 2).estimate(nodes);
    for (std::size_t p = 0; p < 64; ++p) {
      const std::size_t x = b % 3 * 8 + p % 8, y = b / 3 * 8 + p / 8;
      for (std::size_t c = 0; c < 2; ++c) {
        ASSERT_NEAR(pixels[2 * (y * 24 + x) + c], averages[c * 64 + p], 1e-6);
      }
      ASSERT_EQ(errors[y * 24 + x], squared[p]);
    }
  }
}

/// Mean of wave() over a pixel, by quadrature.
double wave_mean(std::size_t x, std::size_t y) {
  double sum = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      sum += wave(static_cast<double>(x) + (i + 0.5) / 4, static_cast<double>(y) + (j + 0.5) / 4);
    }
  }
  return sum / 16;
}

double greatest_error(const BankPictureSettings& settings, std::size_t width, std::size_t height) {
  const auto at = points(25);
  const BankPictures pictures(at, settings);
  const auto pixels = render(pictures, Sampled(width, height, at, wave), width, height);
  double worst = 0;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const double truth = wave_mean(x, y);
      worst = std::max(worst, std::abs(double{pixels[2 * (y * width + x)]} - truth));
      worst = std::max(worst, std::abs(double{pixels[2 * (y * width + x) + 1]} - 2 + truth));
    }
  }
  return worst;
}

TEST(BankPictures, AreThoseOfASmoothFunctionWithRingAndBlendingAndOfAnySize) {
  for (const bool ring : {false, true}) {
    for (const std::size_t blend :
         {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
      BankPictureSettings settings;
      settings.bank = small_bank();
      settings.ring = ring;
      settings.blend = blend;
      EXPECT_LT(greatest_error(settings, 40, 32), 5e-3) << ring << blend;
      EXPECT_LT(greatest_error(settings, 43, 26), 5e-3) << ring << blend;
      EXPECT_LT(greatest_error(settings, 3, 41), 5e-3) << ring << blend;
      EXPECT_LT(greatest_error(settings, 1, 1), 5e-3) << ring << blend;
    }
  }
}

TEST(BankPictures, ALevelStaysOneWhereverBlocksHaveHowManySamples) {
  const auto at = points(81);
  BankPictureSettings settings;
  settings.bank = small_bank();
  const BankPictures pictures(at, settings);
  Sampled sampled(45, 40, at, [](double, double) { return 0.7; });
  oracle::Random random(2);
  for (BlockSamples& block : sampled.blocks) block.count = 1 + random.below(81);
  for (std::size_t i = 0; const float value : render(pictures, sampled, 45, 40)) {
    ASSERT_NEAR(value, i++ % 2 == 0 ? 0.7f : 1.3f, 3e-7);
  }
}

/// Sum of squared errors in the middle block of 3 x 3 whose samples are of slanted edges.
double squared_error_at_edges(bool ring) {
  const auto at = points(25);
  BankPictureSettings settings;
  settings.bank.add_directions(Covariance::oriented(CovarianceShape::exponential, 20, 1, 0, 0.003),
                               16);
  settings.ring = ring;
  settings.blend = 0;
  const BankPictures pictures(at, settings);
  oracle::Random random(3);
  double sum = 0;
  for (int i = 0; i < 20; ++i) {
    const double angle = random.uniform(0, 3.1), middle = random.uniform(-4, 4);
    const auto edge = [&](double x, double y) {
      return std::cos(angle) * (x - 12) + std::sin(angle) * (y - 12) > middle ? 1.0 : 0.0;
    };
    const auto pixels = render(pictures, Sampled(24, 24, at, edge), 24, 24);
    for (std::size_t y = 8; y < 16; ++y) {
      for (std::size_t x = 8; x < 16; ++x) {
        double truth = 0;
        for (int k = 0; k < 256; ++k) {
          truth += edge(static_cast<double>(x) + (k % 16 + 0.5) / 16,
                        static_cast<double>(y) + (k / 16 + 0.5) / 16) /
                   256;
        }
        sum += std::pow(double{pixels[2 * (y * 24 + x)]} - truth, 2);
      }
    }
  }
  return sum;
}

TEST(BankPictures, TheRingTellsMoreOfEdges) {
  EXPECT_LT(squared_error_at_edges(true), 0.95 * squared_error_at_edges(false));
}

TEST(BankPictures, BlendingMakesBordersAgree) {
  // Where a block has few samples and its neighbour many, they disagree on the border.
  const auto at = points(25);
  double steps[2];
  for (const std::size_t blend : {std::size_t{0}, std::size_t{2}}) {
    BankPictureSettings settings;
    settings.bank = small_bank();
    settings.ring = false;
    settings.blend = blend;
    const auto hard = [](double x, double y) { return x + 0.6 * y > 14.3 ? 1.0 : 0.0; };
    const auto pixels = render(BankPictures(at, settings), Sampled(24, 24, at, hard), 24, 24);
    double sum = 0;
    for (std::size_t y = 0; y < 24; ++y) {
      const double truth = hard(7.5, static_cast<double>(y)) - hard(8.5, static_cast<double>(y));
      sum += std::abs(double{pixels[2 * (y * 24 + 7)]} - double{pixels[2 * (y * 24 + 8)]} - truth);
    }
    steps[blend / 2] = sum;
  }
  EXPECT_LT(steps[1], steps[0]);
}

TEST(BankPictures, RefuseWhatIsNone) {
  const auto at = points(9);
  EXPECT_THROW(BankPictures(std::vector<UnitPoint>{}), std::invalid_argument);
  EXPECT_THROW(BankPictures(std::vector<UnitPoint>(1801)), std::invalid_argument);
  BankPictureSettings settings;
  settings.blend = 5;
  EXPECT_THROW(BankPictures(at, settings), std::invalid_argument);
  settings = {};
  settings.bank = small_bank();
  const BankPictures pictures(at, settings);
  Sampled sampled(16, 16, at, wave);
  std::vector<float> errors(5);
  EXPECT_THROW(render(pictures, sampled, 17, 16), std::invalid_argument);
  EXPECT_THROW(render(pictures, sampled, 16, 16, errors), std::invalid_argument);
  sampled.blocks[2].count = 0;
  EXPECT_THROW(render(pictures, sampled, 16, 16), std::invalid_argument);
  sampled.blocks[2].count = 10;
  EXPECT_THROW(render(pictures, sampled, 16, 16), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
