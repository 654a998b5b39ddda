// SPDX-License-Identifier: MIT
// Settings and stop rules of the interface for C are those of C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "c/c_helpers.h"
#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

using namespace helpers;

TEST(CSettings, EverySettingArrives) {
  const std::vector<float> importance = [] {
    std::vector<float> values(8 * 6, 1);
    values[20] = 100;
    return values;
  }();
  std::vector<float> steps(64, 0.4f);
  steps[3] = 1;
  QuantizationTarget target;
  target.steps.resize(1);
  std::copy(steps.begin(), steps.end(), target.steps[0].begin());
  const auto quantized = [&](freqsynth_settings& s) { s.quantization_steps = steps.data(); };
  using One = Setting<freqsynth_settings, SynthesisSettings>;
  const std::vector<One> all = {
      One::of_both("channels", [](auto& s) { s.channels = 2; }),
      {"noise", [](auto& s) { s.noise = FREQSYNTH_NOISE_PRESENT; },
       [](auto& s) { s.noise = Noise::present; }},
      {"list_positions", [](auto& s) { s.list_positions = FREQSYNTH_POSITIONS_LATTICE; },
       [](auto& s) { s.list.positions = SamplePositions::lattice; }},
      {"list_seed", [](auto& s) { s.list_seed = 5; }, [](auto& s) { s.list.seed = 5; }},
      {"list_samples_per_term", [](auto& s) { s.list_samples_per_term = 3; },
       [](auto& s) { s.list.samples_per_term = 3; }},
      {"list_max_terms", [](auto& s) { s.list_max_terms = 9; },
       [](auto& s) { s.list.max_terms = 9; }},
      {"measure",
       [](auto& s) {
         s.priority_measure = FREQSYNTH_MEASURE_CHANGE;
         s.priority_weight = 0.5;
         s.priority_decay = 0.6;
       },
       [](auto& s) {
         s.priority.measure = PriorityMeasure::change;
         s.priority.weight = 0.5;
         s.priority.decay = 0.6;
       }},
      {"steer",
       [](auto& s) {
         s.priority_steer = FREQSYNTH_STEER_DISPLAY;
         s.priority_exposure = 0.25;
       },
       [](auto& s) {
         s.priority.steer = Steer::display;
         s.priority.exposure = 0.25;
       }},
      {"uncertainty",
       [](auto& s) {
         s.priority_measure = FREQSYNTH_MEASURE_CHANGE;
         s.priority_uncertainty = 100;
       },
       [](auto& s) {
         s.priority.measure = PriorityMeasure::change;
         s.priority.uncertainty = 100;
       }},
      {"neighbours", [](auto& s) { s.priority_neighbours = 1; },
       [](auto& s) { s.priority.neighbours = 1; }},
      {"image", [](auto& s) { s.priority_image = 50; }, [](auto& s) { s.priority.image = 50; }},
      {"exploration", [](auto& s) { s.priority_exploration = 0.2; },
       [](auto& s) { s.priority.exploration = 0.2; }},
      {"refiner", [](auto& s) { s.refiner = FREQSYNTH_REFINER_KRIGING; },
       [](auto& s) { s.refiner = RefinerKind::kriging; }},
      One::of_both("wave", [](auto& s) { s.wave = 20; }),
      One::of_both("max_samples_per_block", [](auto& s) { s.max_samples_per_block = 90; }),
      {"importance",
       [&](auto& s) {
         s.importance = importance.data();
         s.importance_count = importance.size();
       },
       [&](auto& s) { s.importance = importance; }},
      {"quantization", quantized, [&](auto& s) { s.quantization = target; }},
      {"quantization_tolerance",
       [&](auto& s) {
         quantized(s);
         s.quantization_tolerance = 0.01;
         s.quantization_most_samples = 80;
       },
       [&](auto& s) {
         s.quantization = target;
         s.quantization->tolerance = 0.01;
         s.quantization->most_samples = 80;
       }}};
  expect_that_all_arrive(
      all, c_settings(1), cxx_settings(1),
      [](const auto& settings) { return render_in_c(settings, c_rule(6000)); },
      [](const auto& settings) { return render_in_cxx(settings, {.samples = 6000}); });
}

TEST(CSettings, RequestsComeInPackets) {
  for (const std::uint32_t packet : {1u, 16u}) {
    freqsynth_settings settings = c_settings(1);
    settings.wave = 48;
    settings.packet = packet;
    freqsynth_synthesizer* made = nullptr;
    ASSERT_EQ(freqsynth_synthesizer_create(&settings, &made), FREQSYNTH_OK);
    const Engine engine(made);
    std::array<freqsynth_request, 40> requests;
    std::size_t count = 0;
    ASSERT_EQ(freqsynth_request_samples(engine.handle, requests.data(), 40, 0, &count),
              FREQSYNTH_OK);
    EXPECT_EQ(count, packet == 16 ? 32u : 40u);
  }
}

TEST(CSettings, SeedAndWindowArrive) {
  freqsynth_settings settings = c_settings(1);
  settings.seed = 77;
  settings.wave = 30;
  settings.window_x = 16;
  settings.window_y = 8;
  settings.window_width = 24;
  settings.window_height = 16;
  freqsynth_synthesizer* made = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&settings, &made), FREQSYNTH_OK);
  const Engine engine(made);
  SynthesisSettings same = cxx_settings(1);
  same.seed = 77;
  same.wave = 30;
  same.window = {16, 8, 24, 16};
  Synthesizer expected(same);
  std::array<freqsynth_request, 40> requests;
  std::array<Request, 40> expected_requests;
  std::size_t count = 0;
  ASSERT_EQ(freqsynth_request_samples(engine.handle, requests.data(), 40, 0, &count), FREQSYNTH_OK);
  ASSERT_EQ(count, expected.request(expected_requests));
  ASSERT_GT(count, 10u);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(requests[i].x, expected_requests[i].x);
    EXPECT_EQ(requests[i].y, expected_requests[i].y);
    EXPECT_EQ(requests[i].id, expected_requests[i].id);
    EXPECT_EQ(requests[i].seed, expected_requests[i].seed);
    EXPECT_EQ(requests[i].pixel, expected_requests[i].pixel);
    EXPECT_EQ(requests[i].ordinal, expected_requests[i].ordinal);
    EXPECT_EQ(requests[i].spacing, expected_requests[i].spacing);
    EXPECT_EQ(requests[i].again, expected_requests[i].again);
  }
  freqsynth_image* image = nullptr;
  ASSERT_EQ(freqsynth_fitted_image(engine.handle, &image), FREQSYNTH_OK);
  freqsynth_image_info info;
  info.struct_size = sizeof info;
  ASSERT_EQ(freqsynth_image_get_info(image, &info), FREQSYNTH_OK);
  EXPECT_EQ(info.width, 24u);
  EXPECT_EQ(info.height, 16u);
  freqsynth_image_destroy(image);
}

TEST(CSettings, EveryStopRuleArrives) {
  const auto reason_of = [](const std::function<void(freqsynth_stop_rule&)>& change) {
    freqsynth_stop_rule rule;
    freqsynth_stop_rule_init(&rule, sizeof rule);
    change(rule);
    const freqsynth_settings settings = c_settings(1);
    const Engine engine(host_render(&settings, &rule, HOST_RUN_SERIAL));
    if (engine.handle == nullptr) return std::pair(-1, std::uint64_t{0});
    int32_t reason = 0;
    EXPECT_EQ(freqsynth_stopped(engine.handle, &reason), FREQSYNTH_OK);
    freqsynth_stats stats;
    stats.struct_size = sizeof stats;
    EXPECT_EQ(freqsynth_get_stats(engine.handle, &stats), FREQSYNTH_OK);
    return std::pair(static_cast<int>(reason), stats.samples);
  };
  EXPECT_EQ(reason_of([](auto& rule) { rule.samples = 3000; }),
            std::pair(int{FREQSYNTH_STOP_SAMPLES}, std::uint64_t{3000}));
  EXPECT_EQ(reason_of([](auto& rule) { rule.samples_per_pixel = 0.5; }),
            std::pair(int{FREQSYNTH_STOP_SAMPLES}, std::uint64_t{1350}));
  EXPECT_EQ(reason_of([](auto& rule) { rule.seconds = 0; }),
            std::pair(int{FREQSYNTH_STOP_SECONDS}, std::uint64_t{0}));
  const auto good = reason_of([](auto& rule) { rule.target_rmse = 0.02; });
  const auto fair = reason_of([](auto& rule) { rule.target_rmse = 0.1; });
  EXPECT_EQ(good.first, FREQSYNTH_STOP_TARGET_RMSE);
  EXPECT_EQ(fair.first, FREQSYNTH_STOP_TARGET_RMSE);
  EXPECT_LT(fair.second, good.second);
  const auto early = reason_of([](auto& rule) {
    rule.aliasing_threshold = 1e6;
    rule.least_samples = 1;
  });
  const auto late = reason_of([](auto& rule) { rule.aliasing_threshold = 1e6; });
  EXPECT_EQ(early.first, FREQSYNTH_STOP_THRESHOLD);
  EXPECT_EQ(late.first, FREQSYNTH_STOP_THRESHOLD);
  EXPECT_LT(early.second, late.second);
}

}  // namespace
}  // namespace freqsynth
