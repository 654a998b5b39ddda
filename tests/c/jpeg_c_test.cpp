// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "c/host.h"
#include "freqsynth/c/jpeg.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth/jpeg/jpeg.h"

namespace freqsynth {
namespace {

using Bytes = std::vector<std::uint8_t>;

class JpegC : public testing::Test {
 protected:
  JpegC() : engine_({.width = 40, .height = 30}) {
    freqsynth_settings settings;
    freqsynth_settings_init(&settings, sizeof settings);
    settings.width = 40;
    settings.height = 30;
    freqsynth_stop_rule rule;
    freqsynth_stop_rule_init(&rule, sizeof rule);
    rule.samples = 2000;
    freqsynth_synthesizer* const engine = host_render(&settings, &rule, HOST_RUN_SERIAL);
    EXPECT_EQ(freqsynth_finished_image(engine, nullptr, &image_), FREQSYNTH_OK);
    freqsynth_synthesizer_destroy(engine);
    const auto sampler = [](double x, double y) {
      return std::array{host_radiance(x, y, 0), host_radiance(x, y, 1), host_radiance(x, y, 2)};
    };
    engine_.run(sampler, {.samples = 2000});
    freqsynth_jpeg_settings_init(&settings_, sizeof settings_);
  }
  ~JpegC() override { freqsynth_image_destroy(image_); }

  Bytes in_c() const {
    Bytes bytes;
    const auto write = [](void* user, const void* data, std::size_t count) {
      const auto* const first = static_cast<const std::uint8_t*>(data);
      auto& out = *static_cast<Bytes*>(user);
      out.insert(out.end(), first, first + count);
      return 0;
    };
    EXPECT_EQ(freqsynth_encode_jpeg(image_, &settings_, write, &bytes), FREQSYNTH_OK)
        << freqsynth_last_error();
    return bytes;
  }

  Bytes in_cxx(int quality, Subsampling subsampling, const JpegOptions& options,
               float exposure) const {
    const FrequencyImage encoded = encode_pixels(engine_.finished_image(), {exposure});
    const QuantizationSettings settings{.luminance = scale_table(luminance_table(), quality),
                                        .chrominance = scale_table(chrominance_table(), quality),
                                        .subsampling = subsampling};
    return encode_jpeg(quantize(encoded, settings), options);
  }

  Synthesizer engine_;
  freqsynth_image* image_ = nullptr;
  freqsynth_jpeg_settings settings_;
};

TEST_F(JpegC, FilesAreThoseOfCxx) {
  EXPECT_EQ(in_c(), in_cxx(75, Subsampling::none, {}, 1));
  settings_.quality = 40;
  settings_.half_chroma = 1;
  settings_.exposure = 0.5f;
  EXPECT_EQ(in_c(), in_cxx(40, Subsampling::both, {}, 0.5f));
  settings_.optimize = 0;
  EXPECT_EQ(in_c(), in_cxx(40, Subsampling::both, {.optimize = false}, 0.5f));
  settings_.progressive = 1;
  EXPECT_EQ(in_c(), in_cxx(40, Subsampling::both, {.progressive = true}, 0.5f));

  const auto file = std::filesystem::temp_directory_path() / "freqsynth_jpeg_c_test.jpg";
  ASSERT_EQ(freqsynth_write_jpeg(image_, &settings_, file.c_str()), FREQSYNTH_OK);
  std::ifstream stream(file, std::ios::binary);
  const Bytes written{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  EXPECT_EQ(written, in_c());
  std::filesystem::remove(file);
}

TEST_F(JpegC, EncodedSamplesAndStepsAreThoseOfCxx) {
  QuantizationSettings quantization{.luminance = scale_table(luminance_table(), 60),
                                    .chrominance = scale_table(chrominance_table(), 60),
                                    .subsampling = Subsampling::both};
  std::array<float, 192> steps;
  ASSERT_EQ(freqsynth_quantization_steps(60, 1, 3, steps.data()), FREQSYNTH_OK);
  const QuantizationTarget target = quantization_target(quantization, 3);
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i], target.steps[i / 64][i % 64]);

  std::array<float, 6> values = {0.2f, 0.5f, 0.9f, 1, 0, 0.25f}, expected = values;
  ASSERT_EQ(freqsynth_encode_display(values.data(), 2, 3, 0.5f), FREQSYNTH_OK);
  DisplayEncoding{0.5f}.encode(expected, 3);
  EXPECT_EQ(values, expected);

  // An image that is the signal already is quantised as it is.
  settings_.encoded = 1;
  settings_.quality = 60;
  settings_.half_chroma = 1;
  EXPECT_EQ(in_c(), encode_jpeg(quantize(engine_.finished_image(), quantization)));
}

TEST_F(JpegC, RefusesByName) {
  const auto refused = [](freqsynth_status status, freqsynth_status expected, const char* what) {
    EXPECT_EQ(status, expected);
    EXPECT_NE(std::string(freqsynth_last_error()).find(what), std::string::npos)
        << freqsynth_last_error();
  };
  const auto no = [](void*, const void*, std::size_t) { return 7; };
  refused(freqsynth_encode_jpeg(image_, nullptr, no, nullptr), FREQSYNTH_CALLBACK_FAILED,
          "the write callback returned 7");
  refused(freqsynth_encode_jpeg(image_, nullptr, nullptr, nullptr), FREQSYNTH_INVALID_ARGUMENT,
          "write is NULL");
  refused(freqsynth_encode_jpeg(nullptr, nullptr, no, nullptr), FREQSYNTH_INVALID_ARGUMENT,
          "image is NULL");
  refused(freqsynth_write_jpeg(image_, nullptr, nullptr), FREQSYNTH_INVALID_ARGUMENT,
          "file is NULL");
  refused(freqsynth_write_jpeg(image_, nullptr, "/nonexistent/file"), FREQSYNTH_SYSTEM_ERROR,
          "/nonexistent/file");
  settings_.quality = 0;
  refused(freqsynth_write_jpeg(image_, &settings_, "/nonexistent/file"), FREQSYNTH_INVALID_ARGUMENT,
          "quality is 0");
  settings_.quality = 75;
  settings_.exposure = 0;
  refused(freqsynth_write_jpeg(image_, &settings_, "/nonexistent/file"), FREQSYNTH_INVALID_ARGUMENT,
          "exposure is 0");
  float value = 0;
  refused(freqsynth_quantization_steps(60, 1, 3, nullptr), FREQSYNTH_INVALID_ARGUMENT,
          "steps is NULL");
  refused(freqsynth_quantization_steps(60, 1, 2, &value), FREQSYNTH_INVALID_ARGUMENT, "channels");
  refused(freqsynth_encode_display(&value, 1, 2, 1), FREQSYNTH_INVALID_ARGUMENT, "channels");
  refused(freqsynth_encode_display(nullptr, 1, 1, 1), FREQSYNTH_INVALID_ARGUMENT, "values is NULL");
  refused(freqsynth_encode_display(&value, 1, 1, std::nanf("")), FREQSYNTH_INVALID_ARGUMENT,
          "exposure is nan");
}

}  // namespace
}  // namespace freqsynth
