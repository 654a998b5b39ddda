// SPDX-License-Identifier: MIT
#include "freqsynth/image/pixel_finisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/synthesizer.h"
#include "support/fitted_block.h"

namespace freqsynth {
namespace {

using helpers::edge;
using helpers::FittedBlock;
using Block = std::array<float, max_terms>;

/// Uniform in -1/2 .. 1/2, another number for each sample.
double noise(std::size_t sample) {
  std::uint64_t random = (sample + 1) * 0x9e3779b97f4a7c15u;
  random = (random ^ (random >> 29)) * 0xbf58476d1ce4e5b9u;
  random ^= random >> 32;
  return static_cast<double>(random >> 40) / (1 << 24) - 0.5;
}

/// The definition, literally: mean of the filtered fit over the pixel by fine quadrature, plus the
/// shrunk weighted average of sample minus filtered fit over the samples in the pixel, halves on
/// its borders; then the bounds.
std::array<double, max_terms> literal_pixels(const FittedBlock& block, std::size_t samples,
                                             const FinishSettings& settings) {
  Block filtered = block.coefficients;
  const auto factors = butterworth_factors(settings.butterworth, samples);
  for (std::size_t i = 0; i < max_terms; ++i) {
    filtered[i] *= factors[i];
    const double error = double{block.residual} * double{block.list->variances(samples - 1)[i]};
    const double square = std::pow(double{block.coefficients[i]}, 2);
    if (settings.residuals && settings.shrinkage > 0) {
      filtered[i] *= static_cast<float>(std::max(0.0, 1 - settings.shrinkage * error / square));
    }
  }
  std::array<double, max_terms> means{};  // not a number: no samples
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
    double sum = 0, weight = 0, values = 0;
    for (std::size_t n = 0; n < samples; ++n) {
      const SequencePosition& p = block.list->position(n);
      const double w = helpers::weight_in_pixel(p, pixel);
      weight += w;
      values += w * edge(p.s, p.t);
      sum += w * (edge(p.s, p.t) - evaluate_block(filtered, p.s, p.t));
    }
    means[pixel] = values / weight;
    if (settings.residuals && weight > 0) pixels[pixel] += sum / (weight + settings.doubt);
  }
  if (!settings.residuals || std::isinf(settings.slack)) return pixels;
  // The residuals of an edge are large enough for bounds, but for those of a few samples.
  if (block.residual < 1e-4f) return pixels;
  const std::array<double, max_terms> unbounded = pixels;
  for (int pixel = 0; pixel < 64; ++pixel) {
    std::vector<double> around, all;
    for (int other = 0; other < 64; ++other) {
      const double mean = means[static_cast<std::size_t>(other)];
      if (std::isnan(mean)) continue;
      all.push_back(mean);
      const bool near =
          std::abs(pixel % 8 - other % 8) <= 1 && std::abs(pixel / 8 - other / 8) <= 1;
      if (near) around.push_back(mean);
    }
    const auto& used = around.size() >= 4 ? around : all;
    std::vector<double> sorted = used;
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    const double low = sorted.front() - settings.slack * (median - sorted.front());
    const double high = sorted.back() + settings.slack * (sorted.back() - median);
    pixels[static_cast<std::size_t>(pixel)] =
        std::clamp(unbounded[static_cast<std::size_t>(pixel)], low, high);
  }
  return pixels;
}

TEST(PixelFinisher, IsItsDefinition) {
  for (const std::size_t samples : {1u, 4u, 9u, 25u, 26u, 81u, 100u, 289u, 500u}) {
    const FittedBlock block(samples);
    std::vector<FinishSettings> variants(4);
    variants[0].residuals = false;
    variants[1].shrinkage = 0;
    variants[1].slack = std::numeric_limits<double>::infinity();
    variants[2].slack = 0;
    for (FinishSettings& settings : variants) {
      settings.butterworth.cutoff = 0.5;
      const Block pixels = block.finished(samples, settings);
      const auto expected = literal_pixels(block, samples, settings);
      for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
        // Quadrature with 16 x 16 midpoints of cosines of at most 7/16 cycle a pixel: below 4e-4.
        EXPECT_NEAR(double{pixels[pixel]}, expected[pixel], 1e-3) << samples << ", " << pixel;
      }
    }
  }
}

// White noise around a slope. What is known of the noise makes the picture smoother; at an edge the
// same would only blur.
TEST(PixelFinisher, SettingsForNoiseAreBetterForNoiseAndWorseForEdges) {
  const auto error = [](const Block& pixels, const auto& mean) {
    double sum = 0;
    for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
      sum += std::pow(double{pixels[pixel]} - mean(pixel), 2);
    }
    return std::sqrt(sum / max_terms);
  };
  const auto slope = [](std::size_t pixel) { return (static_cast<double>(pixel % 8) + 0.5) / 8; };
  const FinishSettings plain, noisy{.noise = Noise::present};
  double plain_error = 0, noisy_error = 0;
  for (std::size_t seed = 0; seed < 20; ++seed) {
    const FittedBlock block(256, [&](const SequencePosition& p, std::size_t n) {
      return p.s + noise(1000 * seed + n);
    });
    plain_error += error(block.finished(256, plain), slope) / 20;
    noisy_error += error(block.finished(256, noisy), slope) / 20;
  }
  // Each pixel alone has four samples.
  EXPECT_LT(plain_error, std::sqrt(1.0 / 12 / 4));
  EXPECT_LT(noisy_error, 0.6 * plain_error);

  const FittedBlock block(1089);
  const auto edge_mean = [](std::size_t pixel) {
    double mean = 0;
    constexpr int steps = 64;
    for (int i = 0; i < steps * steps; ++i) {
      mean += edge((static_cast<double>(pixel % 8) + (i % steps + 0.5) / steps) / 8,
                   (static_cast<double>(pixel / 8) + (i / steps + 0.5) / steps) / 8);
    }
    return mean / (steps * steps);
  };
  EXPECT_LT(error(block.finished(1089, plain), edge_mean),
            error(block.finished(1089, noisy), edge_mean));
}

TEST(PixelFinisher, DoubtIsThatOfTheNoise) {
  // 25 samples are too few to measure it.
  for (const std::size_t samples : {25u, 256u}) {
    const FittedBlock block(samples);
    const auto with = [&](const FinishSettings& settings) {
      const Block pixels = block.finished(samples, settings);
      return std::vector<float>(pixels.begin(), pixels.end());
    };
    const auto doubted = with({.doubt = 3});
    EXPECT_EQ(with({.noise = Noise::automatic, .doubt = 3, .noisy_doubt = 7}), doubted);
    EXPECT_EQ(with({.noise = Noise::none, .doubt = 3, .measure_doubt = false}), doubted);
    EXPECT_EQ(with({.noise = Noise::present, .noisy_doubt = 3, .measure_doubt = false}), doubted);
    EXPECT_EQ(with({.noise = Noise::present, .noisy_doubt = 3}) == doubted, samples == 25);
  }
}

TEST(PixelFinisher, ConvergesToTheMeansOfAnEdgeWhereTheFitDoesNot) {
  const auto error_after = [](std::size_t samples, bool residuals) {
    const FittedBlock block(samples);
    FinishSettings settings;
    settings.residuals = residuals;
    const Block pixels = block.finished(samples, settings);
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
  engine.run([](double x, double) { return x < 5 ? NAN : 3.0; }, {.samples_per_pixel = 1});
  for (const float value : reconstruct(engine.finished_image())) EXPECT_NEAR(value, 3, 1e-4f);
}

TEST(PixelFinisher, RefusesSettingsOutOfRange) {
  const auto list = SharedInverseList(InverseListSettings{});
  FinishSettings settings;
  settings.doubt = -1;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.noisy_doubt = NAN;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.shrinkage = std::numeric_limits<double>::infinity();
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.ringing = -0.1;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.slack = NAN;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  settings = {};
  settings.butterworth.order = 0;
  EXPECT_THROW(PixelFinisher(list, settings), std::invalid_argument);
  EXPECT_THROW(PixelFinisher(SharedInverseList(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
