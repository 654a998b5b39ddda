// SPDX-License-Identifier: MIT
// The predicted errors of finished pixels.

#include "freqsynth/image/error_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples_per_pixel;
using helpers::picture;
using helpers::settings_of;

double root_mean_square(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += double{value} * double{value};
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Means of a function over pixels, of 16 x 16 points each.
std::vector<float> means_of(const std::function<float(double, double)>& function,
                            std::size_t side) {
  std::vector<float> means(side * side);
  for (std::size_t i = 0; i < means.size(); ++i) {
    double sum = 0;
    for (int k = 0; k < 256; ++k) {
      sum += function(static_cast<double>(i % side) + (k % 16 + 0.5) / 16,
                      static_cast<double>(i / side) + (k / 16 + 0.5) / 16);
    }
    means[i] = static_cast<float>(sum / 256);
  }
  return means;
}

/// Noise by the request's own random numbers: 1/p with probability p.
float bernoulli(const Request& request, double p) {
  std::mt19937_64 random(request.seed);
  return std::uniform_real_distribution<double>()(random) < p ? static_cast<float>(1 / p) : 0.0f;
}

TEST(ErrorImage, OfAConstantIsNothing) {
  for (const Noise noise : {Noise::none, Noise::present}) {
    Synthesizer engine(settings_of(48, 32));
    engine.run([](double, double) { return 5.0f; }, at_samples_per_pixel(1));
    const std::vector<float> errors = engine.error_image({.noise = noise});
    ASSERT_EQ(errors.size(), 48u * 32);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 5e-6);
    EXPECT_LT(engine.predicted_rmse({.noise = noise}), 5e-6);
  }
}

TEST(ErrorImage, IsUnknownBeforeThereAreSamples) {
  Synthesizer engine(settings_of(20, 20));
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(engine.error_image(), std::vector<float>(400, infinite));
  EXPECT_EQ(engine.predicted_rmse(), std::numeric_limits<double>::infinity());
  engine.run([](double x, double y) { return picture(x, y); }, helpers::at_samples(9));
  for (const float error : engine.error_image()) EXPECT_TRUE(std::isfinite(error));
  EXPECT_GT(engine.predicted_rmse(), 0.01) << "of a sample or a few in each block";
}

TEST(ErrorImage, HasTheUnitOfTheValues) {
  const auto errors_with = [](double factor, bool noisy) {
    Synthesizer engine(settings_of(64, 48));
    engine.run(
        [&](const Request& r) {
          const double value = picture(r.x, r.y) + (noisy ? bernoulli(r, 0.5) : 0);
          return static_cast<float>(factor * value);
        },
        at_samples_per_pixel(2));
    return engine.error_image();
  };
  for (const bool noisy : {false, true}) {
    const std::vector<float> once = errors_with(1, noisy);
    for (const double factor : {2.0, 1024.0, 0x1p-40, 3.0}) {
      const std::vector<float> more = errors_with(factor, noisy);
      for (std::size_t i = 0; i < once.size(); ++i) {
        ASSERT_NEAR(more[i], factor * once[i], 2e-3 * factor * once[i]) << factor;
      }
    }
  }
}

TEST(ErrorImage, IsTheRootOfWhatThePredictedErrorIsTheMeanOf) {
  for (const auto& [width, height] : {std::pair{64u, 64u}, {61u, 43u}, {1u, 200u}, {9u, 3u}}) {
    Synthesizer engine(settings_of(width, height));
    engine.run([](double x, double y) { return picture(x, y); }, at_samples_per_pixel(3));
    const double whole = engine.predicted_rmse();
    EXPECT_GT(whole, 0);
    EXPECT_NEAR(root_mean_square(engine.error_image()), whole, 1e-4 * whole) << width;
  }
}

TEST(ErrorImage, OfFunctionsIsAboutTheTrueErrorAndFalls) {
  const std::vector<std::function<float(double, double)>> functions = {
      picture, [](double x, double y) { return std::hypot(x - 50, y - 60) < 37 ? 3.0f : 1.0f; },
      [](double x, double y) { return std::sin(0.4 * x) + 0.3 * y > 15 ? 1.0f : 0.0f; },
      [](double x, double y) { return static_cast<float>(std::cos(0.02 * x * x + 0.1 * y)); }};
  constexpr std::size_t side = 64;
  for (const auto& function : functions) {
    const std::vector<float> truth = means_of(function, side);
    double last = std::numeric_limits<double>::infinity();
    for (const double samples : {0.5, 1.0, 4.0, 16.0}) {
      double predicted = 0, measured = 0;
      for (const std::uint64_t seed : {1u, 2u, 3u}) {
        SynthesisSettings settings = settings_of(side, side);
        settings.list.seed = seed;
        Synthesizer engine(settings);
        engine.run([&](double x, double y) { return function(x, y); },
                   at_samples_per_pixel(samples));
        std::vector<float> off = reconstruct(engine.finished_image());
        for (std::size_t i = 0; i < off.size(); ++i) off[i] -= truth[i];
        predicted += std::pow(engine.predicted_rmse(), 2);
        measured += std::pow(root_mean_square(off), 2);
      }
      const double ratio = std::sqrt(predicted / measured);
      EXPECT_GT(ratio, 1 / 1.8) << samples;
      EXPECT_LT(ratio, 1.8) << samples;
      EXPECT_LT(predicted, last) << samples;
      last = predicted;
    }
  }
}

/// Predicted and true error of a picture of noise whose mean is 1, means over seeds.
struct Both {
  double predicted = 0, measured = 0;
};
Both errors_of_noise(double p, double samples, bool smooth) {
  constexpr std::size_t side = 64;
  Both both;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    SynthesisSettings settings = settings_of(side, side);
    settings.seed = seed;
    Synthesizer engine(settings);
    engine.run([&](const Request& request) { return bernoulli(request, p); },
               at_samples_per_pixel(samples));
    const FinishSettings finish{.smooth_noise = smooth};
    std::vector<float> pixels = reconstruct(engine.finished_image(finish));
    for (float& pixel : pixels) pixel -= 1;
    both.measured += std::pow(root_mean_square(pixels), 2) / 4;
    both.predicted += std::pow(engine.predicted_rmse(finish), 2) / 4;
  }
  return both;
}

TEST(ErrorImage, OfNoiseThatIsNotSmoothedIsTheTrueErrorWithinAFifth) {
  for (const double p : {0.5, 0.1}) {
    for (const double samples : {4.0, 16.0}) {
      const Both both = errors_of_noise(p, samples, false);
      EXPECT_NEAR(std::sqrt(both.predicted / both.measured), 1, 0.2) << p << ", " << samples;
    }
  }
}

TEST(ErrorImage, GrowsWithNoiseAndWithoutSmoothing) {
  double last = 0;
  for (const double p : {0.8, 0.5, 0.2, 0.05}) {
    const Both smooth = errors_of_noise(p, 4, true);
    EXPECT_GT(smooth.predicted, 1.5 * last) << p;
    EXPECT_GT(errors_of_noise(p, 4, false).predicted, smooth.predicted) << p;
    last = smooth.predicted;
  }
}

TEST(ErrorImage, ShowsWhereErrorsAre) {
  // An edge in a flat picture.
  constexpr std::size_t side = 64;
  Synthesizer engine(settings_of(side, side));
  engine.run([](double x, double y) { return 0.3 * x + y > 40.3 ? 1.0f : 0.0f; },
             at_samples_per_pixel(2));
  const std::vector<float> errors = engine.error_image();
  double on_edge = 0, beside = 0, edges = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double distance =
        0.3 * (static_cast<double>(i % side) + 0.5) + static_cast<double>(i / side) + 0.5 - 40.3;
    const bool near = std::abs(distance) < 0.6;
    (near ? on_edge : beside) += double{errors[i]} * double{errors[i]};
    edges += near ? 1 : 0;
  }
  EXPECT_GT(on_edge / edges, 10 * beside / (static_cast<double>(side * side) - edges));
}

TEST(ErrorImage, KnowsOfDotsThatItHasNotSeen) {
  // A dot of a third of a pixel in every block, at a random place.
  constexpr std::size_t side = 160, blocks = side / 8;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(0.5, 7.5);
  std::vector<std::array<double, 2>> centres(blocks * blocks);
  for (auto& [u, v] : centres) {
    u = place(random);
    v = place(random);
  }
  const auto dots = [&](double x, double y) {
    const std::size_t column = std::min(static_cast<std::size_t>(x / 8), blocks - 1);
    const std::size_t row = std::min(static_cast<std::size_t>(y / 8), blocks - 1);
    const auto& [u, v] = centres[row * blocks + column];
    return std::hypot(x - 8 * static_cast<double>(column) - u,
                      y - 8 * static_cast<double>(row) - v) < 0.32
               ? 1.0f
               : 0.0f;
  };
  Synthesizer engine(settings_of(side, side));
  engine.run(dots, at_samples_per_pixel(1));
  const double measured = helpers::rmse_of(reconstruct(engine.finished_image()), side, dots);
  EXPECT_GT(engine.predicted_rmse(), 0.5 * measured);
  EXPECT_LT(engine.predicted_rmse(), 2 * measured);
}

TEST(ErrorImage, IsTheSameOnSeveralThreadsInAnyBatch) {
  ThreadPool pool(3);
  std::vector<float> first;
  for (const std::size_t batch : {1024u, 7u, 64u}) {
    Synthesizer engine(settings_of(80, 56, 2));
    engine.run(
        [](const Request& r) {
          return std::array{picture(r.x, r.y), bernoulli(r, 0.3)};
        },
        at_samples_per_pixel(2), pool, KeepGoing{}, batch);
    const std::vector<float> errors = engine.error_image();
    if (first.empty()) first = errors;
    EXPECT_EQ(errors, first) << batch;
  }
}

TEST(ErrorImage, HasTheChannelsAndTheSizeOfImages) {
  SynthesisSettings settings = settings_of(64, 40, 4);
  settings.channel_settings = {
      {.weight = 3}, {.weight = 1}, {ChannelRole::passive}, {ChannelRole::nearest}};
  settings.window = {16, 8, 24, 16};
  Synthesizer engine(settings);
  engine.run(
      [](double x, double y) {
        const float value = picture(x, y);
        return std::array{value, 2 * value, 100 * value, 1.0f};
      },
      at_samples_per_pixel(2));
  const std::vector<float> errors = engine.error_image();
  const PixelWindow window = engine.window();
  ASSERT_EQ(errors.size(), 3 * window.width * window.height);
  double squares[3] = {};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares[i % 3] +=
        double{errors[i]} * double{errors[i]} * 3 / static_cast<double>(errors.size());
  }
  EXPECT_NEAR(squares[1] / squares[0], 4, 0.01);
  EXPECT_NEAR(squares[2] / squares[0], 1e4, 30);
  const double whole = std::sqrt(0.75 * squares[0] + 0.25 * squares[1]);
  EXPECT_NEAR(engine.predicted_rmse(), whole, 1e-4 * whole);
}

TEST(ErrorImage, OfSamplesWithoutValuesIsGreater) {
  double squares[2];
  for (const bool gaps : {false, true}) {
    Synthesizer engine(settings_of(64, 64));
    engine.run(
        [&](double x, double y) {
          const bool gap = gaps && std::sin(40 * x + 17 * y) > 0;
          return gap ? std::numeric_limits<float>::quiet_NaN() : picture(x, y);
        },
        helpers::at_samples(2 * 64 * 64));
    squares[gaps ? 1 : 0] = engine.predicted_rmse();
    EXPECT_NEAR(root_mean_square(engine.error_image()), engine.predicted_rmse(), 1e-5);
  }
  EXPECT_GT(squares[1], 1.2 * squares[0]);
  EXPECT_LT(squares[1], 5 * squares[0]);
}

TEST(ErrorImage, RefusesSettingsOutOfRange) {
  const Synthesizer engine(settings_of(8, 8));
  EXPECT_THROW((void)engine.error_image({.doubt = -1}), std::invalid_argument);
  EXPECT_THROW((void)engine.predicted_rmse({.slack = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
