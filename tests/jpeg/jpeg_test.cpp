// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/jpeg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/dequantization.h"
#include "freqsynth/jpeg/jpeg_file.h"
#include "freqsynth/jpeg/quantization.h"
#include "support/jpeg_helpers.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using test::Bytes;
using test::random_quantized;
using test::random_signal;
using test::uniform_table;
using testing::ElementsAreArray;

constexpr std::array all_options = {
    JpegOptions{.progressive = false, .optimize = true},
    JpegOptions{.progressive = false, .optimize = false},
    JpegOptions{.progressive = true, .optimize = true},
};

void expect_same(const QuantizedImage& a, const QuantizedImage& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.tables, b.tables);
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t c = 0; c < a.components.size(); ++c) {
    EXPECT_EQ(a.components[c].blocks_x, b.components[c].blocks_x);
    EXPECT_EQ(a.components[c].blocks_y, b.components[c].blocks_y);
    EXPECT_EQ(a.components[c].horizontal, b.components[c].horizontal);
    EXPECT_EQ(a.components[c].vertical, b.components[c].vertical);
    EXPECT_EQ(a.components[c].table, b.components[c].table);
    EXPECT_EQ(a.components[c].values, b.components[c].values) << c;
  }
}

bool has_marker(const Bytes& bytes, std::uint8_t marker) {
  const std::array<std::uint8_t, 2> wanted{0xff, marker};
  return std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end()) != bytes.end();
}

// ----------------------------------------------------------------------------------- round trip

TEST(Jpeg, KeepsEveryCoefficientAndTable) {
  for (const auto& [width, height] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {8, 8}, {7, 9}, {17, 33}, {65, 48}, {250, 3}}) {
    for (const JpegOptions& options : all_options) {
      for (const auto& [horizontal, vertical] :
           {std::pair{1, 1}, {2, 2}, {2, 1}, {1, 2}, {4, 1}, {1, 4}, {4, 2}, {3, 2}}) {
        const QuantizedImage image = random_quantized(width, height, 3, horizontal, vertical);
        expect_same(decode_jpeg(encode_jpeg(image, options)), image);
      }
      const QuantizedImage gray = random_quantized(width, height, 1, 1, 1);
      expect_same(decode_jpeg(encode_jpeg(gray, options)), gray);
    }
  }
}

TEST(Jpeg, KeepsTheExtremesThatBaselineCanCode) {
  QuantizedImage image = random_quantized(64, 64, 3, 1, 1);
  for (QuantizedComponent& component : image.components) {
    for (std::size_t i = 0; i < component.values.size(); ++i) {
      const bool even = i / max_terms % 2 == 0;
      component.values[i] = static_cast<std::int16_t>(even ? 1023 : i % max_terms ? -1023 : -1024);
    }
  }
  for (const JpegOptions& options : all_options) {
    expect_same(decode_jpeg(encode_jpeg(image, options)), image);
  }
}

TEST(Jpeg, KeepsStepsOf16BitsAndATableForEachComponent) {
  QuantizedImage image = random_quantized(33, 17, 3, 2, 2);
  image.tables = {test::random_table(5, 65535), test::random_table(6, 65535), uniform_table(256)};
  image.components[2].table = 2;
  for (const JpegOptions& options : all_options) {
    const Bytes bytes = encode_jpeg(image, options);
    EXPECT_FALSE(has_marker(bytes, 0xc0));
    expect_same(decode_jpeg(bytes), image);
  }
}

TEST(Jpeg, KeepsMixedSamplingFactors) {
  QuantizedImage image = random_quantized(50, 50, 3, 2, 1);
  image.components[2].vertical = 2;
  // 50 pixels: 7 blocks at full resolution, 4 at half.
  for (const std::size_t c : {std::size_t{0}, std::size_t{1}}) {
    image.components[c].blocks_y = 4;
    image.components[c].values.resize(image.components[c].blocks_x * 4 * max_terms);
  }
  image.validate();
  for (const JpegOptions& options : all_options) {
    expect_same(decode_jpeg(encode_jpeg(image, options)), image);
  }
}

TEST(Jpeg, KeepsTheLargestSizes) {
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{65500, 1}, {3, 65500}}) {
    const QuantizedImage image = random_quantized(width, height, 3, 2, 2);
    expect_same(decode_jpeg(encode_jpeg(image, {.optimize = false})), image);
  }
}

TEST(Jpeg, IsAJfifFileOfTheKindAskedFor) {
  const QuantizedImage image = random_quantized(40, 40, 3, 2, 2);
  const Bytes baseline = encode_jpeg(image, {.optimize = false});
  const std::array<std::uint8_t, 11> head = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0};
  EXPECT_THAT(std::span(baseline).first(11), ElementsAreArray(head));
  EXPECT_TRUE(has_marker(baseline, 0xc0));
  EXPECT_FALSE(has_marker(baseline, 0xc2));
  EXPECT_EQ(baseline.back(), 0xd9);
  EXPECT_LT(encode_jpeg(image).size(), baseline.size());
  const Bytes progressive = encode_jpeg(image, {.progressive = true, .optimize = false});
  EXPECT_TRUE(has_marker(progressive, 0xc2));
  EXPECT_FALSE(has_marker(progressive, 0xc0));
  EXPECT_EQ(encode_jpeg(image), encode_jpeg(image));
}

// --------------------------------------------------------------------------------------- tables

TEST(Jpeg, ScaledTablesAreThoseOfLibjpeg) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  info.input_components = 3;
  info.in_color_space = JCS_YCbCr;
  jpeg_set_defaults(&info);
  for (int quality = 1; quality <= 100; ++quality) {
    jpeg_set_quality(&info, quality, TRUE);
    const QuantizationTable luminance = scale_table(luminance_table(), quality);
    const QuantizationTable chrominance = scale_table(chrominance_table(), quality);
    for (std::size_t i = 0; i < max_terms; ++i) {
      const auto place = static_cast<std::size_t>(oracle::zigzag[i]);
      EXPECT_EQ(luminance[i], info.quant_tbl_ptrs[0]->quantval[place]) << quality;
      EXPECT_EQ(chrominance[i], info.quant_tbl_ptrs[1]->quantval[place]) << quality;
    }
  }
  jpeg_destroy_compress(&info);
}

// --------------------------------------------------------------------------------- other's files

/// What libjpeg decodes is what the coefficients say, rounded and clamped to 8 bits.
void expect_pixels(const Bytes& bytes, const FrequencyImage& image, double tolerance,
                   J_DCT_METHOD method) {
  const test::DecodedPixels decoded = test::decode_pixels(bytes, method);
  const std::vector<float> pixels = reconstruct(image);
  ASSERT_EQ(decoded.width, image.width());
  ASSERT_EQ(decoded.height, image.height());
  ASSERT_EQ(decoded.values.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float shift = i % decoded.channels == 0 ? 0.0f : 128.0f;
    ASSERT_NEAR(decoded.values[i], std::clamp(pixels[i] + shift, 0.0f, 255.0f), tolerance) << i;
  }
}

/// Rounding to 8 bits; floats of libjpeg are good to about 1e-3, its integers, which the standard
/// lets be off by one level (IEEE 1180), by 0.03 as measured.
constexpr std::pair<J_DCT_METHOD, double> decoders[] = {{JDCT_FLOAT, 0.51}, {JDCT_ISLOW, 0.66}};

TEST(Jpeg, ReadsFilesOfOtherEncoders) {
  using test::Compression;
  for (const Compression& how :
       {Compression{}, Compression{.horizontal = 2, .vertical = 2},
        Compression{.horizontal = 2, .vertical = 1, .progressive = true},
        Compression{.horizontal = 4, .vertical = 1, .restart_interval = 3},
        Compression{.vertical = 2, .arithmetic = true},
        Compression{.space = JCS_GRAYSCALE, .channels = 1},
        Compression{.space = JCS_GRAYSCALE, .channels = 1, .horizontal = 2, .vertical = 2}}) {
    const Bytes bytes = test::encode_pixels_with_libjpeg(45, 27, how);
    const QuantizedImage image = decode_jpeg(bytes);
    EXPECT_EQ(image.tables[0], scale_table(luminance_table(), 80));
    expect_pixels(bytes, dequantize(image), 0.51, JDCT_FLOAT);
    expect_same(decode_jpeg(encode_jpeg(image)), image);
  }
}

// --------------------------------------------------------------------------------------- pixels

TEST(Jpeg, DecodersSeeTheDequantisedImage) {
  for (const Subsampling subsampling : {Subsampling::none, Subsampling::both}) {
    for (const auto& [width, height] :
         {std::pair<std::size_t, std::size_t>{1, 1}, {19, 29}, {64, 40}}) {
      for (const std::size_t channels : {std::size_t{1}, std::size_t{3}}) {
        const FrequencyImage image =
            random_signal(width, height, channels, CoefficientMeaning::point_function);
        QuantizationSettings settings;
        settings.subsampling = subsampling;
        const QuantizedImage quantized = quantize(image, settings);
        for (const JpegOptions& options : all_options) {
          for (const auto& [method, tolerance] : decoders) {
            expect_pixels(encode_jpeg(quantized, options), dequantize(quantized), tolerance,
                          method);
          }
        }
      }
    }
  }
}

/// From the frequency image to a decoder's pixels, against reconstruct(). The transform is
/// orthonormal: if no coefficient moves by more than half its step, the root mean square over a
/// block moves by at most |steps| / 2 / 8; rounding to 8 bits adds half a level. Errors that are
/// even in that range have a root mean square of 0.58 of it; measured, no block is above 0.48.
TEST(Jpeg, PixelsAreThoseOfReconstruct) {
  for (const int quality : {30, 75, 90, 100}) {
    const FrequencyImage image = random_signal(48, 32, 3, CoefficientMeaning::point_function);
    QuantizationSettings settings;
    settings.luminance = scale_table(luminance_table(), quality);
    settings.chrominance = scale_table(chrominance_table(), quality);
    const std::vector<float> pixels = reconstruct(image);
    const auto decoded = test::decode_pixels(encode_jpeg(quantize(image, settings)), JDCT_FLOAT);
    for (std::size_t c = 0; c < 3; ++c) {
      const QuantizationTable& table = c == 0 ? settings.luminance : settings.chrominance;
      double steps = 0;
      for (const std::uint16_t step : table) steps += double{0.25} * step * step;
      // 1.01 when all steps are 1.
      const double bound = 0.6 * (std::sqrt(steps) / 8 + 0.51);
      for (std::size_t b = 0; b < 6 * 4; ++b) {
        double squares = 0;
        for (std::size_t i = 0; i < 64; ++i) {
          const std::size_t x = b % 6 * 8 + i % 8, y = b / 6 * 8 + i / 8;
          const std::size_t place = (y * 48 + x) * 3 + c;
          const double value = pixels[place] + (c == 0 ? 0.0f : 128.0f);
          ASSERT_TRUE(value > 0 && value < 255);
          squares += std::pow(value - decoded.values[place], 2);
        }
        EXPECT_LE(std::sqrt(squares / 64), bound) << quality;
      }
    }
  }
}

TEST(Jpeg, IsWrittenToStreams) {
  const QuantizedImage image = random_quantized(20, 10, 3, 2, 1);
  std::ostringstream stream;
  write_jpeg(stream, image);
  const std::string text = stream.str();
  const Bytes bytes = encode_jpeg(image);
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), text.begin(), text.end(),
                         [](std::uint8_t a, char b) { return a == static_cast<std::uint8_t>(b); }));
  stream.setstate(std::ios::badbit);
  EXPECT_THROW(write_jpeg(stream, image), std::runtime_error);
}

}  // namespace
}  // namespace freqsynth
