// SPDX-License-Identifier: MIT
// K11: dark pixels beside a lamp; and pixels below zero where no sample is.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "fields/field_helpers.h"

namespace {

using field_cases::Field;
using field_cases::Lamp;
using field_cases::Picture;
using freqsynth::FinishSettings;
using freqsynth::Synthesizer;

/// What the samples within each pixel have shown.
struct Shown {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

/// A picture of a field, and what its samples show.
struct Observed {
  Picture picture;
  std::vector<Shown> shown;
};

Observed observe(const Field& field, double rate, std::uint64_t seed) {
  Observed observed;
  observed.shown.resize(field.width * field.height);
  const field_cases::Sampler sampler = [&](double x, double y, std::uint64_t,
                                           std::span<float> values) {
    values[0] = static_cast<float>(field.value(x, y));
    if (x == std::floor(x) || y == std::floor(y)) return;
    const auto pixel = static_cast<std::size_t>(y) * field.width + static_cast<std::size_t>(x);
    Shown& shown = observed.shown[pixel];
    shown.low = std::min(shown.low, double{values[0]});
    shown.high = std::max(shown.high, double{values[0]});
  };
  const auto settings = field_cases::settings_of(field.width, field.height);
  observed.picture = field_cases::synthesize(sampler, settings, rate, seed);
  return observed;
}

TEST(Halos, PixelsAreDarkWhereTheyAndAllNeighboursShowIt) {
  std::size_t checked = 0;
  for (std::uint64_t number = 1; number <= 32; ++number) {
    const Lamp lamp = field_cases::random_lamp(helpers::member_seed, number);
    for (const double rate : {1.0, 4.0, 16.0}) {
      const Field field = lamp.field();
      const Observed observed = observe(field, rate, number);
      for (std::size_t j = 1; j + 1 < field.height; ++j) {
        for (std::size_t i = 1; i + 1 < field.width; ++i) {
          bool dark = true;
          for (std::size_t v = j - 1; v <= j + 1; ++v) {
            for (std::size_t u = i - 1; u <= i + 1; ++u) {
              const Shown& shown = observed.shown[v * field.width + u];
              dark = dark && shown.low <= shown.high && shown.high <= lamp.level + 1e-6;
            }
          }
          if (!dark) continue;
          ++checked;
          // A float's digits are those of the lamp in a block that has a part of it.
          EXPECT_NEAR(observed.picture.at(i, j), lamp.level, 1e-3 + 1e-6 * lamp.radiance)
              << number << " at " << rate << ": " << i << ", " << j;
        }
      }
    }
  }
  EXPECT_GT(checked, 10000u);
}

/// Means over lamps of what pixels wholly outside show.
struct Leak {
  double wrong = 0;     ///< pixels that are off by more than half of the level
  double greatest = 0;  ///< error in units of the radiance
};

template <class Make>
Leak leak_of(std::uint64_t count, const Make& make) {
  Leak leak;
  for (std::uint64_t number = 1; number <= count; ++number) {
    const Lamp lamp = field_cases::random_lamp(helpers::member_seed, number);
    const Picture picture = make(lamp, number);
    double greatest = 0;
    for (std::size_t j = 0; j < picture.height; ++j) {
      for (std::size_t i = 0; i < picture.width; ++i) {
        if (lamp.disc.average(static_cast<double>(i), static_cast<double>(j)) > 1e-9) continue;
        const double off = std::abs(picture.at(i, j) - lamp.level);
        leak.wrong += (off > 0.05 ? 1.0 : 0.0) / static_cast<double>(count);
        greatest = std::max(greatest, off / lamp.radiance);
      }
    }
    leak.greatest += greatest / static_cast<double>(count);
  }
  return leak;
}

TEST(Halos, HardlyAPixelOutsideIsLit) {
  // A pixel at the rim with one sample or two may as well be a little covered. Were the fit not
  // held, 33 to 36 were wrong at every rate.
  struct Aim {
    double rate, wrong, greatest;
  };
  for (const Aim& aim : {Aim{1, 7, 0.08}, Aim{4, 1, 0.02}, Aim{16, 0.25, 1e-3}}) {
    const Leak leak = leak_of(64, [&](const Lamp& lamp, std::uint64_t number) {
      return field_cases::synthesize(field_cases::sampler_of(lamp.field()),
                                     field_cases::settings_of(64, 64), aim.rate, 1 + number % 3);
    });
    EXPECT_LT(leak.wrong, aim.wrong) << "at " << aim.rate;
    EXPECT_LT(leak.greatest, aim.greatest) << "at " << aim.rate;
  }
}

// An aim that is not reached yet; docs/field_cases.md tells how far it is.
TEST(Halos, DISABLED_NoPixelOutsideIsLit) {
  for (const double rate : {1.0, 4.0, 16.0}) {
    const Leak leak = leak_of(64, [&](const Lamp& lamp, std::uint64_t number) {
      return field_cases::synthesize(field_cases::sampler_of(lamp.field()),
                                     field_cases::settings_of(64, 64), rate, 1 + number % 3);
    });
    EXPECT_EQ(leak.wrong, 0) << "at " << rate;
  }
}

/// Random functions that touch zero, and lamps on black.
std::vector<Field> touching_zero() {
  std::vector<Field> fields;
  for (std::uint64_t number = 1; number <= 24; ++number) {
    Field field = number % 2 == 0 ? field_cases::random_function(helpers::member_seed, number)
                                  : field_cases::random_narrow(helpers::member_seed, number);
    // Half of it is black.
    field.value = [f = std::move(field.value)](double x, double y) {
      return std::max(0.0, f(x, y) - 0.5);
    };
    fields.push_back(std::move(field));
    Lamp lamp = field_cases::random_lamp(helpers::member_seed, number);
    lamp.level = 0;
    fields.push_back(lamp.field());
  }
  return fields;
}

/// An engine that has sampled a field, with noise of its size or without.
std::unique_ptr<Synthesizer> sampled(const Field& field, bool noisy, double rate,
                                     double shift = 0) {
  auto settings = field_cases::settings_of(field.width, field.height);
  settings.noise = noisy ? freqsynth::Noise::present : freqsynth::Noise::none;
  auto engine = std::make_unique<Synthesizer>(settings);
  engine->run(
      [&](const freqsynth::Request& request) {
        field_cases::Draw draw(request.id, 5);
        const double factor = noisy ? 2 * draw.real(0, 1) * draw.real(0, 1) : 1;
        return factor * field.value(request.x, request.y) + shift;
      },
      {.samples_per_pixel = rate});
  return engine;
}

TEST(NegativePixels, AreNoneWhereNoSampleIs) {
  for (const Field& field : touching_zero()) {
    for (const bool noisy : {false, true}) {
      for (const double rate : {0.25, 1.0, 5.0}) {
        const auto engine = sampled(field, noisy, rate);
        const freqsynth::FrequencyImage image = engine->finished_image();
        for (const double scale : {0.37, 1.0, 2.0}) {
          for (const float pixel : freqsynth::reconstruct(image, {}, scale)) {
            ASSERT_GE(pixel, 0) << field.name << " at " << rate << " times " << scale;
          }
        }
        // And of the coefficients, up to their rounding.
        for (std::size_t by = 0; by < image.blocks_y(); ++by) {
          for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
            std::array<float, freqsynth::max_terms> pixels;
            freqsynth::inverse_dct(image.coefficients(bx, by, 0), pixels);
            const float most = *std::max_element(pixels.begin(), pixels.end());
            const float rounding = 1e-6f * most + std::numeric_limits<float>::min();
            for (const float pixel : pixels) ASSERT_GE(pixel, -rounding) << field.name;
          }
        }
      }
    }
  }
}

TEST(NegativePixels, OthersGiveWhatTheyAreLifted) {
  std::size_t lifted = 0;
  for (const Field& field : touching_zero()) {
    for (const bool noisy : {false, true}) {
      const auto engine = sampled(field, noisy, 1);
      FinishSettings settings;
      settings.smooth_noise = false;  // which takes light from block to block
      const freqsynth::FrequencyImage image = engine->finished_image(settings);
      settings.keep_positive = false;
      const freqsynth::FrequencyImage plain = engine->finished_image(settings);
      EXPECT_FALSE(plain.non_negative(0));
      for (std::size_t by = 0; by < image.blocks_y(); ++by) {
        for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
          std::array<float, freqsynth::max_terms> pixels;
          freqsynth::inverse_dct(plain.coefficients(bx, by, 0), pixels);
          double sum = 0, size = 0;
          for (const float pixel : pixels) {
            sum += double{pixel};
            size += std::abs(double{pixel});
          }
          lifted += sum > 0 && sum < 0.999 * size ? 1 : 0;
          const double mean = double{image.coefficients(bx, by, 0)[0]} / 8;
          EXPECT_NEAR(mean, std::max(sum, 0.0) / 64, 1e-5 * size / 64) << field.name;
        }
      }
    }
  }
  EXPECT_GT(lifted, 100u);
}

TEST(NegativePixels, OfSignedFunctionsStay) {
  for (const Field& field : touching_zero()) {
    const auto engine = sampled(field, false, 1, -0.01);
    FinishSettings settings;
    const std::vector<float> pixels = freqsynth::reconstruct(engine->finished_image(settings));
    settings.keep_positive = false;
    EXPECT_EQ(pixels, freqsynth::reconstruct(engine->finished_image(settings))) << field.name;
  }
}

}  // namespace
