#include "freqsynth/pixel_finisher.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "freqsynth/dct.h"
#include "freqsynth/least_squares_refiner.h"
#include "freqsynth/reconstructor.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth {
namespace {

using Block = std::array<float, max_terms>;

/// A hard edge across the block, which no band-limited function holds.
double edge(double s, double t) { return s + 0.37 * t < 0.61 ? 1.0 : 0.0; }

/// A block after `samples` samples of edge().
struct FittedBlock {
  explicit FittedBlock(std::size_t samples) : refiner(list, 1), state(refiner.state_size() / 16) {
    refiner.reset(state.data()->values);
    for (std::size_t n = 0; n < samples; ++n) {
      const SequencePosition& p = list->position(n);
      const auto value = static_cast<float>(edge(p.s, p.t));
      refiner.absorb(state.data()->values, n, &value);
    }
    refiner.coefficients(state.data()->values, samples, 0, coefficients);
  }

  struct alignas(64) Line {
    float values[16];
  };
  std::shared_ptr<const InverseList> list = std::make_shared<const InverseList>();
  LeastSquaresRefiner refiner;
  std::vector<Line> state;
  Block coefficients{};
};

/// The definition, literally: mean of the filtered fit over the pixel by fine quadrature, plus the
/// shrunk weighted average of sample minus filtered fit over the samples in the pixel, halves on
/// its borders.
std::array<double, max_terms> literal_pixels(const FittedBlock& block, std::size_t samples,
                                             const FinishSettings& settings) {
  Block filtered = block.coefficients;
  const auto factors = butterworth_factors(settings.butterworth, samples);
  for (std::size_t i = 0; i < max_terms; ++i) filtered[i] *= factors[i];
  std::array<double, max_terms> pixels{};
  for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
    const auto column = static_cast<double>(pixel % 8);
    const auto row = static_cast<double>(pixel / 8);
    constexpr int steps = 16;
    for (int i = 0; i < steps * steps; ++i) {
      pixels[pixel] += evaluate_block(filtered, (column + (i % steps + 0.5) / steps) / 8,
                                      (row + (i / steps + 0.5) / steps) / 8) /
                       (steps * steps);
    }
    double sum = 0, weight = 0;
    for (std::size_t n = 0; n < samples; ++n) {
      const SequencePosition& p = block.list->position(n);
      const auto share = [](double x, double low) {
        return x < low || x > low + 1 ? 0.0 : x == low || x == low + 1 ? 0.5 : 1.0;
      };
      const double w = share(8 * p.s, column) * share(8 * p.t, row);
      weight += w;
      sum += w * (edge(p.s, p.t) - evaluate_block(filtered, p.s, p.t));
    }
    if (settings.residuals && weight > 0) pixels[pixel] += sum / (weight + settings.doubt);
  }
  return pixels;
}

TEST(PixelFinisher, IsItsDefinition) {
  for (const std::size_t samples : {1u, 4u, 9u, 25u, 26u, 81u, 100u, 289u, 500u}) {
    for (const bool residuals : {true, false}) {
      const FittedBlock block(samples);
      FinishSettings settings;
      settings.residuals = residuals;
      settings.butterworth.cutoff = 0.5;
      PixelFinisher finisher(block.list, settings);
      finisher.advance(samples);
      Block finished{}, pixels{};
      finisher.finish(block.coefficients, block.refiner.pixel_sums(block.state.data()->values, 0),
                      finished);
      inverse_dct(finished, pixels);
      const auto expected = literal_pixels(block, samples, settings);
      for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
        // Quadrature with 16 x 16 midpoints of cosines of at most 7/16 cycle a pixel: below 4e-4.
        EXPECT_NEAR(double{pixels[pixel]}, expected[pixel], 1e-3) << samples << ", " << pixel;
      }
    }
  }
}

TEST(PixelFinisher, ConvergesToTheMeansOfAnEdgeWhereTheFitDoesNot) {
  const auto error_after = [](std::size_t samples, bool residuals) {
    const FittedBlock block(samples);
    FinishSettings settings;
    settings.residuals = residuals;
    PixelFinisher finisher(block.list, settings);
    finisher.advance(samples);
    Block finished{}, pixels{};
    finisher.finish(block.coefficients, block.refiner.pixel_sums(block.state.data()->values, 0),
                    finished);
    inverse_dct(finished, pixels);
    double sum = 0;
    for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
      double mean = 0;
      constexpr int steps = 64;
      for (int i = 0; i < steps * steps; ++i) {
        mean += edge((static_cast<double>(pixel % 8) + (i % steps + 0.5) / steps) / 8,
                     (static_cast<double>(pixel / 8) + (i / steps + 0.5) / steps) / 8);
      }
      sum += std::pow(double{pixels[pixel]} - mean / (steps * steps), 2);
    }
    return std::sqrt(sum / max_terms);
  };
  EXPECT_LT(error_after(4225, true), 0.25 * error_after(289, true));
  EXPECT_LT(error_after(4225, true), 0.2 * error_after(4225, false));
}

TEST(PixelFinisher, AFunctionOfTheBasisHasNoResiduals) {
  // Once the term is in the fit and the filter is off, finishing is the exact box alone.
  Synthesizer engine({.width = 16, .height = 8, .channels = 1, .max_samples_per_block = 289});
  engine.run([](double x, double y) { return 2 + std::cos(x * 0.392699081698724) * (y < 99); }, {});
  FinishSettings settings;
  settings.butterworth.enabled = false;
  const auto finished = reconstruct(engine.finished_image(settings));
  ReconstructionSettings plain;
  plain.butterworth.enabled = false;
  const auto fit = reconstruct(engine.image(), plain);
  for (std::size_t i = 0; i < fit.size(); ++i) EXPECT_NEAR(finished[i], fit[i], 2e-5f) << i;
}

TEST(PixelFinisher, TheImageIsMarkedAsFinishedAndKeepsItsCounts) {
  Synthesizer engine({.width = 20, .height = 9, .channels = 2});
  engine.run([](double x, double y) { return std::array{x, y}; }, {.samples_per_pixel = 1});
  const FrequencyImage fit = engine.image();
  const FrequencyImage finished = engine.finished_image();
  EXPECT_EQ(finished.meaning(), CoefficientMeaning::pixel_average);
  for (std::size_t by = 0; by < fit.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < fit.blocks_x(); ++bx) {
      EXPECT_EQ(fit.samples(bx, by), finished.samples(bx, by));
    }
  }
  // Without residuals it is what the reconstructor makes of the fit.
  const auto paper = reconstruct(fit);
  const auto same = reconstruct(engine.finished_image({.residuals = false}));
  for (std::size_t i = 0; i < paper.size(); ++i) EXPECT_NEAR(paper[i], same[i], 1e-4f);
}

TEST(PixelFinisher, SurvivesBadSamples) {
  Synthesizer engine({.width = 16, .height = 16, .channels = 1});
  engine.run([](double x, double) { return x < 5 ? NAN : 3.0; }, {.samples_per_pixel = 2});
  for (const float value : reconstruct(engine.finished_image())) EXPECT_NEAR(value, 3, 1e-4f);
}

TEST(PixelFinisher, RefusesSettingsOutOfRange) {
  const auto list = std::make_shared<const InverseList>();
  FinishSettings settings;
  settings.doubt = -1;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.butterworth.order = 0;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  EXPECT_THROW(PixelFinisher(nullptr, {}), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
