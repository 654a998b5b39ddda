// SPDX-License-Identifier: MIT
// Channels of role mean: the means of pixels, beside those of role nearest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// One that steers; a mean; an id; a mean with gaps that are not those of the first.
SynthesisSettings with_means(std::size_t width, std::size_t height) {
  return {
      .width = width,
      .height = height,
      .channels = 4,
      .channel_settings = {{}, {ChannelRole::mean}, {ChannelRole::nearest}, {ChannelRole::mean}}};
}

std::array<float, 4> values_at(double x, double y) {
  const bool bad = std::fmod(x * y, 3) < 1;
  return {static_cast<float>(std::sin(0.3 * x) + (y > 9 ? 1 : 0)),
          static_cast<float>(x - 3 * y + std::sin(40 * x * y)), static_cast<float>(x),
          bad ? (x > 8 ? nan : infinity) : static_cast<float>(1e30 * y)};
}

struct Taken {
  double x, y;
  std::array<float, 4> values;
};

/// The rule, by looking at all samples for every pixel.
std::vector<double> by_rule(const std::vector<Taken>& samples, std::size_t width,
                            std::size_t height, std::size_t channel) {
  // Samples in pixels first .. last along both axes are counted once in each.
  const auto mean_of = [&](int x, int y, int reach) {
    double sum = 0, count = 0;
    for (const Taken& one : samples) {
      if (!(std::abs(one.values[channel]) < 1e35f)) continue;
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, static_cast<int>(height) - 1);
           ++v) {
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, static_cast<int>(width) - 1);
             ++u) {
          if (one.x < u || one.x > u + 1 || one.y < v || one.y > v + 1) continue;
          sum += double{one.values[channel]};
          count += 1;
        }
      }
    }
    return std::array{sum, count};
  };
  std::vector<double> pixels;
  for (std::size_t p = 0; p < width * height; ++p) {
    std::array<double, 2> found{0, 0};
    for (int reach = 0; found[1] == 0 && reach <= 8; ++reach) {
      found = mean_of(static_cast<int>(p % width), static_cast<int>(p / width), reach);
    }
    pixels.push_back(found[1] > 0 ? found[0] / found[1] : 0);
  }
  return pixels;
}

TEST(ChannelMeans, ArePlainMeansOfWhatWasSampledInAPixel) {
  constexpr std::array<std::size_t, 2> sizes[] = {{40, 24}, {37, 19}, {1, 30}, {9, 1}};
  for (const auto& [width, height] : sizes) {
    for (const double rate : {0.02, 0.25, 1.0, 5.0}) {
      Synthesizer engine(with_means(width, height));
      std::vector<Taken> samples;
      const auto sampler = [&](const Request& request) {
        const Taken one{request.x, request.y, values_at(request.x, request.y)};
        if (!request.again) samples.push_back(one);
        return one.values;
      };
      engine.run(sampler, {.samples_per_pixel = rate});
      for (const std::size_t channel : {1u, 3u}) {
        const std::vector<float> means = engine.channel_pixels(channel);
        const std::vector<double> expected = by_rule(samples, width, height, channel);
        ASSERT_EQ(means.size(), expected.size());
        double largest = 0;
        for (const double value : expected) largest = std::max(largest, std::abs(value));
        for (std::size_t p = 0; p < means.size(); ++p) {
          EXPECT_NEAR(double{means[p]}, expected[p], 4e-7 * largest)
              << width << " x " << height << ", " << rate << ", channel " << channel << ", " << p;
        }
      }
      // What is no number here is good for the others.
      EXPECT_EQ(engine.stats().bad_samples, 0u);
      const auto ignored = std::count_if(samples.begin(), samples.end(), [](const Taken& one) {
        return !std::isfinite(one.values[3]);
      });
      EXPECT_EQ(engine.stats().ignored_bad_samples, static_cast<std::uint64_t>(ignored));
    }
  }
}

/// The means of values as large as there may be are as large, however many there are.
TEST(ChannelMeans, OfTheLargestValuesDoNotOverflow) {
  Synthesizer engine({.width = 9, .height = 8, .channel_settings = {{}, {}, {ChannelRole::mean}}});
  engine.run(
      [](double, double y) {
        return std::array<float, 3>{static_cast<float>(y), 1, 9e35f};
      },
      {.samples = 20000});
  for (const float value : engine.channel_pixels(2)) EXPECT_EQ(value, 9e35f);
}

TEST(ChannelMeans, DoNotDependOnThreadsBatchOrOrder) {
  const auto all_of = [](const Synthesizer& engine) {
    std::vector<float> all = engine.channel_pixels(1);
    for (const std::size_t channel : {2u, 3u}) {
      const std::vector<float> more = engine.channel_pixels(channel);
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  };
  const auto render = [&](std::size_t batch, std::size_t threads) {
    Synthesizer engine(with_means(61, 45));
    ThreadPool pool(threads);
    engine.run(values_at, {.samples_per_pixel = 1.5}, pool, KeepGoing{}, batch);
    return all_of(engine);
  };
  const std::vector<float> expected = render(1024, 1);
  EXPECT_EQ(render(3, 1), expected);
  EXPECT_EQ(render(64, 3), expected);
  // The other way round, one by one, with some given back.
  Synthesizer engine(with_means(61, 45));
  engine.set_stop({.samples_per_pixel = 1.5});
  std::vector<Request> requests(500);
  while (const std::size_t count = engine.request(requests)) {
    for (std::size_t i = count; i-- > 0;) {
      if (i % 5 == 4) {
        engine.give_back({&requests[i], 1});
      } else {
        engine.deliver({&requests[i], 1}, values_at(requests[i].x, requests[i].y));
      }
    }
  }
  EXPECT_EQ(all_of(engine), expected);
}

/// What is not answered is no sample.
TEST(ChannelMeans, AreThoseOfWhatWasAnswered) {
  Synthesizer engine(with_means(24, 16));
  engine.set_stop({.samples_per_pixel = 3});
  std::vector<Request> requests(50);
  std::vector<Taken> samples;
  while (const std::size_t count = engine.request(requests)) {
    for (const Request& one : std::span(requests).first(count)) {
      if (one.id % 3 == 0) {
        engine.abandon({&one, 1});
        continue;
      }
      const Taken taken{one.x, one.y, values_at(one.x, one.y)};
      engine.deliver({&one, 1}, taken.values);
      if (!one.again) samples.push_back(taken);
    }
  }
  EXPECT_GT(engine.stats().abandoned, 100u);
  const std::vector<float> means = engine.channel_pixels(1);
  const std::vector<double> expected = by_rule(samples, 24, 16, 1);
  for (std::size_t p = 0; p < means.size(); ++p) {
    EXPECT_NEAR(double{means[p]}, expected[p], 3e-5) << p;
  }
}

}  // namespace
}  // namespace freqsynth
