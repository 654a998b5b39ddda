// SPDX-License-Identifier: MIT
// RefinerKind::kriging: rules that end it, importance, and settings that are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/kriging_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::kriging_of;
using helpers::picture;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(KrigingRules, StopsByEachRule) {
  const auto run = [](const StopRule& stop) {
    Synthesizer engine(kriging_of(48, 40));
    const StopReason reason = engine.run(picture, stop).reason;
    EXPECT_EQ(engine.progress().fraction, 1);
    return std::pair{reason, engine.stats().samples};
  };
  for (const std::uint64_t samples : {0u, 1u, 29u, 777u}) {
    EXPECT_EQ(run(at_samples(samples)), (std::pair{StopReason::samples, samples}));
  }
  EXPECT_EQ(run(helpers::at_samples_per_pixel(0.5)),
            (std::pair{StopReason::samples, std::uint64_t{960}}));
  EXPECT_EQ(run({.seconds = 0}), (std::pair{StopReason::seconds, std::uint64_t{0}}));
  const auto coarse = run(helpers::at_threshold(0.01)), fine = run(helpers::at_threshold(0.001));
  EXPECT_EQ(coarse.first, StopReason::threshold);
  EXPECT_EQ(fine.first, StopReason::threshold);
  EXPECT_LT(2 * coarse.second, fine.second);
  const auto rough = run({.target_rmse = 0.1}), close = run({.target_rmse = 0.04});
  EXPECT_EQ(rough.first, StopReason::target_rmse);
  EXPECT_EQ(close.first, StopReason::target_rmse);
  EXPECT_LT(rough.second, close.second);
}

TEST(KrigingRules, ThresholdWaitsForTheLeastSamples) {
  Synthesizer engine(kriging_of(32, 32));
  engine.run([](double, double) { return 1.0f; }, {.aliasing_threshold = 0.5});
  for (const std::uint32_t count : helpers::counts_of(engine.image())) EXPECT_GE(count, 25u);
  EXPECT_LT(engine.stats().samples, 16u * 30u);
}

TEST(KrigingRules, EndsWhenAllNodesAreComplete) {
  SynthesisSettings settings = kriging_of(5, 3);
  settings.noise = Noise::present;  // one node, of 1089 samples
  Synthesizer engine(settings);
  EXPECT_EQ(engine.run(picture, StopRule{}).reason, StopReason::exhausted);
  EXPECT_EQ(engine.stats().samples, 1089u);
  Synthesizer empty(kriging_of(0, 0));
  EXPECT_EQ(empty.run(picture, StopRule{}).reason, StopReason::exhausted);
  EXPECT_EQ(empty.finished_image().width(), 0u);
}

TEST(KrigingRules, ImportanceDrawsSamples) {
  SynthesisSettings settings = kriging_of(32, 16);
  settings.importance = {1, 1, 1, 0, 1, 1, 100, 1};
  Synthesizer engine(settings);
  const auto texture = [](double x, double y) { return std::sin(3.1 * x) * std::cos(2.3 * y); };
  engine.run(texture, at_samples(1500));
  const std::vector<std::uint32_t> counts = helpers::counts_of(engine.image());
  EXPECT_LE(counts[3], 60u) << "what those beside it have on their borders";
  EXPECT_GT(counts[6], 3 * counts[0]);
  // While it goes on.
  const std::vector<float> others = {100, 1, 1, 1, 1, 1, 1, 1};
  engine.set_importance(others);
  engine.run(texture, at_samples(4000));
  EXPECT_GT(helpers::counts_of(engine.image())[0], 3 * counts[0]);
  EXPECT_THROW(engine.set_importance(std::vector<float>{1, 2}), std::invalid_argument);
}

TEST(KrigingRules, RefusesWhatItHasNoUseForByName) {
  const auto expect_refused = [](const char* name, auto change) {
    SynthesisSettings settings = kriging_of(32, 32, 2);
    change(settings);
    EXPECT_THAT([&] { Synthesizer engine(settings); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr(name), HasSubstr("RefinerKind::kriging"))));
  };
  using S = SynthesisSettings;
  expect_refused("window", [](S& s) { s.window = {0, 0, 8, 8}; });
  expect_refused("quantization", [](S& s) {
    s.quantization.emplace();
    s.quantization->steps.resize(2);
    for (auto& steps : s.quantization->steps) steps.fill(1);
  });
  expect_refused("max_samples_per_block", [](S& s) { s.max_samples_per_block = 500; });
  expect_refused("least_samples_per_block", [](S& s) { s.least_samples_per_block = 5; });
  expect_refused("list.samples_per_term", [](S& s) { s.list.samples_per_term = 2; });
  expect_refused("list.max_terms", [](S& s) { s.list.max_terms = 12; });
  expect_refused("shared_list", [](S& s) { s.shared_list = SharedInverseList(s.list); });
  expect_refused("priority.weight", [](S& s) { s.priority.weight = 0.5; });
  expect_refused("priority.uncertainty", [](S& s) { s.priority.uncertainty = 2; });
  expect_refused("priority.decay", [](S& s) { s.priority.decay = 0.5; });
  expect_refused("priority.measure", [](S& s) { s.priority.measure = PriorityMeasure::change; });
  expect_refused("priority.neighbours", [](S& s) { s.priority.neighbours = 2; });
  expect_refused("priority.image", [](S& s) { s.priority.image = 2; });
  expect_refused("role feature", [](S& s) {
    s.channel_settings = {{}, {.role = ChannelRole::feature}};
  });
  expect_refused("height", [](S& s) {
    s.width = 1;
    s.height = std::size_t{1} << 20;
  });
  SynthesisSettings settings = kriging_of(8, 8);
  settings.refiner = static_cast<RefinerKind>(7);
  EXPECT_THAT([&] { Synthesizer engine(settings); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("refiner is 7")));
}

}  // namespace
}  // namespace freqsynth
