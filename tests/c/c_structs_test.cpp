// SPDX-License-Identifier: MIT
// Structs of the interface for C: what is in them, and programs that know less or more of it.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <functional>
#include <vector>

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

  std::vector<float> in_c(const freqsynth_finish_settings* finish,
                          const freqsynth_reconstruction_settings* how) const {
    std::vector<float> pixels(width * height);
    const freqsynth_pixels view = {pixels.data(), width, height, 0, 0, 0};
    EXPECT_EQ(freqsynth_finish(handle_, finish, how, &view), FREQSYNTH_OK)
        << freqsynth_last_error();
    return pixels;
  }

  Synthesizer engine_;
  freqsynth_synthesizer* handle_ = nullptr;
};

TEST_F(CFinish, EverySettingArrives) {
  struct Setting {
    const char* name;
    std::function<void(freqsynth_finish_settings&)> c;
    std::function<void(FinishSettings&)> cxx;
  };
  const Setting all[] = {
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
      {"shrinkage", [](auto& s) { s.shrinkage = 0; }, [](auto& s) { s.shrinkage = 0; }},
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
  const auto usual = in_c(nullptr, nullptr);
  EXPECT_EQ(usual, reconstruct(engine_.finished_image()));
  for (const Setting& one : all) {
    freqsynth_finish_settings c;
    freqsynth_finish_settings_init(&c, sizeof c);
    FinishSettings cxx;
    one.c(c);
    one.cxx(cxx);
    const auto pixels = in_c(&c, nullptr);
    EXPECT_EQ(pixels, reconstruct(engine_.finished_image(cxx))) << one.name;
    EXPECT_NE(pixels, usual) << one.name << " makes no difference";
  }
}

TEST_F(CFinish, EverySettingOfReconstructionArrives) {
  struct Setting {
    const char* name;
    std::function<void(freqsynth_reconstruction_settings&)> c;
    std::function<void(ReconstructionSettings&)> cxx;
  };
  const Setting all[] = {
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
  const auto usual = in_c(nullptr);
  for (const Setting& one : all) {
    freqsynth_reconstruction_settings c;
    freqsynth_reconstruction_settings_init(&c, sizeof c);
    ReconstructionSettings cxx;
    one.c(c);
    one.cxx(cxx);
    std::vector<float> expected(70 * 50);
    reconstruct(engine_.image(), cxx, {expected.data(), 70, 50});
    const auto pixels = in_c(&c);
    EXPECT_EQ(pixels, expected) << one.name;
    EXPECT_NE(pixels, usual) << one.name << " makes no difference";
  }
  freqsynth_image_destroy(image);
}

TEST(CStructs, RequestsAreThoseOfCxx) {
  EXPECT_EQ(sizeof(freqsynth_request), 64u);
  EXPECT_EQ(sizeof(freqsynth_request), sizeof(Request));
  EXPECT_EQ(offsetof(freqsynth_request, again), 56u);
  EXPECT_EQ(sizeof(freqsynth_bad_sample), 24u);
  EXPECT_EQ(sizeof(freqsynth_channel), 8u);
}

TEST(CStructs, OfAnOlderProgramHaveDefaultsBehindTheirEnd) {
  freqsynth_settings settings;
  std::memset(&settings, 0xee, sizeof settings);
  freqsynth_settings_init(&settings, offsetof(freqsynth_settings, wave));
  EXPECT_EQ(settings.struct_size, offsetof(freqsynth_settings, wave));
  unsigned char untouched[sizeof settings.wave];
  std::memset(untouched, 0xee, sizeof untouched);
  EXPECT_EQ(std::memcmp(&settings.wave, untouched, sizeof untouched), 0) << "not its memory";
  settings.width = settings.height = 24;
  freqsynth_synthesizer* engine = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&settings, &engine), FREQSYNTH_OK)
      << freqsynth_last_error();
  // Results are not written beyond what it knows.
  freqsynth_stats stats;
  std::memset(&stats, 0xee, sizeof stats);
  stats.struct_size = offsetof(freqsynth_stats, waves);
  ASSERT_EQ(freqsynth_get_stats(engine, &stats), FREQSYNTH_OK);
  EXPECT_EQ(stats.samples, 0u);
  EXPECT_EQ(stats.waves, 0xeeeeeeeeeeeeeeeeu);
  stats.struct_size = 3;
  EXPECT_EQ(freqsynth_get_stats(engine, &stats), FREQSYNTH_INVALID_ARGUMENT);
  freqsynth_synthesizer_destroy(engine);
}

TEST(CStructs, OfANewerProgramAreReadUnlessTheySayMore) {
  struct Newer {
    freqsynth_settings settings;
    double more;
  } newer;
  std::memset(&newer, 0xee, sizeof newer);
  freqsynth_settings_init(&newer.settings, sizeof newer);
  EXPECT_EQ(newer.settings.struct_size, sizeof newer);
  EXPECT_EQ(newer.more, 0);
  newer.settings.width = newer.settings.height = 24;
  freqsynth_synthesizer* engine = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&newer.settings, &engine), FREQSYNTH_OK);
  struct NewerStats {
    freqsynth_stats stats;
    std::uint64_t more;
  } stats;
  std::memset(&stats, 0xee, sizeof stats);
  stats.stats.struct_size = sizeof stats;
  ASSERT_EQ(freqsynth_get_stats(engine, &stats.stats), FREQSYNTH_OK);
  EXPECT_EQ(stats.stats.blocks, 9u);
  EXPECT_EQ(stats.more, 0u);
  freqsynth_synthesizer_destroy(engine);
  newer.more = 1;
  EXPECT_EQ(freqsynth_synthesizer_create(&newer.settings, &engine), FREQSYNTH_INVALID_ARGUMENT);
  EXPECT_STREQ(freqsynth_last_error(), "freqsynth: settings has members of a newer version");
}

}  // namespace
}  // namespace freqsynth
