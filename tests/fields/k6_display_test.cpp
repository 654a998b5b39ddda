// SPDX-License-Identifier: MIT
// K6: linear light that is shown in sRGB.

#include <array>
#include <cstdint>
#include <vector>

#include "fields/field_helpers.h"

namespace {

using field_cases::Columns;
using field_cases::Field;
using field_cases::Picture;
using freqsynth::Steer;

/// Bars and random functions, the left half of each darker.
std::vector<Field> fields() {
  std::vector<Field> all;
  for (const double factor : {0.1, 0.03, 0.01}) {
    const auto row = [](double y) {
      return field_cases::sine_above(0.55, 3 * std::sin(0.21 * y), 0.2, 1, 0.15);
    };
    all.push_back(
        field_cases::darken_left_half(field_cases::rows_field("bars", 128, 128, row), factor));
  }
  for (std::uint64_t number = 1; number <= 16; ++number) {
    all.push_back(field_cases::random_dark_half(helpers::member_seed, number));
  }
  return all;
}

/// RMSE in sRGB.
struct Errors {
  double all = 0;
  double dark = 0;   ///< of the left half
  double inner = 0;  ///< of what of it has no block at the border, where samples are bright
  double away = 0;   ///< of all that has none
};

/// Of pictures, which are made by make(seed).
template <class Make>
Errors errors_of(const Field& field, std::uint64_t seeds, const Make& make) {
  std::vector<double> right = right_pixels(field);
  for (double& value : right) value = field_cases::display(value);
  const std::size_t half = field.width / 2;
  const std::array<Columns, 4> parts{Columns{}, Columns{0, half}, Columns{0, half - 8},
                                     Columns{half + 8}};
  std::array<double, 4> squares{};
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Picture picture = make(seed);
    for (float& value : picture.pixels) {
      value = static_cast<float>(field_cases::display(double{value}));
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
      squares[k] += field_cases::squared_error(picture, right, parts[k]);
    }
  }
  const auto root = [&](double square) {
    return std::max(std::sqrt(square / static_cast<double>(seeds)), field_cases::least_error);
  };
  return {root(squares[0]), root(squares[1]), root(squares[2]),
          root((squares[2] + squares[3]) / 2)};
}

Errors steered(const Field& field, double rate, Steer steer) {
  auto settings = field_cases::settings_of(field.width, field.height);
  settings.priority.steer = steer;
  return errors_of(field, field_cases::synthesis_seeds, [&](std::uint64_t seed) {
    return field_cases::synthesize(field_cases::sampler_of(field), settings, rate, seed);
  });
}

Errors jittered(const Field& field, double rate) {
  return errors_of(field, field_cases::jittered_seeds, [&](std::uint64_t seed) {
    return field_cases::jittered(field_cases::sampler_of(field), field.width, field.height, 1,
                                 field_cases::samples_at(rate, field.width, field.height), seed);
  });
}

/// Logarithms of ratios: their mean, and how many are not above 0.
class Ratios {
 public:
  void add(double error, double other) {
    sum_ += std::log(error / other);
    not_above_ += error <= other ? 1 : 0;
    ++count_;
  }
  [[nodiscard]] double mean() const { return std::exp(sum_ / count_); }
  [[nodiscard]] double share_not_above() const { return not_above_ / count_; }

 private:
  double sum_ = 0, not_above_ = 0, count_ = 0;
};

TEST(DisplayErrors, AreSteeredIntoTheDark) {
  for (const double rate : {1.0, 4.0, 16.0}) {
    Ratios inner, dark_to_linear, inner_to_linear, relative_inner;
    for (const Field& field : fields()) {
      const Errors others = jittered(field, rate);
      const Errors linear = steered(field, rate, Steer::linear);
      const Errors display = steered(field, rate, Steer::display);
      const Errors relative = steered(field, rate, Steer::relative);
      EXPECT_LE(display.away, others.away) << field.name << " at " << rate;
      inner.add(display.inner, others.inner);
      dark_to_linear.add(display.dark, linear.dark);
      inner_to_linear.add(display.inner, linear.inner);
      relative_inner.add(relative.inner, others.inner);
    }
    SCOPED_TRACE(rate);
    EXPECT_GT(inner.share_not_above(), 0.5) << "most are at most as wrong as jittered samples";
    EXPECT_LT(dark_to_linear.mean(), 1);
    EXPECT_LT(inner_to_linear.mean(), 0.95);
    EXPECT_GT(relative_inner.share_not_above(), 0.5);
  }
}

TEST(DisplayErrors, OfOrdinaryPicturesAreAboutAsSmall) {
  for (const double rate : {1.0, 4.0, 16.0}) {
    Ratios all;
    for (std::uint64_t number = 1; number <= 32; ++number) {
      // Most of it in 0..1.
      const Field bright = field_cases::random_function(helpers::member_seed, number);
      Field field = bright;
      field.value = [&](double x, double y) { return bright.value(x, y) / 2; };
      field.average = [&](double i, double j) { return bright.average(i, j) / 2; };
      all.add(steered(field, rate, Steer::display).all, steered(field, rate, Steer::linear).all);
    }
    EXPECT_LT(all.mean(), rate > 1 ? 1.05 : 1) << "at " << rate;
  }
}

TEST(DisplayErrors, OfWholePicturesAreNotAboveJitteredFromFourSamplesPerPixelOn) {
  for (const double rate : {4.0, 16.0}) {
    Ratios dark;
    for (const Field& field : fields()) {
      const Errors others = jittered(field, rate);
      const Errors display = steered(field, rate, Steer::display);
      EXPECT_LE(display.all, 1.1 * others.all) << field.name << " at " << rate;
      dark.add(display.dark, others.dark);
    }
    EXPECT_LT(dark.mean(), 1.25) << "at " << rate;
  }
}

// An aim that is not reached yet, for dark halves beside a bright one and for one sample per pixel;
// docs/field_cases.md tells how far it is.
TEST(DisplayErrors, DISABLED_AreNotAboveJittered) {
  for (const double rate : {1.0, 4.0, 16.0}) {
    for (const Field& field : fields()) {
      const Errors others = jittered(field, rate);
      const Errors display = steered(field, rate, Steer::display);
      EXPECT_LE(display.dark, 1.1 * others.dark) << field.name << " at " << rate;
      EXPECT_LE(display.all, 1.1 * others.all) << field.name << " at " << rate;
    }
  }
}

TEST(DisplayErrors, RelativeOnesHaveNoUnit) {
  for (std::uint64_t number = 1; number <= 8; ++number) {
    const Field field = field_cases::random_dark_half(helpers::member_seed, number);
    const std::vector<double> right = right_pixels(field);
    auto settings = field_cases::settings_of(field.width, field.height);
    settings.priority.steer = Steer::relative;
    const auto error_in = [&](double unit) {
      const field_cases::Sampler sampler = [&](double x, double y, std::uint64_t,
                                               std::span<float> values) {
        values[0] = static_cast<float>(unit * field.value(x, y));
      };
      return std::sqrt(field_cases::over_seeds(sampler, settings, 1, [&](const Picture& p) {
        Picture scaled = p;
        for (float& v : scaled.pixels) v = static_cast<float>(double{v} / unit);
        return field_cases::squared_error(scaled, right);
      }));
    };
    const double in_one = error_in(1);
    for (const double unit : {1e-30, 1e-17, 1e-6, 1e5, 1e16, 1e30}) {
      // Roundings differ, and with them the order of blocks that are nearly as urgent.
      EXPECT_NEAR(error_in(unit), in_one, 0.02 * in_one) << field.name << " in " << unit;
    }
  }
}

}  // namespace
