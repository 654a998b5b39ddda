#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "engine_helpers.h"
#include "freqsynth/synthesizer.h"
#include "oracles.h"

namespace freqsynth {
namespace {

using helpers::picture;
using helpers::Point;
using oracle::Real;

/// The paper's loop (sections 4.3 and 4.4) by brute force: after every sample all fits, changes and
/// priorities are computed from scratch, and all blocks are searched for the first.
class NaiveEngine {
 public:
  NaiveEngine(std::size_t blocks_x, std::size_t blocks_y, const PrioritySettings& priority)
      : blocks_x_(blocks_x), blocks_(blocks_x * blocks_y), priority_(priority) {}

  std::vector<Point> run(std::size_t samples, double threshold) {
    std::vector<Point> asked;
    while (asked.size() < samples) {
      std::size_t first = 0;
      for (std::size_t b = 1; b < blocks_.size(); ++b) {
        if (priority_of(blocks_[b]) > priority_of(blocks_[first])) first = b;
      }
      if (priority_of(blocks_[first]) <= threshold * threshold) break;
      const Point point = next_point(first);
      const float value = picture(point.first, point.second);
      asked.push_back(point);
      known_[point] = value;
      if (list_.position(blocks_[first].samples).side == BlockSide::corner) {
        corners_.push_back(static_cast<double>(value));
      }
      // Every block goes on as long as its next value is known, from whomever.
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        while (known_.count(next_point(b)) != 0) absorb(b, known_.at(next_point(b)));
      }
      fix_variance();
    }
    return asked;
  }

 private:
  struct Block {
    std::size_t samples = 0;
    oracle::LeastSquares fit;
    std::vector<Real> coefficients = std::vector<Real>(max_terms);
    double variation = 0;    // running average of V_n
    double uncertainty = 0;  // running average of r^n
  };

  [[nodiscard]] Point next_point(std::size_t b) const {
    const SequencePosition& position = list_.position(blocks_[b].samples);
    return {8 * (static_cast<double>(b % blocks_x_) + position.s),
            8 * (static_cast<double>(b / blocks_x_) + position.t)};
  }

  void absorb(std::size_t b, float value) {
    Block& block = blocks_[b];
    const SequencePosition& position = list_.position(block.samples);
    block.fit.add(position.s, position.t, static_cast<Real>(value));
    const auto coefficients = block.fit.coefficients(list_.terms(block.samples));
    Real change = 0;  // of the pixels, by Parseval
    for (std::size_t i = 0; i < max_terms; ++i) {
      change += std::pow(coefficients[i] - block.coefficients[i], 2) / 64;
    }
    if (block.samples == 0) {
      change = 0;  // nothing was there to change
      block.uncertainty = 1;
    }
    block.coefficients = coefficients;
    ++block.samples;
    const double w = priority_.weight;
    block.variation = (1 - w) * block.variation + w * static_cast<double>(change);
    block.uncertainty = (1 - w) * block.uncertainty +
                        w * std::pow(priority_.decay, static_cast<double>(block.samples));
  }

  /// Uncertainty is in units of the variance of the corners, once every block has a sample.
  void fix_variance() {
    if (variance_ != 0) return;
    for (const Block& block : blocks_) {
      if (block.samples == 0) return;
    }
    double mean = 0, square = 0;
    for (const double value : corners_) mean += value / static_cast<double>(corners_.size());
    for (const double value : corners_) {
      square += (value - mean) * (value - mean) / static_cast<double>(corners_.size());
    }
    variance_ = square;
  }

  [[nodiscard]] double priority_of(const Block& block) const {
    if (block.samples == 0) return std::numeric_limits<double>::infinity();
    return block.variation + priority_.uncertainty * variance_ * block.uncertainty;
  }

  std::size_t blocks_x_;
  std::vector<Block> blocks_;
  PrioritySettings priority_;
  InverseList list_;
  std::map<Point, float> known_;
  std::vector<double> corners_;
  double variance_ = 0;
};

class StrictOrder : public testing::TestWithParam<PrioritySettings> {};
INSTANTIATE_TEST_SUITE_P(Settings, StrictOrder,
                         testing::Values(PrioritySettings{}, PrioritySettings{0.3, 0.1, 0.5},
                                         PrioritySettings{0.7, 2, 0.9}));

TEST_P(StrictOrder, WaveOfOneIsThePapersLoop) {
  SynthesisSettings settings = helpers::settings_of(32, 24, 1, 1);
  settings.priority = GetParam();
  Synthesizer engine(settings);
  NaiveEngine naive(4, 3, GetParam());
  const auto asked = helpers::asked_points(engine, helpers::at_samples(600), picture);
  const auto expected = naive.run(600, 0);
  ASSERT_EQ(asked.size(), expected.size());
  for (std::size_t n = 0; n < asked.size(); ++n) {
    ASSERT_EQ(asked[n], expected[n]) << "sample " << n;
  }
}

TEST_P(StrictOrder, StopsAtTheThresholdOfThePapersLoop) {
  for (const double threshold : {0.05, 0.01}) {
    SynthesisSettings settings = helpers::settings_of(32, 24, 1, 1);
    settings.priority = GetParam();
    Synthesizer engine(settings);
    NaiveEngine naive(4, 3, GetParam());
    const auto asked = helpers::asked_points(engine, helpers::at_threshold(threshold), picture);
    EXPECT_EQ(asked, naive.run(10000, threshold));
    EXPECT_EQ(engine.stopped(), StopReason::threshold);
  }
}

}  // namespace
}  // namespace freqsynth
