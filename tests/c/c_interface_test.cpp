// SPDX-License-Identifier: MIT
// What a host in C makes, beside the same in C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "c/c_helpers.h"
#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

using namespace helpers;

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

TEST(CInterface, RolesAndTheirPixelsAreThoseOfCxx) {
  const std::array<freqsynth_channel, 5> channels = {{{FREQSYNTH_ROLE_STEER, 2},
                                                      {FREQSYNTH_ROLE_PASSIVE, 1},
                                                      {FREQSYNTH_ROLE_FEATURE, 1},
                                                      {FREQSYNTH_ROLE_NEAREST, 1},
                                                      {FREQSYNTH_ROLE_MEAN, 1}}};
  freqsynth_settings settings = c_settings(5);
  settings.channel_settings = channels.data();
  const freqsynth_stop_rule rule = c_rule(9000);
  const Engine engine(host_render(&settings, &rule, HOST_RUN_SERIAL));
  ASSERT_NE(engine.handle, nullptr);
  SynthesisSettings same = cxx_settings(5);
  same.channel_settings = {{ChannelRole::steer, 2},
                           {ChannelRole::passive, 1},
                           {ChannelRole::feature, 1},
                           {ChannelRole::nearest, 1},
                           {ChannelRole::mean, 1}};
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
  ASSERT_EQ(freqsynth_channel_pixels(engine.handle, 3, &view), FREQSYNTH_OK);
  const std::vector<float> ids = expected.channel_pixels(3);
  for (std::size_t p = 0; p < ids.size(); ++p) {
    const std::size_t row = height - 1 - p / width;
    EXPECT_EQ(memory[2 * (row * width + p % width)], ids[p]);
    EXPECT_EQ(memory[2 * (row * width + p % width) + 1], -1);
  }
  std::vector<float> means(width * height);
  const freqsynth_pixels packed = {means.data(), width, height, 0, 0, 0};
  ASSERT_EQ(freqsynth_channel_pixels(engine.handle, 4, &packed), FREQSYNTH_OK);
  EXPECT_EQ(means, expected.channel_pixels(4));
  EXPECT_EQ(freqsynth_channel_pixels(engine.handle, 0, &view), FREQSYNTH_INVALID_ARGUMENT);
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

}  // namespace
}  // namespace freqsynth
