// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

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
    std::vector<std::pair<SequencePosition, Real>> taken;
    double residual = 0;  // variance of the residuals
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
    block.taken.emplace_back(position, static_cast<Real>(value));
    const std::size_t terms = list_.terms(block.samples - 1);
    const auto amplitudes = block.fit.amplitudes(terms);
    Real squares = 0;
    for (const auto& [where, what] : block.taken) {
      const auto values = oracle::term_values(where.s, where.t);
      Real fit = 0;
      for (std::size_t i = 0; i < terms; ++i) fit += amplitudes[i] * values[i];
      squares += (what - fit) * (what - fit);
    }
    block.residual = static_cast<double>(squares) / freedom_of(block);
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

  [[nodiscard]] double freedom_of(const Block& block) const {
    const std::size_t terms = list_.terms(block.samples - 1);
    return block.samples > terms ? static_cast<double>(block.samples - terms) : 1;
  }

  [[nodiscard]] double priority_of(const Block& block) const {
    if (block.samples == 0) return std::numeric_limits<double>::infinity();
    const double uncertainty = priority_.uncertainty * variance_ * block.uncertainty;
    if (priority_.measure == PriorityMeasure::change) return block.variation + uncertainty;
    const auto b = static_cast<std::size_t>(&block - blocks_.data());
    std::vector<double> beside;
    if (b % blocks_x_ > 0) beside.push_back(blocks_[b - 1].residual);
    if (b % blocks_x_ + 1 < blocks_x_) beside.push_back(blocks_[b + 1].residual);
    if (b >= blocks_x_) beside.push_back(blocks_[b - blocks_x_].residual);
    if (b + blocks_x_ < blocks_.size()) beside.push_back(blocks_[b + blocks_x_].residual);
    const double mean =
        std::accumulate(beside.begin(), beside.end(), 0.0) / static_cast<double>(beside.size());
    const double freedom = freedom_of(block);
    const double pooled =
        (freedom * block.residual + priority_.neighbours * mean) / (freedom + priority_.neighbours);
    const auto n = static_cast<double>(block.samples);
    const double doubt = priority_.uncertainty * variance_ * std::pow(priority_.decay, n) / n;
    return 64 * (pooled + doubt) / n * share_of(block.samples);
  }

  // Share of the error that a sample takes away: that of the step from one even lattice to the
  // next, per sample. Whole levels have (k + 1)^2 positions, k = 1, 2, 4, ..; between them lies the
  // level with its k^2 centres.
  static double share_of(std::size_t n) {
    std::size_t before = 1;
    for (std::size_t k = 1; before <= n; k *= 2) {
      const std::size_t level = (k + 1) * (k + 1);
      for (const std::size_t after : {level, level + k * k}) {
        if (n < after) {
          return (1 - std::pow(double(before) / double(after), 1.5)) / double(after - before);
        }
        before = after;
      }
    }
    return 0;
  }

  std::size_t blocks_x_;
  std::vector<Block> blocks_;
  PrioritySettings priority_;
  InverseList list_;
  std::map<Point, float> known_;
  std::vector<double> corners_;
  double variance_ = 0;
};

PrioritySettings paper(double weight, double uncertainty, double decay) {
  return {.weight = weight,
          .uncertainty = uncertainty,
          .decay = decay,
          .measure = PriorityMeasure::change,
          .exploration = 0};
}

/// Without the share of the whole image, which is as old as the block's last change.
PrioritySettings residuals(double neighbours) {
  return {
      .measure = PriorityMeasure::residual, .neighbours = neighbours, .image = 0, .exploration = 0};
}

class StrictOrder : public testing::TestWithParam<PrioritySettings> {};
INSTANTIATE_TEST_SUITE_P(Settings, StrictOrder,
                         testing::Values(paper(0.3, 1, 0.7165), paper(0.3, 0.1, 0.5),
                                         paper(0.7, 2, 0.9), residuals(16), residuals(4)));

TEST_P(StrictOrder, WaveOfOneIsTheLoopByBruteForce) {
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

TEST_P(StrictOrder, StopsAtTheThresholdOfThatLoop) {
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
