// SPDX-License-Identifier: MIT
/// \file
/// Random members of the kinds of failure, and random functions of every sort. All numbers come
/// from a generator that gives the same ones on every machine, so that (seed, number) names a
/// member.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "field.h"

namespace field_cases {

/// Random numbers; the distributions of the standard library differ between machines. Draw no two
/// in operands or arguments of one expression: compilers differ in their order.
class Draw {
 public:
  /// The numbers of one member of a family.
  Draw(std::uint64_t seed, std::uint64_t number)
      : generator_(seed * 0x9e3779b97f4a7c15u + number * 0xbf58476d1ce4e5b9u + 1) {}

  /// Uniform in low .. high.
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(generator_() >> 11) * 0x1p-53);
  }
  /// A whole number in low .. high, both included.
  int whole(int low, int high) {
    const auto count = static_cast<std::uint64_t>(high - low + 1);
    return low + static_cast<int>(generator_() % count);
  }
  /// True in one of two cases.
  bool coin() { return (generator_() >> 63) != 0; }
  /// A position in low .. high: whole, or any, or just beside a whole one.
  double position(int low, int high) {
    const int sort = whole(0, 3);
    const double on = whole(low, high);
    if (sort < 2) return on;
    if (sort == 2) return on + (coin() ? 0.01 : -0.01);
    return real(low, high);
  }

 private:
  std::mt19937_64 generator_;
};

/// Side of the random members' pictures, in pixels.
inline constexpr std::size_t member_side = 64;

/// The name of a member: family and number.
inline std::string member_name(const char* family, std::uint64_t number) {
  return std::string(family) + " " + std::to_string(number);
}

/// K2: 3 to 8 rectangles, each of an amplitude in 0.2 .. 1, added up; sides 1 to 40 pixels, corners
/// as Draw::position().
inline Field random_rectangles(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  std::vector<Product> products;
  for (int n = draw.whole(3, 8); n > 0; --n) {
    const double left = draw.position(0, 56);
    const double top = draw.position(0, 56);
    const double right = left + draw.position(2, 40);
    const double bottom = top + draw.position(2, 40);
    products.push_back({draw.real(0.2, 1), between(left, right), between(top, bottom)});
  }
  return product_field(member_name("rectangles", number), member_side, member_side, 0.1, products);
}

/// K2: 4 to 10 lines across the picture, level or upright, 0.3 to 3 pixels wide.
inline Field random_lines(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  std::vector<Product> products;
  for (int n = draw.whole(4, 10); n > 0; --n) {
    const double width = draw.coin() ? draw.whole(1, 3) : draw.real(0.3, 3);
    const double begin = draw.position(1, 60);
    const Steps across = between(begin, begin + width);
    const double from = draw.position(0, 20);
    const Steps along = between(from, from + draw.position(20, 44));
    const bool level = draw.coin();
    products.push_back({draw.real(0.3, 1), level ? along : across, level ? across : along});
  }
  return product_field(member_name("lines", number), member_side, member_side, 0.0, products);
}

/// K2: dark stems on white like those of letters, 5 to 13 pixels apart and 0.5 to 2.5 wide, in
/// lines of text 10 to 17 pixels high.
inline Field random_stems(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  const double apart = draw.coin() ? draw.whole(5, 13) : draw.real(5, 13);
  const double height = draw.coin() ? draw.whole(10, 17) : draw.real(10, 17);
  const Steps stems{-draw.position(0, 8), draw.coin() ? draw.whole(1, 2) : draw.real(0.5, 2.5),
                    apart};
  const Steps lines{-draw.position(0, 8), std::round(0.7 * height), height};
  return product_field(member_name("stems", number), member_side, member_side, 1.0,
                       {{-1, stems, lines}});
}

/// K2: checkers with cells of 3 to 16 pixels.
inline Field random_checker(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  const double cell = draw.coin() ? draw.whole(3, 16) : draw.real(3, 16);
  const double dx = draw.position(0, 15);
  const double dy = draw.position(0, 15);
  return checker_field(member_name("checker", number), member_side, member_side, cell, dx, dy);
}

/// K3: a fence of k / 16 pixels, k in 1 .. 32, of a duty cycle in 0.1 .. 0.9, level or upright or
/// (one in three) both, with any phase.
inline Field random_fence(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  const auto steps = [&] {
    const double period = draw.whole(1, 32) / 16.0;
    const double phase = draw.coin() ? 0.0 : draw.real(0, period);
    return Steps{phase, draw.real(0.1, 0.9) * period, period};
  };
  const int sort = draw.whole(0, 2);
  const Steps first = steps();
  const Steps second = steps();
  return product_field(member_name("fence", number), member_side, member_side, 0.0,
                       {{1, sort == 1 ? always() : first, sort == 0 ? always() : second}});
}

/// K4: where a disc lies in the flat half beside a busy one.
struct LostDisc {
  Field field;
  Disc disc;
};

/// K4: 128 x 64 pixels, flat but for a disc of that radius in columns 8 .. 56; to the right of
/// column 64 busy: `busy` is 0 nothing, 1 hyperbolic stripes, 2 slanted bars, 3 bars that
/// turn and narrow, 4 a fine checker.
inline LostDisc random_disc(std::uint64_t seed, std::uint64_t number, double radius, int busy) {
  Draw draw(seed, number);
  const double x = draw.real(8, 56);
  const double y = draw.real(radius, 64 - radius);
  const auto row = [busy](double at) -> Steps {
    switch (busy) {
      case 0:
        return {0, 0, 0, 0, 0};
      case 1:
        return sine_above(0.05 * std::max(at, 1e-6), 0, 0, 1, 0);
      case 2:
        return sine_above(1.1, 0.83 * at, 0.1, 1, 0);
      case 3:
        return sine_above(0.4 + 0.02 * at, 0.3 * at, 0.2, 1, 0);
      default:
        return {2.5 * std::floor(at / 2.5), 2.5, 5, 1, 0};
    }
  };
  Field half = rows_field(member_name("disc", number), 128, 64, row, 64);
  half.value = [f = std::move(half.value)](double at_x, double at_y) {
    return at_x > 64 ? f(at_x, at_y) : 0.0;
  };
  half.average = [f = std::move(half.average)](double i, double j) {
    return i >= 64 ? f(i, j) : 0.0;
  };
  const Disc disc{x, y, radius};
  return {plus(std::move(half), 1, disc), disc};
}

/// A random function of every sort: 2 to 6 of edges, discs, gratings of hard bars, smooth gratings
/// and gradients, of amplitudes in 0.1 .. 1.
inline Field random_function(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  Field field = product_field(member_name("function", number), member_side, member_side, 0.2, {});
  // Directions keep 3 degrees from the axes, so that the closed forms keep their digits.
  const auto direction = [&] {
    const double quarter = std::numbers::pi / 2;
    const double within = draw.real(0.0524, quarter - 0.0524);
    return draw.whole(0, 3) * quarter + within;
  };
  for (int n = draw.whole(2, 6); n > 0; --n) {
    const double weight = draw.real(0.1, 1);
    const int sort = draw.whole(0, 4);
    const double angle = direction();
    const double a = std::cos(angle);
    const double b = std::sin(angle);
    if (sort == 0) {
      const double x = draw.real(8, 56);
      const double y = draw.real(8, 56);
      field = plus(std::move(field), weight, HalfPlane{a, b, a * x + b * y});
    } else if (sort == 1) {
      const double radius = std::exp(draw.real(std::log(0.7), std::log(25.0)));
      field = plus(std::move(field), weight, Disc{draw.real(0, 64), draw.real(0, 64), radius});
    } else if (sort == 2) {
      const double frequency = 1 / std::exp(draw.real(std::log(1.5), std::log(30.0)));
      const BarGrating bars{a * frequency, b * frequency, draw.real(0, 1), draw.real(0.2, 0.8)};
      field = plus(std::move(field), weight, bars);
    } else {
      // A gradient is a smooth grating whose period is longer than the picture.
      const double longest = sort == 3 ? 30.0 : 400.0;
      const double shortest = sort == 3 ? 2.0 : 100.0;
      const double frequency =
          2 * std::numbers::pi / std::exp(draw.real(std::log(shortest), std::log(longest)));
      const SineGrating waves{a * frequency, b * frequency, draw.real(0, 2 * std::numbers::pi)};
      field = plus(std::move(field), weight, waves);
    }
  }
  return field;
}

/// K6: the left half of a field `factor` times as bright.
inline Field darken_left_half(Field field, double factor) {
  const auto half = static_cast<double>(field.width / 2);
  field.value = [f = std::move(field.value), half, factor](double x, double y) {
    return (x < half ? factor : 1) * f(x, y);
  };
  field.average = [f = std::move(field.average), half, factor](double i, double j) {
    return (i < half ? factor : 1) * f(i, j);
  };
  return field;
}

/// K6: a random function of at most 1, one half 5 to 100 times as dark.
inline Field random_dark_half(std::uint64_t seed, std::uint64_t number) {
  Draw draw(~seed, number);
  const double factor = std::exp(draw.real(std::log(0.01), std::log(0.2)));
  Field field = random_function(seed, number);
  double least = field.average(0, 0);
  double most = least;
  for (std::size_t j = 0; j < field.height; ++j) {
    for (std::size_t i = 0; i < field.width; ++i) {
      const double v = field.value(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      least = std::min(least, v);
      most = std::max(most, v);
    }
  }
  // Smooth gratings are a little beyond what centres show: some room on both sides.
  const double scale = 0.9 / (most - least);
  const double shift = 0.05 - scale * least;
  field.value = [f = std::move(field.value), scale, shift](double x, double y) {
    return shift + scale * f(x, y);
  };
  field.average = [f = std::move(field.average), scale, shift](double i, double j) {
    return shift + scale * f(i, j);
  };
  return darken_left_half(std::move(field), factor);
}

/// K10: whether the sample at (x, y) is bad, for that share of all places.
inline bool is_bad_place(double x, double y, double share) {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u;
  hash = (hash ^ (hash >> 29) ^ std::bit_cast<std::uint64_t>(y)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 32)) * 0x94d049bb133111ebu;
  return static_cast<double>((hash ^ (hash >> 29)) >> 11) * 0x1p-53 < share;
}

/// A disc, its radiance and the level around it.
struct Lamp {
  Disc disc;
  double radiance = 1;
  double level = 0.1;

  /// 64 x 64 pixels.
  [[nodiscard]] Field field() const {
    return plus(product_field("lamp", 64, 64, level, {}), radiance - level, disc);
  }
};

/// K11: a disc of radius 1 to 20, of a radiance in 10 .. 1e5 on 0.1.
inline Lamp random_lamp(std::uint64_t seed, std::uint64_t number) {
  Draw draw(seed, number);
  return {{draw.real(16, 48), draw.real(16, 48), draw.real(1, 20)},
          std::exp(draw.real(std::log(10.0), std::log(1e5)))};
}

/// K1: a random function in 1 to 17 columns or rows.
inline Field random_narrow(std::uint64_t seed, std::uint64_t number) {
  Field field = random_function(seed, number);
  Draw draw(~seed, number);
  (draw.coin() ? field.width : field.height) = static_cast<std::size_t>(draw.whole(1, 17));
  field.name = member_name("narrow", number);
  return field;
}

}  // namespace field_cases
