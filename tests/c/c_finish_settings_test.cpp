// SPDX-License-Identifier: MIT
// Settings of finished and reconstructed pictures in the interface for C are those of C++.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "c/c_helpers.h"
#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

/// A picture with noise, as of a Monte Carlo renderer, and edges.
float noisy(const Request& request) {
  const auto random = static_cast<float>(request.seed >> 40) * 0x1p-24f;
  return host_radiance(request.x, request.y, 0) * (0.5f + random);
}

class CFinish : public testing::Test {
 protected:
  static constexpr std::size_t width = 48, height = 40;

  CFinish() : engine_({.width = width, .height = height, .channels = 1}) {
    engine_.run(noisy, {.samples_per_pixel = 3});
    freqsynth_settings settings;
    freqsynth_settings_init(&settings, sizeof settings);
    settings.width = width;
    settings.height = height;
    settings.channels = 1;
    EXPECT_EQ(freqsynth_synthesizer_create(&settings, &handle_), FREQSYNTH_OK);
    freqsynth_run_options options;
    freqsynth_run_options_init(&options, sizeof options);
    options.sampler = [](void*, const freqsynth_request* requests, std::size_t count,
                         float* values) {
      for (std::size_t i = 0; i < count; ++i) {
        Request request;
        request.x = requests[i].x;
        request.y = requests[i].y;
        request.seed = requests[i].seed;
        values[i] = noisy(request);
      }
      return 0;
    };
    freqsynth_stop_rule rule;
    freqsynth_stop_rule_init(&rule, sizeof rule);
    rule.samples_per_pixel = 3;
    EXPECT_EQ(freqsynth_run(handle_, &rule, &options, nullptr), FREQSYNTH_OK);
  }
  ~CFinish() override { freqsynth_synthesizer_destroy(handle_); }

  std::vector<float> in_c(const freqsynth_finish_settings* finish) const {
    std::vector<float> pixels(width * height);
    const freqsynth_pixels view = {pixels.data(), width, height, 0, 0, 0};
    EXPECT_EQ(freqsynth_finish(handle_, finish, nullptr, &view), FREQSYNTH_OK)
        << freqsynth_last_error();
    return pixels;
  }

  Synthesizer engine_;
  freqsynth_synthesizer* handle_ = nullptr;
};

TEST_F(CFinish, EverySettingArrives) {
  using One = helpers::Setting<freqsynth_finish_settings, FinishSettings>;
  const std::vector<One> all = {
      {"butterworth", [](auto& s) { s.butterworth = 0; },
       [](auto& s) { s.butterworth.enabled = false; }},
      {"cutoff", [](auto& s) { s.butterworth_cutoff = 0.5; },
       [](auto& s) { s.butterworth.cutoff = 0.5; }},
      {"order", [](auto& s) { s.butterworth_order = 1; }, [](auto& s) { s.butterworth.order = 1; }},
      {"residuals", [](auto& s) { s.residuals = 0; }, [](auto& s) { s.residuals = false; }},
      {"noise", [](auto& s) { s.noise = FREQSYNTH_NOISE_NONE; },
       [](auto& s) { s.noise = Noise::none; }},
      {"doubt",
       [](auto& s) {
         s.noise = FREQSYNTH_NOISE_NONE;
         s.doubt = 2;
       },
       [](auto& s) {
         s.noise = Noise::none;
         s.doubt = 2;
       }},
      {"noisy_doubt",
       [](auto& s) {
         s.measure_doubt = 0;
         s.noisy_doubt = 7;
       },
       [](auto& s) {
         s.measure_doubt = false;
         s.noisy_doubt = 7;
       }},
      One::of_both("shrinkage", [](auto& s) { s.shrinkage = 0; }),
      {"slack",
       [](auto& s) {
         s.noise = FREQSYNTH_NOISE_NONE;
         s.slack = 0;
       },
       [](auto& s) {
         s.noise = Noise::none;
         s.slack = 0;
       }},
      {"smooth_noise", [](auto& s) { s.smooth_noise = 0; },
       [](auto& s) { s.smooth_noise = false; }},
      {"ringing",
       [](auto& s) {
         s.noise = FREQSYNTH_NOISE_NONE;
         s.ringing = 0.5;
       },
       [](auto& s) {
         s.noise = Noise::none;
         s.ringing = 0.5;
       }},
      {"keep_positive",
       [](auto& s) {
         s.residuals = 0;
         s.keep_positive = 0;
       },
       [](auto& s) {
         s.residuals = false;
         s.keep_positive = false;
       }}};
  freqsynth_finish_settings usual;
  freqsynth_finish_settings_init(&usual, sizeof usual);
  EXPECT_EQ(in_c(nullptr), in_c(&usual));
  helpers::expect_that_all_arrive(
      all, usual, FinishSettings(), [&](const auto& settings) { return in_c(&settings); },
      [&](const auto& settings) { return reconstruct(engine_.finished_image(settings)); });
}

TEST_F(CFinish, EverySettingOfReconstructionArrives) {
  using One = helpers::Setting<freqsynth_reconstruction_settings, ReconstructionSettings>;
  const std::vector<One> all = {
      {"butterworth", [](auto& s) { s.butterworth = 0; },
       [](auto& s) { s.butterworth.enabled = false; }},
      {"cutoff", [](auto& s) { s.butterworth_cutoff = 0.5; },
       [](auto& s) { s.butterworth.cutoff = 0.5; }},
      {"order", [](auto& s) { s.butterworth_order = 1; }, [](auto& s) { s.butterworth.order = 1; }},
      {"none", [](auto& s) { s.pixel_filter = FREQSYNTH_FILTER_NONE; },
       [](auto& s) { s.pixel_filter = PixelFilter::none; }},
      {"tent",
       [](auto& s) {
         s.pixel_filter = FREQSYNTH_FILTER_TENT;
         s.filter_radius = 2;
       },
       [](auto& s) {
         s.pixel_filter = PixelFilter::tent;
         s.filter_shape.radius = 2;
       }},
      {"gaussian",
       [](auto& s) {
         s.pixel_filter = FREQSYNTH_FILTER_GAUSSIAN;
         s.filter_sigma = 0.7;
       },
       [](auto& s) {
         s.pixel_filter = PixelFilter::gaussian;
         s.filter_shape.sigma = 0.7;
       }},
      {"blackman_harris", [](auto& s) { s.pixel_filter = FREQSYNTH_FILTER_BLACKMAN_HARRIS; },
       [](auto& s) { s.pixel_filter = PixelFilter::blackman_harris; }},
      {"mitchell",
       [](auto& s) {
         s.pixel_filter = FREQSYNTH_FILTER_MITCHELL;
         s.filter_b = 0;
         s.filter_c = 0.75;
       },
       [](auto& s) {
         s.pixel_filter = PixelFilter::mitchell;
         s.filter_shape.b = 0;
         s.filter_shape.c = 0.75;
       }},
      {"clamp_negative",
       [](auto& s) {
         s.butterworth = 0;
         s.clamp_negative = 1;
       },
       [](auto& s) {
         s.butterworth.enabled = false;
         s.clamp_negative = true;
       }}};
  freqsynth_image* image = nullptr;
  ASSERT_EQ(freqsynth_fitted_image(handle_, &image), FREQSYNTH_OK);
  const auto in_c = [&](const freqsynth_reconstruction_settings* how) {
    std::vector<float> pixels(70 * 50);
    const freqsynth_pixels view = {pixels.data(), 70, 50, 0, 0, 0};
    EXPECT_EQ(freqsynth_reconstruct(image, how, &view), FREQSYNTH_OK) << freqsynth_last_error();
    return pixels;
  };
  freqsynth_reconstruction_settings usual;
  freqsynth_reconstruction_settings_init(&usual, sizeof usual);
  EXPECT_EQ(in_c(nullptr), in_c(&usual));
  helpers::expect_that_all_arrive(
      all, usual, ReconstructionSettings(), [&](const auto& settings) { return in_c(&settings); },
      [&](const auto& settings) {
        std::vector<float> pixels(70 * 50);
        reconstruct(engine_.image(), settings, {pixels.data(), 70, 50});
        return pixels;
      });
  freqsynth_image_destroy(image);
}

}  // namespace
}  // namespace freqsynth
