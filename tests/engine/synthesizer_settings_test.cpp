// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "freqsynth/basis/shared_list.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::at_samples_per_pixel;
using helpers::counts_of;
using helpers::picture;
using helpers::Point;
using helpers::settings_of;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(SynthesizerSettings, ConstantImageIsSampledEvenly) {
  for (const float value : {0.0f, 1.0f, 0.3f, -100.1f}) {
    Synthesizer engine(settings_of(128, 128));
    engine.run([&](double, double) { return value; }, at_samples_per_pixel(2));
    const FrequencyImage image = engine.image();
    const auto counts = counts_of(image);
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    // Blocks get border samples for nothing when a neighbour is ahead: 143 to 145 were measured.
    EXPECT_LE(4 * *most, 5 * *least) << "value " << value;
    for (std::size_t b = 0; b < counts.size(); ++b) {
      EXPECT_FLOAT_EQ(image.coefficients(b % 16, b / 16, 0)[0], 8 * value);
    }
  }
}

// A pattern that repeats with the first lattices of a block looks flat there. Its neighbours, of
// other patterns, say that it may not be.
TEST(SynthesizerSettings, NeighboursKeepALuckyBlockInDoubt) {
  const auto lines = [](double x, double y) {
    const double phase = x - std::floor(x);
    if (x >= 16 && x <= 24) return phase > 0.6 && phase < 0.9 ? 0.0 : 1.0;
    return std::sin(2.1 * x) * std::cos(1.7 * y) > 0 ? 0.0 : 1.0;
  };
  const auto samples_of_the_lucky = [&](double neighbours) {
    SynthesisSettings settings = settings_of(40, 40);
    settings.priority.neighbours = neighbours;
    settings.priority.image = 0;
    settings.priority.exploration = 0;
    settings.list.positions = SamplePositions::lattice;
    Synthesizer engine(settings);
    engine.run(lines, at_samples_per_pixel(4));
    return engine.image().samples(2, 2);
  };
  // 25 samples are a lattice of 2 pixels, which sees nothing of the lines.
  EXPECT_GT(samples_of_the_lucky(16), 50u);
  EXPECT_LE(samples_of_the_lucky(0), 25u);
}

TEST(SynthesizerSettings, NoisySamplersGetPicturesFinishedForNoise) {
  for (const Noise noise : {Noise::automatic, Noise::none, Noise::present}) {
    SynthesisSettings settings = settings_of(32, 32);
    settings.noise = noise;
    Synthesizer engine(settings);
    engine.run(picture, at_samples_per_pixel(2));
    const auto finished = [&](Noise wanted) {
      return helpers::coefficients_of(engine.finished_image({.noise = wanted}));
    };
    EXPECT_EQ(finished(Noise::automatic) == finished(Noise::none), noise != Noise::present);
    EXPECT_EQ(finished(Noise::automatic) == finished(Noise::present), noise == Noise::present);
    EXPECT_EQ(engine.noisy(), noise == Noise::present);
  }
}

TEST(SynthesizerSettings, ImportanceZeroLeavesABlockAtItsFirstSample) {
  SynthesisSettings settings = settings_of(40, 40);
  settings.importance.assign(25, 1.0f);
  settings.importance[12] = 0;  // the one in the middle
  Synthesizer engine(settings);
  for (const auto& [x, y] : helpers::asked_points(engine, at_samples(3000), picture)) {
    EXPECT_FALSE(x > 16 && x < 24 && y > 16 && y < 24) << x << ", " << y;
  }
  EXPECT_GE(engine.image().samples(2, 2), 1u);
}

TEST(SynthesizerSettings, ImportanceZeroEverywhereTakesOneSamplePerBlock) {
  SynthesisSettings settings = settings_of(40, 40);
  settings.importance.assign(25, 0.0f);
  Synthesizer engine(settings);
  EXPECT_EQ(engine.run(picture, StopRule{}).reason, StopReason::threshold);
  EXPECT_EQ(engine.stats().samples, 25u);
}

/// A fine pattern that no block can settle.
double busy(double x, double y) { return std::sin(3 * x) * std::cos(2.3 * y); }

/// Samples of the left and of the right half of an image of 8 x 4 blocks, without the columns that
/// meet.
std::pair<std::uint64_t, std::uint64_t> halves(const FrequencyImage& image) {
  std::uint64_t left = 0, right = 0;
  for (std::size_t y = 0; y < 4; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      left += image.samples(x, y);
      right += image.samples(x + 5, y);
    }
  }
  return {left, right};
}

TEST(SynthesizerSettings, ImportantBlocksGetMoreSamples) {
  SynthesisSettings settings = settings_of(64, 32);
  for (int b = 0; b < 32; ++b) settings.importance.push_back(b % 8 < 4 ? 16.0f : 1.0f);
  settings.priority.exploration = 0;
  Synthesizer engine(settings);
  // Equally busy everywhere.
  engine.run(busy, at_samples(2000));
  const auto [left, right] = halves(engine.image());
  EXPECT_GT(left, 9 * right / 2) << "5.8 times as many were measured";
}

TEST(SynthesizerSettings, ChannelWeightsChooseWhatMatters) {
  const auto sampled_with = [](std::vector<ChannelSettings> channels) {
    SynthesisSettings settings = settings_of(64, 32, 2);
    settings.channel_settings = std::move(channels);
    settings.priority.exploration = 0;
    Synthesizer engine(settings);
    // The first channel varies in the left three columns, the second one in the right ones.
    engine.run(
        [](double x, double y) {
          return std::array{x < 24 ? busy(x, y) : 0, x > 40 ? busy(x, y) : 0};
        },
        at_samples(2000));
    return halves(engine.image());
  };
  const auto first = sampled_with({{}, {ChannelRole::passive}});
  const auto second = sampled_with({{ChannelRole::passive}, {}});
  // 6.8 and 6.7 times as many were measured: flat blocks end their steps, too.
  EXPECT_GT(first.first, 6 * first.second);
  EXPECT_GT(second.second, 6 * second.first);
  EXPECT_EQ(sampled_with({{.weight = 0.5f}, {.weight = 0.5f}}), sampled_with({}))
      << "equal weights are the default";
}

TEST(SynthesizerSettings, ImagesMayShareAList) {
  InverseListSettings list_settings;
  list_settings.samples_per_term = 2;
  list_settings.seed = 5;
  SynthesisSettings own = settings_of(48, 32);
  own.list = list_settings;
  SynthesisSettings shared = settings_of(48, 32);
  shared.shared_list = SharedInverseList(list_settings);
  Synthesizer reference(own), first(shared), second(shared);
  EXPECT_EQ(first.settings().shared_list, shared.shared_list);
  for (Synthesizer* engine : {&reference, &first, &second}) {
    engine->run(picture, at_samples(1500));
  }
  EXPECT_TRUE(helpers::same_image(first.image(), reference.image()));
  EXPECT_TRUE(helpers::same_image(second.image(), reference.image()));
}

TEST(SynthesizerSettings, ListSettingsMatter) {
  Synthesizer usual(settings_of(48, 32));
  usual.run(picture, at_samples(1500));
  for (const bool seed : {true, false}) {
    SynthesisSettings settings = settings_of(48, 32);
    (seed ? settings.list.seed : settings.list.max_terms) = 6;
    Synthesizer engine(settings);
    engine.run(picture, at_samples(1500));
    EXPECT_FALSE(helpers::same_image(engine.image(), usual.image()));
  }
}

TEST(SynthesizerSettings, ImagesWithoutBlocksNeedNoSample) {
  for (const auto& [width, height] : {std::pair{0, 0}, {0, 5}, {5, 0}}) {
    Synthesizer engine(
        settings_of(static_cast<std::size_t>(width), static_cast<std::size_t>(height)));
    const auto points = helpers::asked_points(engine, StopRule{}, picture);
    EXPECT_TRUE(points.empty());
    EXPECT_EQ(engine.stopped(), StopReason::exhausted);
    std::vector<Request> requests(3);
    EXPECT_EQ(engine.request(requests), 0u);
    EXPECT_EQ(engine.stats().blocks, 0u);
    EXPECT_EQ(engine.image().blocks_x() * engine.image().blocks_y(), 0u);
  }
}

TEST(SynthesizerSettings, AllFormsOfSamplersGiveTheSameImage) {
  constexpr std::size_t samples = 1200;
  const auto value = [](double x, double y) { return picture(x, y); };
  Synthesizer scalar(settings_of(32, 32)), wide(settings_of(32, 32)), array(settings_of(32, 32));
  Synthesizer batch(settings_of(32, 32)), function(settings_of(32, 32));
  scalar.run(value, at_samples(samples));
  wide.run([&](double x, double y) { return double{value(x, y)}; }, at_samples(samples));
  array.run([&](double x, double y) { return std::array<double, 1>{value(x, y)}; },
            at_samples(samples));
  function.run(picture, at_samples(samples));
  const auto fill = [&](std::span<const Request> requests, std::span<float> values) {
    ASSERT_EQ(requests.size(), values.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
      values[i] = value(requests[i].x, requests[i].y);
    }
  };
  batch.run(fill, at_samples(samples));
  for (const Synthesizer* other : {&wide, &array, &batch, &function}) {
    EXPECT_TRUE(helpers::same_image(other->image(), scalar.image()));
  }
}

TEST(SynthesizerSettings, BatchSamplersGetAllChannelsOfARequestTogether) {
  Synthesizer batch(settings_of(32, 24, 3)), scalar(settings_of(32, 24, 3));
  scalar.run(
      [](double x, double y) {
        return std::array{picture(x, y), picture(y, x), static_cast<float>(x)};
      },
      at_samples(700));
  batch.run(
      [](std::span<const Request> requests, std::span<float> values) {
        ASSERT_EQ(values.size(), 3 * requests.size());
        for (const Request& request : requests) {
          values[0] = picture(request.x, request.y);
          values[1] = picture(request.y, request.x);
          values[2] = static_cast<float>(request.x);
          values = values.subspan(3);
        }
      },
      at_samples(700));
  EXPECT_TRUE(helpers::same_image(batch.image(), scalar.image()));
}

TEST(SynthesizerSettings, WrongSettingsAreNamed) {
  const auto refuses = [](const std::function<void(SynthesisSettings&)>& change,
                          const std::string& field, const std::string& value) {
    SynthesisSettings settings = settings_of(16, 24, 2);  // 6 blocks
    change(settings);
    EXPECT_THAT([&] { Synthesizer engine(settings); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(field), HasSubstr(value))));
  };
  const std::size_t huge = std::numeric_limits<std::size_t>::max();
  refuses([](auto& s) { s.channels = 0; }, "channel", "0");
  refuses([&](auto& s) { s.width = s.height = huge; }, "image", std::to_string(huge));
  refuses([&](auto& s) { s.width = huge; }, "image", std::to_string(huge));
  refuses([&](auto& s) { s.channels = huge; }, "channels", std::to_string(huge));
  refuses([](auto& s) { s.width = s.height = std::size_t{1} << 20; }, "image", "1048576");
  refuses([](auto& s) { s.list.samples_per_term = 0.5; }, "samples_per_term", "0.5");
  refuses([](auto& s) { s.list.max_terms = 65; }, "max_terms", "65");
  refuses([](auto& s) { s.priority.weight = 0; }, "weight", "0");
  refuses([](auto& s) { s.priority.uncertainty = -1; }, "uncertainty", "-1");
  refuses([](auto& s) { s.priority.decay = 1.5; }, "decay", "1.5");
  refuses([](auto& s) { s.priority.neighbours = -2; }, "neighbours", "-2");
  refuses([](auto& s) { s.priority.image = -3; }, "image", "-3");
  refuses([](auto& s) { s.priority.exposure = 0; }, "priority.exposure", "0");
  refuses([](auto& s) { s.priority.steer = static_cast<Steer>(7); }, "priority.steer", "7");
  refuses([](auto& s) { s.packet = 0; }, "packet", "0");
  refuses([](auto& s) { s.packet = 1048577; }, "packet", "1048577");
  refuses([](auto& s) { s.max_samples_per_block = 0; }, "max_samples_per_block", "0");
  refuses([](auto& s) { s.max_samples_per_block = 1050626; }, "max_samples_per_block", "1050626");
  const auto weighs = [](auto& s, float weight) { s.channel_settings = {{}, {.weight = weight}}; };
  refuses([](auto& s) { s.channel_settings.resize(3); }, "channel_settings", "3");
  refuses([=](auto& s) { weighs(s, -2); }, "channel_settings' weights", "-2");
  refuses([=](auto& s) { weighs(s, 0); }, "channel_settings' weights", "0");
  refuses([=](auto& s) { weighs(s, nan); }, "channel_settings' weights", "nan");
  refuses(
      [](auto& s) {
        s.channel_settings = {{}, {static_cast<ChannelRole>(7)}};
      },
      "channel_settings' roles", "7");
  refuses(
      [](auto& s) {
        s.channel_settings = {{ChannelRole::nearest}, {}};
      },
      "channel_settings has the role nearest for channel", "0");
  refuses(
      [](auto& s) {
        s.channel_settings = {{ChannelRole::mean}, {}};
      },
      "channel_settings has the role mean for channel", "0");
  refuses([](auto& s) { s.channel_settings.assign(2, {ChannelRole::nearest}); },
          "channel_settings has", "2");
  refuses([](auto& s) { s.importance = {1, 1}; }, "importance", "2");
  refuses([](auto& s) { s.importance = {1, 1, 1, 1, 1, -3}; }, "importance", "-3");
  refuses([](auto& s) { s.importance = {1, 1, nan, 1, 1, 1}; }, "importance", "nan");
}

TEST(SynthesizerSettings, WrongStopRulesAreNamedAndChangeNothing) {
  Synthesizer engine(settings_of(16, 16));
  engine.set_stop(at_samples(5));
  const auto refuses = [&](const StopRule& stop, const char* field, const char* value) {
    const auto message =
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(field), HasSubstr(value)));
    EXPECT_THAT([&] { engine.set_stop(stop); }, message);
    EXPECT_THAT([&] { engine.run(picture, stop); }, message);
  };
  refuses(at_samples_per_pixel(-0.5), "samples_per_pixel", "-0.5");
  refuses(at_samples_per_pixel(nan), "samples_per_pixel", "nan");
  refuses(helpers::at_threshold(-2), "aliasing_threshold", "-2");
  refuses(helpers::at_threshold(nan), "aliasing_threshold", "nan");
  std::vector<Request> requests(10);
  EXPECT_LE(engine.request(requests), 5u) << "the rule before holds";
  EXPECT_EQ(engine.stats().samples, 0u);
}

TEST(SynthesizerSettings, SamplerMustReturnAllChannels) {
  Synthesizer engine(settings_of(16, 16, 3));
  EXPECT_THAT([&] { engine.run(picture, at_samples(5)); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("1"), HasSubstr("3"))));
  const auto pair = [](double x, double y) { return std::array{x, y}; };
  EXPECT_THAT([&] { engine.run(pair, at_samples(5)); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("2"), HasSubstr("3"))));
  EXPECT_EQ(engine.stats().samples, 0u);
}

TEST(SynthesizerSettings, BatchMustNotBeEmpty) {
  Synthesizer engine(settings_of(16, 16));
  EXPECT_THAT([&] { engine.run(picture, at_samples(5), SerialExecutor{}, KeepGoing{}, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("batch is 0")));
}

}  // namespace
}  // namespace freqsynth
