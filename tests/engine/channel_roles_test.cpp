// SPDX-License-Identifier: MIT
// What channels are for: those that ride along change nothing, those of role nearest are exact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

/// An edge, a texture and a ramp. With `bad`, the first two have no usable value in places.
std::array<float, 3> rgb(double x, double y, bool bad) {
  std::array<float, 3> values{x * 0.7 + y < 40 ? 0.9f : 0.1f,
                              static_cast<float>(0.5 + 0.5 * std::sin(0.02 * x * y)),
                              static_cast<float>(3 * x + y)};
  if (bad && std::fmod(x + 3 * y, 7) < 2) values[0] = nan;
  if (bad && x > 30 && y > 20) values[1] = infinity;
  return values;
}

/// What may ride along: nothing, or anything.
float garbage(unsigned kind, double x, double y, std::uint32_t random) {
  const std::array<float, 10> all{0,
                                  nan,
                                  infinity,
                                  -infinity,
                                  1e38f,
                                  1e36f,
                                  -1e-38f,
                                  static_cast<float>(20 * x * y),
                                  y < 20 ? 0 : 1e30f,
                                  std::bit_cast<float>(random)};
  return all[std::min(kind, 9u)];
}

/// All that is known of the first three channels.
struct Outcome {
  std::vector<float> coefficients;
  std::vector<std::uint32_t> samples;
  SynthesisStats stats;
};

void expect_same(const Outcome& one, const Outcome& other, const std::string& what) {
  EXPECT_EQ(one.samples, other.samples) << what;
  EXPECT_EQ(one.coefficients, other.coefficients) << what;
  EXPECT_EQ(one.stats.samples, other.stats.samples) << what;
  EXPECT_EQ(one.stats.absorbed, other.stats.absorbed) << what;
  EXPECT_EQ(one.stats.waves, other.stats.waves) << what;
  EXPECT_EQ(one.stats.bad_samples, other.stats.bad_samples) << what;
}

struct Case {
  const char* name;
  SynthesisSettings settings;
  StopRule stop;
  bool bad = false;
};

QuantizationTarget target_of(std::size_t channels) {
  QuantizationTarget target;
  target.steps.resize(channels);
  for (auto& steps : target.steps) steps.fill(0.1f);
  return target;
}

std::vector<Case> cases() {
  const SynthesisSettings plain{.width = 60, .height = 44};
  std::vector<Case> all{{"plain", plain, {.samples_per_pixel = 2}},
                        {"bad values", plain, {.samples_per_pixel = 2}, true},
                        {"strict", plain, {.samples_per_pixel = 0.5}},
                        {"change", plain, {.samples_per_pixel = 1}},
                        {"relative", plain, {.samples_per_pixel = 1}},
                        {"display", plain, {.samples_per_pixel = 2}},
                        {"threshold", plain, {.aliasing_threshold = 0.3}},
                        {"quantizer", plain, {.samples_per_pixel = 8}}};
  all[2].settings.wave = 1;
  all[3].settings.priority.measure = PriorityMeasure::change;
  all[4].settings.priority.steer = Steer::relative;
  all[5].settings.priority.steer = Steer::display;
  all[6].stop.samples_per_pixel = 20;
  all[7].settings.quantization = target_of(3);
  return all;
}

/// Renders RGB and others of a role.
Outcome render(Case one, std::size_t others, ChannelRole role, unsigned kind) {
  if (others > 0) {
    one.settings.channels = 3 + others;
    one.settings.channel_settings.assign(3, {});
    one.settings.channel_settings.resize(3 + others, {.role = role, .weight = 7});
    const bool steps = one.settings.quantization && has_coefficients(role);
    if (steps) one.settings.quantization = target_of(3 + others);
  }
  Synthesizer engine(one.settings);
  const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const double x = requests[i].x, y = requests[i].y;
      float* out = values.data() + i * (3 + others);
      const std::array<float, 3> steering = rgb(x, y, one.bad);
      std::copy(steering.begin(), steering.end(), out);
      for (std::size_t c = 0; c < others; ++c) {
        const auto random = static_cast<std::uint32_t>(requests[i].seed >> (8 * c));
        out[3 + c] = garbage(kind + static_cast<unsigned>(c), x, y, random);
      }
    }
  };
  engine.run(sampler, one.stop);
  Outcome outcome{.coefficients = {}, .samples = {}, .stats = engine.stats()};
  for (const FrequencyImage& image : {engine.image(), engine.finished_image()}) {
    EXPECT_EQ(image.channels(), has_coefficients(role) ? 3 + others : 3);
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) {
        outcome.samples.push_back(image.samples(x, y));
        for (std::size_t c = 0; c < 3; ++c) {
          const auto own = image.coefficients(x, y, c);
          outcome.coefficients.insert(outcome.coefficients.end(), own.begin(), own.end());
        }
      }
    }
  }
  return outcome;
}

TEST(ChannelRoles, NothingThatRidesAlongChangesABit) {
  for (const Case& one : cases()) {
    const Outcome alone = render(one, 0, ChannelRole::passive, 0);
    for (unsigned kind = 0; kind < 10; ++kind) {
      const std::string what = std::string(one.name) + ", kind " + std::to_string(kind);
      expect_same(render(one, kind % 3 == 2 ? 4 : 1, ChannelRole::passive, kind), alone, what);
      if (kind % 3 == 1) {
        // Without noise features guide nothing.
        expect_same(render(one, 2, ChannelRole::feature, kind), alone, what + ", feature");
        expect_same(render(one, 2, ChannelRole::mean_feature, kind), alone,
                    what + ", mean feature");
      }
      if (kind % 3 != 0) continue;
      expect_same(render(one, 2, ChannelRole::nearest, kind), alone, what + ", nearest");
      expect_same(render(one, 2, ChannelRole::mean, kind), alone, what + ", mean");
    }
  }
}

TEST(ChannelRoles, OnlyProportionsOfWeightsMatter) {
  const auto with = [](std::vector<ChannelSettings> channels) {
    Case one = cases().front();
    one.settings.channel_settings = std::move(channels);
    return render(one, 0, ChannelRole::passive, 0);
  };
  const Outcome equal = with({});
  expect_same(with({{}, {}, {}}), equal, "1");
  expect_same(with({{.weight = 1e-30f}, {.weight = 1e-30f}, {.weight = 1e-30f}}), equal, "1e-30");
  expect_same(with({{.weight = 1e6f}, {.weight = 1e6f}, {.weight = 1e6f}}), equal, "1e6");
  EXPECT_NE(with({{.weight = 30}, {}, {}}).samples, equal.samples);
}

// ------------------------------------------------------------------------------------ nearest

/// Depth: infinite beyond a disc, and an id that names where it was sampled.
std::array<float, 3> features(double x, double y) {
  const double distance = std::hypot(x - 17, y - 9);
  return {static_cast<float>(std::sin(x)), distance < 12 ? static_cast<float>(distance) : infinity,
          static_cast<float>(static_cast<std::uint64_t>(x * 61 + y * 7919) % 16777213)};
}

struct Taken {
  double x, y;
  std::array<float, 3> values;
};

/// The rule, by looking at all samples for every pixel.
std::vector<float> by_rule(const std::vector<Taken>& samples, std::size_t width, std::size_t height,
                           std::size_t channel) {
  const auto best_of = [&](std::size_t x, std::size_t y) {
    std::optional<float> best;
    float least = 2;
    for (const Taken& one : samples) {
      const double dx = one.x - static_cast<double>(x) - 0.5;
      const double dy = one.y - static_cast<double>(y) - 0.5;
      if (std::abs(dx) > 0.5 || std::abs(dy) > 0.5 || std::isnan(one.values[channel])) continue;
      const auto distance = static_cast<float>(dx * dx + dy * dy);
      if (distance < least) best = one.values[channel];
      least = std::min(least, distance);
    }
    return best;
  };
  std::vector<std::optional<float>> own;
  for (std::size_t p = 0; p < width * height; ++p) own.push_back(best_of(p % width, p / width));
  std::vector<float> pixels;
  for (std::size_t p = 0; p < width * height; ++p) {
    const auto x = static_cast<int>(p % width), y = static_cast<int>(p / width);
    int least = 1000;
    float value = 0;
    for (int v = y / 8 * 8; v < std::min(y / 8 * 8 + 8, static_cast<int>(height)); ++v) {
      for (int u = x / 8 * 8; u < std::min(x / 8 * 8 + 8, static_cast<int>(width)); ++u) {
        const auto& there = own[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)];
        const int distance = (u - x) * (u - x) + (v - y) * (v - y);
        if (!there || distance >= least) continue;
        least = distance;
        value = *there;
      }
    }
    pixels.push_back(own[p] ? *own[p] : value);
  }
  return pixels;
}

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

SynthesisSettings with_features(std::size_t width, std::size_t height) {
  return {.width = width,
          .height = height,
          .channels = 3,
          .channel_settings = {{}, {ChannelRole::nearest}, {ChannelRole::nearest}}};
}

TEST(ChannelRoles, NearestPixelsHaveTheValueSampledNearestToTheirCentre) {
  constexpr std::array<std::size_t, 2> sizes[] = {{40, 24}, {37, 19}, {1, 30}, {9, 1}};
  for (const auto& [width, height] : sizes) {
    for (const double rate : {0.05, 0.25, 1.0, 5.0}) {
      Synthesizer engine(with_features(width, height));
      std::vector<Taken> samples;
      const auto sampler = [&](const Request& request) {
        Taken one{request.x, request.y, features(request.x, request.y)};
        if (std::fmod(one.x * one.y, 3) < 0.4) one.values[1] = nan;
        if (!request.again) samples.push_back(one);
        return one.values;
      };
      engine.run(sampler, {.samples_per_pixel = rate});
      for (const std::size_t channel : {1u, 2u}) {
        EXPECT_EQ(bits_of(engine.channel_pixels(channel)),
                  bits_of(by_rule(samples, width, height, channel)))
            << width << " x " << height << ", " << rate << ", channel " << channel;
      }
      EXPECT_EQ(engine.stats().bad_samples, 0u);
      const auto ignored = std::count_if(samples.begin(), samples.end(), [](const Taken& one) {
        return std::isnan(one.values[1]);
      });
      EXPECT_EQ(engine.stats().ignored_bad_samples, static_cast<std::uint64_t>(ignored));
    }
  }
}

TEST(ChannelRoles, InfiniteDepthIsWhereItWasSampledNearest) {
  Synthesizer engine(with_features(40, 24));
  engine.run(features, {.samples_per_pixel = 4});
  const std::vector<float> depth = engine.channel_pixels(1);
  std::size_t infinite = 0;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    const double distance =
        std::hypot(static_cast<double>(p % 40) + 0.5 - 17, static_cast<double>(p / 40) + 0.5 - 9);
    // Samples of a pixel are within .71 of its centre.
    if (distance > 12.8) {
      EXPECT_EQ(depth[p], infinity) << p;
      ++infinite;
    } else if (distance < 11.2) {
      EXPECT_NEAR(depth[p], distance, 0.71) << p;
    }
  }
  EXPECT_GT(infinite, 400u);
  EXPECT_EQ(engine.stats().ignored_bad_samples, 0u);
}

TEST(ChannelRoles, NearestPixelsDoNotDependOnThreadsBatchOrOrder) {
  const auto render = [](std::size_t batch, std::size_t threads) {
    Synthesizer engine(with_features(61, 45));
    ThreadPool pool(threads);
    engine.run(features, {.samples_per_pixel = 1.5}, pool, KeepGoing{}, batch);
    return bits_of(engine.channel_pixels(2));
  };
  const auto expected = render(1024, 1);
  EXPECT_EQ(render(3, 1), expected);
  EXPECT_EQ(render(64, 3), expected);
  // The other way round, one by one, with some given back.
  Synthesizer engine(with_features(61, 45));
  engine.set_stop({.samples_per_pixel = 1.5});
  std::vector<Request> requests(500);
  while (const std::size_t count = engine.request(requests)) {
    for (std::size_t i = count; i-- > 0;) {
      if (i % 5 == 4) {
        engine.give_back({&requests[i], 1});
      } else {
        engine.deliver({&requests[i], 1}, features(requests[i].x, requests[i].y));
      }
    }
  }
  EXPECT_EQ(bits_of(engine.channel_pixels(2)), expected);
}

TEST(ChannelRoles, OnlyThoseWithoutCoefficientsHavePixelsOfTheirOwn) {
  Synthesizer engine(with_features(16, 16));
  EXPECT_EQ(engine.channel_pixels(1), std::vector<float>(256));
  for (const std::size_t channel : {std::size_t{0}, std::size_t{3}, ~std::size_t{0}}) {
    EXPECT_THAT([&] { static_cast<void>(engine.channel_pixels(channel)); },
                testing::ThrowsMessage<std::invalid_argument>(
                    testing::HasSubstr("channel is " + std::to_string(channel))));
  }
}

}  // namespace
}  // namespace freqsynth
