// SPDX-License-Identifier: MIT
#include "freqsynth/jpeg/display_encoding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using oracle::Real;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float largest = std::numeric_limits<float>::max();

/// IEC 61966-2-1, in 0..255.
Real srgb(Real linear) {
  linear = std::clamp(linear, Real{0}, Real{1});
  return 255 *
         (linear <= 0.0031308L ? 12.92L * linear : 1.055L * std::pow(linear, 1 / 2.4L) - 0.055L);
}

/// A few roundings of numbers up to 255, and those of a power whose exponent was rounded: a
/// relative change of 1e-7 of the exponent, times the logarithm of at least 0.0031. Measured: 2.7
/// roundings of 255.
constexpr double tolerance = 255 * 3.4 * oracle::float_rounding;

TEST(DisplayEncoding, DecodesWhatItEncoded) {
  for (const float exposure : {1.0f, 0.25f, 8.0f}) {
    const DisplayEncoding encoding{exposure};
    for (int i = 0; i <= 1000; ++i) {
      const float linear = static_cast<float>(i) / (1000 * exposure);
      // The encoding is steepest at 0, 12.92, and flattest at 1, 0.44: its inverse enlarges errors
      // by 2.3. Measured: 3 roundings of the largest.
      ASSERT_NEAR(encoding.decode(encoding.encode(linear)), linear,
                  3.75 * oracle::float_rounding / exposure)
          << linear;
    }
    EXPECT_EQ(encoding.decode(-1), 0);
    EXPECT_EQ(encoding.decode(300), 1 / exposure);
    EXPECT_TRUE(std::isnan(encoding.decode(not_a_number)));
  }
}

TEST(DisplayEncoding, IsTheClosedFormOfSrgb) {
  for (const float exposure : {1.0f, 0.25f, 8.0f}) {
    const DisplayEncoding encoding{exposure};
    for (int i = -100; i <= 20000; ++i) {
      const float linear = static_cast<float>(i) * 1e-4f;
      ASSERT_NEAR(encoding.encode(linear),
                  static_cast<double>(srgb(static_cast<Real>(linear * exposure))), tolerance)
          << linear;
    }
  }
}

TEST(DisplayEncoding, NeverFallsAndStaysWithinItsLimits) {
  const DisplayEncoding encoding;
  float last = encoding.encode(0.0f);
  EXPECT_EQ(last, 0.0f);
  const auto step = [&](float linear, float slack) {
    const float value = encoding.encode(linear);
    EXPECT_GE(value, last - slack) << linear;
    EXPECT_LE(value, 255.0f) << linear;
    last = std::max(value, last);
  };
  // All floats near the joint of the two curves, which in the standard itself do not quite meet;
  // then one in about 500.
  float linear = 0.00313f;
  for (; linear < 0.003132f; linear = std::nextafter(linear, 1.0f)) step(linear, 1e-5f);
  for (; linear < 1.5f; linear += linear * 6e-5f) step(linear, 0);
  EXPECT_FLOAT_EQ(encoding.encode(1.0f), 255);
  EXPECT_EQ(encoding.encode(1.0f), encoding.encode(largest));
  EXPECT_EQ(encoding.encode(-1.0f), 0.0f);
  EXPECT_EQ(encoding.encode(-largest), 0.0f);
  EXPECT_EQ(DisplayEncoding{largest}.encode(largest), encoding.encode(1.0f));
}

TEST(DisplayEncoding, DoesNotHideFaultyValues) {
  const DisplayEncoding encoding;
  for (const float fault : {not_a_number, infinite, -infinite}) {
    EXPECT_TRUE(std::isnan(encoding.encode(fault)));
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<float, 3> rgb{0.2f, 0.3f, 0.4f};
      rgb[c] = fault;
      // A fault of one colour makes the brightness one, and with it the whole sample.
      EXPECT_TRUE(std::isnan(encoding.encode(rgb)[0]));
    }
  }
}

TEST(DisplayEncoding, IsBt601OfEncodedColours) {
  const DisplayEncoding encoding{2};
  oracle::Random random(3);
  for (int i = 0; i < 1000; ++i) {
    std::array<float, 3> rgb;
    for (float& value : rgb) value = static_cast<float>(random.uniform(-0.1, 0.7));
    const Real r = srgb(2 * static_cast<Real>(rgb[0]));
    const Real g = srgb(2 * static_cast<Real>(rgb[1]));
    const Real b = srgb(2 * static_cast<Real>(rgb[2]));
    const auto ycc = encoding.encode(rgb);
    const Real y = 0.299L * r + 0.587L * g + 0.114L * b;
    EXPECT_NEAR(ycc[0], static_cast<double>(y), tolerance);
    EXPECT_NEAR(ycc[1], static_cast<double>((b - y) / (2 - 2 * 0.114L)), tolerance);
    EXPECT_NEAR(ycc[2], static_cast<double>((r - y) / (2 - 2 * 0.299L)), tolerance);
    // As JFIF 1.02 prints it, to four digits, of 3 times 255; measured: 0.0092 and 0.0032.
    EXPECT_NEAR(ycc[1], static_cast<double>(-0.1687L * r - 0.3313L * g + 0.5L * b), 0.0115);
    EXPECT_NEAR(ycc[2], static_cast<double>(0.5L * r - 0.4187L * g - 0.0813L * b), 0.004);
    // Measured: 3.3, 4.9 and 3.3 roundings of 255.
    const auto back = display_rgb(ycc);
    EXPECT_NEAR(back[0], static_cast<double>(r), 255 * 4.1 * oracle::float_rounding);
    EXPECT_NEAR(back[1], static_cast<double>(g), 255 * 6.1 * oracle::float_rounding);
    EXPECT_NEAR(back[2], static_cast<double>(b), 255 * 4.1 * oracle::float_rounding);
  }
  const auto blue = encoding.encode({0.0f, 0.0f, 1.0f});
  EXPECT_FLOAT_EQ(blue[1], 127.5);
  const auto cyan = encoding.encode({0.0f, 1.0f, 1.0f});
  EXPECT_FLOAT_EQ(cyan[2], -127.5);
}

TEST(DisplayEncoding, RefusesExposuresOutOfRange) {
  for (const float exposure : {0.0f, -1.0f, not_a_number, infinite}) {
    const DisplayEncoding encoding{exposure};
    const auto refused = ThrowsMessage<std::invalid_argument>(HasSubstr("exposure is "));
    EXPECT_THAT([&] { encoding.validate(); }, refused);
    EXPECT_THAT([&] { (void)encode_pixels(FrequencyImage(8, 8, 1), encoding); }, refused);
    const auto black = [](double, double) { return 0.0f; };
    EXPECT_THAT([&] { DisplaySampler(black, 1, encoding); }, refused);
  }
}

// -------------------------------------------------------------------------------------- sampler

std::array<float, 3> color(double x, double y) {
  return {static_cast<float>(x / 20), static_cast<float>(y / 20), x > 5 ? infinite : 0.5f};
}

void color_batch(std::span<const Request> requests, std::span<float> values) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto rgb = color(requests[i].x, requests[i].y);
    std::copy(rgb.begin(), rgb.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
}

TEST(DisplaySampler, EncodesSamplersOfEitherForm) {
  const DisplayEncoding encoding{1.5f};
  DisplaySampler scalar(&color, 3, encoding);
  DisplaySampler batch(&color_batch, 3, encoding);
  static_assert(BatchSampler<decltype(scalar)> && BatchSampler<decltype(batch)>);
  std::vector<Request> requests;
  for (int i = 0; i < 10; ++i) requests.push_back({.x = double(i), .y = 10.0 - i});
  std::vector<float> by_scalar(30), by_batch(30);
  scalar(requests, by_scalar);
  batch(requests, by_batch);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto expected = encoding.encode(color(requests[i].x, requests[i].y));
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::isnan(expected[c])) {
        EXPECT_TRUE(std::isnan(by_scalar[3 * i + c]) && std::isnan(by_batch[3 * i + c]));
      } else {
        EXPECT_EQ(by_scalar[3 * i + c], expected[c]);
        EXPECT_EQ(by_batch[3 * i + c], expected[c]);
      }
    }
  }
}

TEST(DisplaySampler, EncodesGray) {
  DisplaySampler gray([](double x, double) { return x; }, 1);
  const std::array<Request, 2> requests{Request{.x = 0.25}, Request{.x = 3}};
  std::array<float, 2> values;
  gray(requests, values);
  EXPECT_EQ(values[0], DisplayEncoding{}.encode(0.25f));
  EXPECT_EQ(values[1], DisplayEncoding{}.encode(1.0f));
}

TEST(DisplaySampler, RefusesOtherNumbersOfChannels) {
  EXPECT_THAT([] { DisplaySampler(&color_batch, 2); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 2 channels, not 1 or 3")));
  EXPECT_THAT([] { DisplaySampler(&color, 1); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("sampler that returns 3 values")));
}

TEST(DisplaySampler, FitsTheSignalOfAJpeg) {
  SynthesisSettings settings;
  settings.width = settings.height = 32;
  settings.channels = 3;
  settings.list.positions = SamplePositions::lattice;
  Synthesizer engine(settings);
  const std::array<float, 3> orange{0.9f, 0.4f, 0.1f};
  engine.run(DisplaySampler([&](double, double) { return orange; }, 3), {.samples_per_pixel = 0.5});
  const auto expected = DisplayEncoding{}.encode(orange);
  const std::vector<float> pixels = reconstruct(engine.image());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_NEAR(pixels[i], expected[i % 3], 255 * 0.33 * oracle::float_rounding);
  }
}

// --------------------------------------------------------------------------------------- pixels

TEST(EncodePixels, IsTheEncodedPixelAtEveryPixel) {
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}}) {
    FrequencyImage linear =
        test::random_signal(21, 13, channels, CoefficientMeaning::point_function);
    for (std::size_t b = 0; b < 6; ++b) {
      for (std::size_t c = 0; c < channels; ++c) {
        // Mean 0.4 and some pixels below 0 and above 1.
        for (float& value : linear.coefficients(b % 3, b / 3, c)) value /= 80;
        linear.coefficients(b % 3, b / 3, c)[0] = 3.2f;
      }
    }
    const DisplayEncoding encoding{1.25f};
    ReconstructionSettings settings;
    settings.butterworth.cutoff = 0.5;
    const FrequencyImage encoded = encode_pixels(linear, encoding, settings);
    EXPECT_EQ(encoded.meaning(), CoefficientMeaning::pixel_average);
    EXPECT_EQ(encoded.samples(2, 1), linear.samples(2, 1));
    const std::vector<float> pixels = reconstruct(linear, settings);
    const std::vector<float> signal = reconstruct(encoded);
    ASSERT_EQ(signal.size(), pixels.size());
    for (std::size_t i = 0; i < pixels.size(); i += channels) {
      std::array<float, 3> expected{encoding.encode(pixels[i])};
      if (channels == 3) {
        expected = encoding.encode(std::array{pixels[i], pixels[i + 1], pixels[i + 2]});
      }
      // Two transforms of numbers up to 255 in blocks of 64. Measured: 3 roundings of them, and 4.1
      // with the random numbers of libc++.
      for (std::size_t c = 0; c < channels; ++c) {
        EXPECT_NEAR(signal[i + c], expected[c], 255 * 5.1 * oracle::float_rounding);
      }
    }
  }
}

TEST(EncodePixels, TakesAnEmptyImageAndRefusesOtherChannels) {
  EXPECT_EQ(encode_pixels(FrequencyImage(0, 0, 3)).blocks_x(), 0u);
  EXPECT_THAT([] { (void)encode_pixels(FrequencyImage(8, 8, 2)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("of 2 channels")));
}

}  // namespace
}  // namespace freqsynth
