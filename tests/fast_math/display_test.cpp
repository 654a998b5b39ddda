// SPDX-License-Identifier: MIT
// Compiled with -ffast-math, as many renderers are: their compiler may take every value for a
// finite number, and faults must be counted all the same.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "freqsynth/jpeg/display_encoding.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/synthesizer.h"

#if !defined(__FAST_MATH__)
#error "this file is to be compiled with -ffast-math"
#endif

namespace freqsynth {
namespace {

// As bits: a compiler that knows finite numbers only may make anything of the numbers themselves.
constexpr std::array<std::uint32_t, 5> faults = {0x7fc00000u, 0xffc00001u, 0x7f800001u,  // NaN
                                                 0x7f800000u, 0xff800000u};              // infinite

/// Every fourth position has a fault.
class FaultySampler {
 public:
  /// Number of the position, in the order in which they come for the first time.
  std::size_t number(double x, double y) {
    return numbers_.try_emplace({x, y}, numbers_.size()).first->second;
  }
  static float value(std::size_t number, double x) {
    if (number % 4 != 3) return static_cast<float>(x / 100);
    return std::bit_cast<float>(faults[number / 4 % faults.size()]);
  }
  /// Faults so far.
  [[nodiscard]] std::size_t bad() const { return numbers_.size() / 4; }

 private:
  std::map<std::pair<double, double>, std::size_t> numbers_;
};

TEST(FastMath, DisplaySamplerDoesNotHideFaults) {
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}}) {
    SynthesisSettings settings;
    settings.width = settings.height = 64;
    settings.channels = channels;
    Synthesizer engine(settings);
    FaultySampler faulty;
    const StopRule stop{.samples_per_pixel = 0.25};
    if (channels == 1) {
      const auto gray = [&](double x, double y) { return faulty.value(faulty.number(x, y), x); };
      engine.run(DisplaySampler(gray, 1), stop);
    } else {
      const auto color = [&](double x, double y) {
        std::array<float, 3> rgb{0.25f, 0.5f, 0.75f};
        const std::size_t number = faulty.number(x, y);
        rgb[number / 4 % 3] = faulty.value(number, x);
        return rgb;
      };
      engine.run(DisplaySampler(color, 3), stop);
    }
    EXPECT_GT(faulty.bad(), 200u);
    EXPECT_EQ(engine.stats().bad_samples, faulty.bad()) << channels;
  }
}

TEST(FastMath, EncodingInPlaceMarksTheWholePixel) {
  for (const std::uint32_t fault : faults) {
    for (std::size_t at = 0; at < 3; ++at) {
      std::vector<float> values{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f};
      values[at] = std::bit_cast<float>(fault);
      DisplayEncoding{}.encode(values, 3);
      for (std::size_t i = 0; i < values.size(); ++i) {
        const bool marked = (std::bit_cast<std::uint32_t>(values[i]) & 0x7fffffffu) > 0x7f800000u;
        EXPECT_EQ(marked, i < 3) << i;
      }
    }
  }
}

TEST(FastMath, QuantisationCountsFaults) {
  for (const std::uint32_t fault : faults) {
    FrequencyImage image(8, 8, 1, CoefficientMeaning::pixel_average);
    image.coefficients(0, 0, 0)[5] = std::bit_cast<float>(fault);
    EXPECT_EQ(quantize(image).clamped, 1u);
  }
}

TEST(FastMath, SettingsThatAreNoNumbersAreRefused) {
  for (const std::uint32_t fault : faults) {
    DisplayEncoding encoding;
    encoding.exposure = std::bit_cast<float>(fault);
    EXPECT_THROW(encoding.validate(), std::invalid_argument);
  }
  for (const std::uint64_t fault : {0x7ff8000000000000u, 0x7ff0000000000000u}) {
    ButterworthSettings butterworth;
    butterworth.cutoff = std::bit_cast<double>(fault);
    EXPECT_THROW(butterworth.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace freqsynth
