// SPDX-License-Identifier: MIT
// What a host in C makes, beside the same in C++.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

constexpr std::size_t width = 60, height = 45;

/// The radiance of the host in C, of any number of channels.
void sample(std::span<const Request> requests, std::span<float> values) {
  const std::size_t channels = requests.empty() ? 0 : values.size() / requests.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Request& request = requests[i / channels];
    values[i] = host_radiance(request.x, request.y, i % channels);
  }
}

struct Engine {
  freqsynth_synthesizer* handle;
  explicit Engine(freqsynth_synthesizer* engine) : handle(engine) {}
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  ~Engine() { freqsynth_synthesizer_destroy(handle); }
};

freqsynth_settings c_settings(std::size_t channels) {
  freqsynth_settings settings;
  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = width;
  settings.height = height;
  settings.channels = channels;
  return settings;
}

SynthesisSettings cxx_settings(std::size_t channels) {
  SynthesisSettings settings;
  settings.width = width;
  settings.height = height;
  settings.channels = channels;
  return settings;
}

/// The finished picture of an engine in C.
std::vector<float> picture(const freqsynth_synthesizer* engine, std::size_t channels,
                           const freqsynth_finish_settings* finish = nullptr,
                           const freqsynth_reconstruction_settings* how = nullptr) {
  std::vector<float> pixels(width * height * channels);
  const freqsynth_pixels view = {pixels.data(), width, height, 0, 0, 0};
  EXPECT_EQ(freqsynth_finish(engine, finish, how, &view), FREQSYNTH_OK) << freqsynth_last_error();
  return pixels;
}

std::vector<float> render_in_c(const freqsynth_settings& settings,
                               const freqsynth_stop_rule& rule) {
  const Engine engine(host_render(&settings, &rule, HOST_RUN_SERIAL));
  if (engine.handle == nullptr) return {};
  return picture(engine.handle, settings.channels);
}

std::vector<float> render_in_cxx(const SynthesisSettings& settings, const StopRule& rule) {
  Synthesizer engine(settings);
  engine.run(sample, rule);
  return reconstruct(engine.finished_image());
}

freqsynth_stop_rule c_rule(std::uint64_t samples) {
  freqsynth_stop_rule rule;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples = samples;
  return rule;
}

class CWays : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(SeveralThreads, CWays,
                         testing::Values(HOST_RUN_SERIAL, HOST_RUN_POOL, HOST_RUN_EXECUTOR,
                                         HOST_RUN_STRIDED, HOST_LOOP, HOST_LOOP_STRIDED));

TEST_P(CWays, MakeThePictureOfCxxToTheBit) {
  Synthesizer expected(cxx_settings(3));
  expected.run(sample, {.samples = 9000});
  const freqsynth_settings settings = c_settings(3);
  const freqsynth_stop_rule rule = c_rule(9000);
  const Engine engine(host_render(&settings, &rule, GetParam()));
  ASSERT_NE(engine.handle, nullptr);
  EXPECT_EQ(picture(engine.handle, 3), reconstruct(expected.finished_image()));

  freqsynth_image* image = nullptr;
  ASSERT_EQ(freqsynth_fitted_image(engine.handle, &image), FREQSYNTH_OK);
  const FrequencyImage fitted = expected.image();
  for (std::size_t y = 0; y < fitted.blocks_y(); ++y) {
    for (std::size_t x = 0; x < fitted.blocks_x(); ++x) {
      std::array<float, 64> coefficients;
      std::uint32_t samples = 0;
      ASSERT_EQ(freqsynth_image_get_block(image, x, y, 1, coefficients.data(), &samples),
                FREQSYNTH_OK);
      const auto same = fitted.coefficients(x, y, 1);
      EXPECT_TRUE(std::equal(same.begin(), same.end(), coefficients.begin()));
      EXPECT_EQ(samples, fitted.samples(x, y));
    }
  }
  std::array<float, 3> value, same;
  ASSERT_EQ(freqsynth_evaluate(image, nullptr, 20.5, 11.25, value.data(), 3), FREQSYNTH_OK);
  evaluate(fitted, {}, 20.5, 11.25, same);
  EXPECT_EQ(value, same);
  freqsynth_image_destroy(image);
}

TEST(CInterface, AnswersWhatIsAsked) {
  const auto file = std::filesystem::temp_directory_path() / "freqsynth_c_interface_test.image";
  EXPECT_EQ(host_looks_around(file.c_str()), 0) << "line of host.c; " << freqsynth_last_error();
  std::filesystem::remove(file);
}

TEST(CInterface, RefusesByName) {
  int line = -1;
  // A thread of its own, on which nothing has failed yet.
  std::string said;
  std::thread([&] {
    line = host_is_refused();
    said = freqsynth_last_error();
  }).join();
  EXPECT_EQ(line, 0) << "line of refusals.c; " << said;
  EXPECT_STREQ(freqsynth_version(), FREQSYNTH_VERSION);
}

TEST(CInterface, TextsOfThreadsAreTheirOwn) {
  EXPECT_EQ(freqsynth_cancel(nullptr), FREQSYNTH_INVALID_ARGUMENT);
  std::thread([] {
    EXPECT_STREQ(freqsynth_last_error(), "");
    EXPECT_EQ(freqsynth_image_get_info(nullptr, nullptr), FREQSYNTH_INVALID_ARGUMENT);
    EXPECT_STREQ(freqsynth_last_error(), "freqsynth: image is NULL");
  }).join();
  EXPECT_STREQ(freqsynth_last_error(), "freqsynth: synthesizer is NULL");
}

TEST(CInterface, ExceptionsOfCallbacksDoNotLeaveIt) {
  // A host in C++ that calls the interface for C.
  const freqsynth_settings settings = c_settings(1);
  freqsynth_synthesizer* made = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&settings, &made), FREQSYNTH_OK);
  const Engine engine(made);
  freqsynth_run_options options;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = [](void*, const freqsynth_request*, std::size_t, float*) -> int {
    throw std::runtime_error("no texture");
  };
  EXPECT_EQ(freqsynth_run(engine.handle, nullptr, &options, nullptr), FREQSYNTH_SYSTEM_ERROR);
  EXPECT_STREQ(freqsynth_last_error(), "no texture");
  options.sampler = [](void*, const freqsynth_request*, std::size_t, float*) -> int { throw 5; };
  EXPECT_EQ(freqsynth_run(engine.handle, nullptr, &options, nullptr), FREQSYNTH_INTERNAL_ERROR);
  options.sampler = [](void*, const freqsynth_request*, std::size_t, float*) -> int {
    throw std::logic_error("a fault");
  };
  EXPECT_EQ(freqsynth_run(engine.handle, nullptr, &options, nullptr), FREQSYNTH_INTERNAL_ERROR);
  EXPECT_STREQ(freqsynth_last_error(), "a fault");
}

TEST(CInterface, RolesAndNearestPixelsAreThoseOfCxx) {
  const std::array<freqsynth_channel, 4> channels = {{{FREQSYNTH_ROLE_STEER, 2},
                                                      {FREQSYNTH_ROLE_PASSIVE, 1},
                                                      {FREQSYNTH_ROLE_FEATURE, 1},
                                                      {FREQSYNTH_ROLE_NEAREST, 1}}};
  freqsynth_settings settings = c_settings(4);
  settings.channel_settings = channels.data();
  const freqsynth_stop_rule rule = c_rule(9000);
  const Engine engine(host_render(&settings, &rule, HOST_RUN_SERIAL));
  ASSERT_NE(engine.handle, nullptr);
  SynthesisSettings same = cxx_settings(4);
  same.channel_settings = {{ChannelRole::steer, 2},
                           {ChannelRole::passive, 1},
                           {ChannelRole::feature, 1},
                           {ChannelRole::nearest, 1}};
  Synthesizer expected(same);
  expected.run(sample, {.samples = 9000});
  EXPECT_EQ(picture(engine.handle, 3), reconstruct(expected.finished_image()));

  std::vector<float> errors(width * height * 3);
  const freqsynth_pixels planes = {errors.data(), width, height, 0, 0, width * height};
  freqsynth_finish_settings finish;
  freqsynth_finish_settings_init(&finish, sizeof finish);
  finish.doubt = 1;
  ASSERT_EQ(freqsynth_error_image(engine.handle, &finish, &planes), FREQSYNTH_OK);
  FinishSettings same_finish;
  same_finish.doubt = 1;
  const std::vector<float> expected_errors = expected.error_image(same_finish);
  ASSERT_EQ(errors.size(), expected_errors.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_EQ(errors[i % 3 * width * height + i / 3], expected_errors[i]);
  }
  double rmse = 0;
  ASSERT_EQ(freqsynth_predicted_rmse(engine.handle, &finish, &rmse), FREQSYNTH_OK);
  EXPECT_EQ(rmse, expected.predicted_rmse(same_finish));
  EXPECT_GT(rmse, 0);

  // Every other float, from the bottom up.
  std::vector<float> memory(2 * width * height, -1);
  freqsynth_pixels view = {memory.data() + 2 * width * (height - 1), width, height, 2, 0, 0};
  view.row_stride = -static_cast<std::ptrdiff_t>(2 * width);
  ASSERT_EQ(freqsynth_nearest_pixels(engine.handle, 3, &view), FREQSYNTH_OK);
  const std::vector<float> ids = expected.nearest_pixels(3);
  for (std::size_t p = 0; p < ids.size(); ++p) {
    const std::size_t row = height - 1 - p / width;
    EXPECT_EQ(memory[2 * (row * width + p % width)], ids[p]);
    EXPECT_EQ(memory[2 * (row * width + p % width) + 1], -1);
  }
  EXPECT_EQ(freqsynth_nearest_pixels(engine.handle, 0, &view), FREQSYNTH_INVALID_ARGUMENT);
}

TEST(CInterface, ImportanceChangesAsInCxx) {
  std::vector<float> importance(8 * 6, 1);
  importance[10] = 50;
  const freqsynth_settings settings = c_settings(1);
  const freqsynth_stop_rule first = c_rule(2000);
  const Engine engine(host_render(&settings, &first, HOST_RUN_SERIAL));
  ASSERT_NE(engine.handle, nullptr);
  Synthesizer expected(cxx_settings(1));
  expected.run(sample, {.samples = 2000});
  EXPECT_EQ(freqsynth_set_importance(engine.handle, importance.data(), 47),
            FREQSYNTH_INVALID_ARGUMENT);
  ASSERT_EQ(freqsynth_set_importance(engine.handle, importance.data(), 48), FREQSYNTH_OK);
  expected.set_importance(importance);
  freqsynth_run_options options;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = [](void*, const freqsynth_request* requests, std::size_t count, float* values) {
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = host_radiance(requests[i].x, requests[i].y, 0);
    }
    return 0;
  };
  const freqsynth_stop_rule second = c_rule(6000);
  ASSERT_EQ(freqsynth_run(engine.handle, &second, &options, nullptr), FREQSYNTH_OK);
  expected.run(sample, {.samples = 6000});
  EXPECT_EQ(picture(engine.handle, 1), reconstruct(expected.finished_image()));
}

TEST(CInterface, SavedEnginesGoOnToTheBit) {
  const auto file = std::filesystem::temp_directory_path() / "freqsynth_c_interface_test.state";
  const freqsynth_settings settings = c_settings(2);
  const freqsynth_stop_rule first = c_rule(3000), second = c_rule(7000);
  freqsynth_synthesizer* made = nullptr;
  {
    const Engine engine(host_render(&settings, &first, HOST_LOOP));
    ASSERT_NE(engine.handle, nullptr);
    ASSERT_EQ(freqsynth_synthesizer_save(engine.handle, file.c_str()), FREQSYNTH_OK);
  }
  ASSERT_EQ(freqsynth_synthesizer_load(file.c_str(), &settings, &made), FREQSYNTH_OK)
      << freqsynth_last_error();
  const Engine engine(made);
  freqsynth_run_options options;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = [](void*, const freqsynth_request* requests, std::size_t count, float* values) {
    for (std::size_t i = 0; i < 2 * count; ++i) {
      values[i] = host_radiance(requests[i / 2].x, requests[i / 2].y, i % 2);
    }
    return 0;
  };
  ASSERT_EQ(freqsynth_run(engine.handle, &second, &options, nullptr), FREQSYNTH_OK);
  Synthesizer expected(cxx_settings(2));
  expected.run(sample, {.samples = 3000});
  expected.run(sample, {.samples = 7000});
  EXPECT_EQ(picture(engine.handle, 2), reconstruct(expected.finished_image()));

  const freqsynth_settings other = c_settings(3);
  freqsynth_synthesizer* none = nullptr;
  EXPECT_EQ(freqsynth_synthesizer_load(file.c_str(), &other, &none), FREQSYNTH_SYSTEM_ERROR);
  EXPECT_EQ(freqsynth_synthesizer_load(nullptr, &other, &none), FREQSYNTH_INVALID_ARGUMENT);
  EXPECT_EQ(freqsynth_synthesizer_load("/nonexistent/file", &other, &none), FREQSYNTH_SYSTEM_ERROR);
  EXPECT_EQ(freqsynth_synthesizer_save(nullptr, file.c_str()), FREQSYNTH_INVALID_ARGUMENT);
  EXPECT_EQ(none, nullptr);
  std::filesystem::remove(file);
}

// ------------------------------------------------------------------------------- every setting

struct Setting {
  const char* name;
  std::function<void(freqsynth_settings&)> c;
  std::function<void(SynthesisSettings&)> cxx;
};

TEST(CInterface, EverySettingArrives) {
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
  const Setting all[] = {
      {"channels", [](auto& s) { s.channels = 2; }, [](auto& s) { s.channels = 2; }},
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
      {"wave", [](auto& s) { s.wave = 20; }, [](auto& s) { s.wave = 20; }},
      {"max_samples_per_block", [](auto& s) { s.max_samples_per_block = 90; },
       [](auto& s) { s.max_samples_per_block = 90; }},
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
  const auto usual = render_in_c(c_settings(1), c_rule(6000));
  EXPECT_EQ(usual, render_in_cxx(cxx_settings(1), {.samples = 6000}));
  for (const Setting& one : all) {
    freqsynth_settings c = c_settings(1);
    SynthesisSettings cxx = cxx_settings(1);
    one.c(c);
    one.cxx(cxx);
    const auto pixels = render_in_c(c, c_rule(6000));
    EXPECT_EQ(pixels, render_in_cxx(cxx, {.samples = 6000})) << one.name;
    EXPECT_NE(pixels, usual) << one.name << " makes no difference";
  }
}

TEST(CInterface, SeedAndWindowArrive) {
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

TEST(CInterface, EveryStopRuleArrives) {
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
