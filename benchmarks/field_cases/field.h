// SPDX-License-Identifier: MIT
/// \file
/// Functions of the image plane whose pixel averages are known in closed form.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "scenes/area.h"

/// Inputs on which adaptive samplers were seen to fail, random members of the same kinds, and what
/// is measured on them. This header and members.h need nothing of the library that is measured.
namespace field_cases {

/// A function and its right picture.
struct Field {
  std::string name;
  std::size_t width = 0;   ///< pixels
  std::size_t height = 0;  ///< pixels
  /// The value at (x, y), in pixels.
  std::function<double(double x, double y)> value;
  /// The mean over pixel (i, j), which covers i .. i + 1 and j .. j + 1.
  std::function<double(double i, double j)> average;
};

/// A function of one coordinate with two values: `inside` from `begin` on over `length`, in every
/// `period` (0: once); else `outside`.
struct Steps {
  double begin = 0;
  double length = 0;
  double period = 0;
  double inside = 1;
  double outside = 0;

  /// The value at t.
  [[nodiscard]] double value(double t) const {
    double u = t - begin;
    if (period > 0) u -= period * std::floor(u / period);
    return u >= 0 && u < length ? inside : outside;
  }

  /// The mean over a .. b.
  [[nodiscard]] double average(double a, double b) const {
    const double share = (measure(b - begin) - measure(a - begin)) / (b - a);
    return outside + (inside - outside) * share;
  }

 private:
  // How much of 0 .. u is inside.
  [[nodiscard]] double measure(double u) const {
    const double whole = period > 0 ? std::floor(u / period) : 0.0;
    const double rest = u - period * whole;
    return whole * length + std::fmin(std::fmax(rest, 0.0), length);
  }
};

/// A product of a function of x and one of y.
struct Product {
  double weight = 1;
  Steps x;
  Steps y;
};

/// A constant and a sum of products: rectangles, lines, stems, checkers, fences.
inline Field product_field(std::string name, std::size_t width, std::size_t height, double constant,
                           std::vector<Product> products) {
  Field field{std::move(name), width, height, {}, {}};
  field.value = [constant, products](double x, double y) {
    double sum = constant;
    for (const Product& p : products) sum += p.weight * p.x.value(x) * p.y.value(y);
    return sum;
  };
  field.average = [constant, products = std::move(products)](double i, double j) {
    double sum = constant;
    for (const Product& p : products) {
      sum += p.weight * p.x.average(i, i + 1) * p.y.average(j, j + 1);
    }
    return sum;
  };
  return field;
}

/// 1 everywhere, as a factor of a product.
inline Steps always() { return {0, 0, 0, 1, 1}; }

/// `inside` from `begin` to `end`, else 0.
inline Steps between(double begin, double end, double inside = 1) {
  return {begin, end - begin, 0, inside, 0};
}

/// A checker of 0 and 1 with cells of width `cell`: (floor((x + dx) / cell) + floor((y + dy) /
/// cell)) mod 2.
inline Field checker_field(std::string name, std::size_t width, std::size_t height, double cell,
                           double dx, double dy) {
  const Steps x{-dx, cell, 2 * cell, 1, -1};
  const Steps y{-dy, cell, 2 * cell, 1, -1};
  return product_field(std::move(name), width, height, 0.5, {{-0.5, x, y}});
}

/// A function that is a function of x along each row y, of two values. Its averages are exact along
/// rows; across them a mean of `rows` rows of each pixel.
inline Field rows_field(std::string name, std::size_t width, std::size_t height,
                        std::function<Steps(double y)> row, int rows = 128) {
  Field field{std::move(name), width, height, {}, {}};
  field.value = [row](double x, double y) { return row(y).value(x); };
  field.average = [row = std::move(row), rows](double i, double j) {
    double sum = 0;
    for (int k = 0; k < rows; ++k) sum += row(j + (k + 0.5) / rows).average(i, i + 1);
    return sum / rows;
  };
  return field;
}

/// Where sin(a x + b) > level in a row; a != 0, |level| < 1.
inline Steps sine_above(double a, double b, double level, double inside, double outside) {
  const double turn = 2 * std::numbers::pi;
  const double first = std::asin(level);
  const double begin = (first - b) / a;
  const double length = (std::numbers::pi - 2 * first) / a;
  return a > 0 ? Steps{begin, length, turn / a, inside, outside}
               : Steps{begin + length, -length, -turn / a, inside, outside};
}

/// A grating of hard bars: 1 where frac(a x + b y + c) < duty, else 0. Neither a nor b may be so
/// near 0 that their product loses its digits: 1e-3, say.
struct BarGrating {
  double a = 0, b = 0, c = 0, duty = 0.5;

  [[nodiscard]] double value(double x, double y) const {
    const double u = a * x + b * y + c;
    return u - std::floor(u) < duty ? 1 : 0;
  }
  /// The second difference of the second antiderivative.
  [[nodiscard]] double average(double i, double j) const {
    const double u = a * i + b * j + c;
    return (twice_integrated(u + a + b) - twice_integrated(u + a) - twice_integrated(u + b) +
            twice_integrated(u)) /
           (a * b);
  }

 private:
  [[nodiscard]] double twice_integrated(double u) const {
    const double n = std::floor(u);
    const double r = u - n;
    const double whole = duty - duty * duty / 2;  // of one period, integrated
    const double rest = r < duty ? r * r / 2 : duty * duty / 2 + duty * (r - duty);
    return duty * n * (n - 1) / 2 + n * whole + n * duty * r + rest;
  }
};

/// A smooth grating: sin(a x + b y + c).
struct SineGrating {
  double a = 0, b = 0, c = 0;

  [[nodiscard]] double value(double x, double y) const { return std::sin(a * x + b * y + c); }
  [[nodiscard]] double average(double i, double j) const {
    const auto spread = [](double half) { return half == 0 ? 1 : std::sin(half) / half; };
    return value(i + 0.5, j + 0.5) * spread(a / 2) * spread(b / 2);
  }
};

/// 1 within a disc, else 0.
struct Disc {
  double x = 0, y = 0, radius = 1;

  [[nodiscard]] double value(double at_x, double at_y) const {
    return std::hypot(at_x - x, at_y - y) < radius ? 1 : 0;
  }
  [[nodiscard]] double average(double i, double j) const {
    return scenes::disc_area(i - x, j - y, radius);
  }
};

/// 1 where a x + b y < c, else 0; see scenes::half_plane_area() for a and b.
struct HalfPlane {
  double a = 0, b = 0, c = 0;

  [[nodiscard]] double value(double x, double y) const { return a * x + b * y < c ? 1 : 0; }
  [[nodiscard]] double average(double i, double j) const {
    return scenes::half_plane_area(a, b, c - a * i - b * j);
  }
};

/// base(x, y) + weight part(x, y), for any of the above.
template <class Part>
Field plus(Field base, double weight, Part part) {
  base.value = [f = std::move(base.value), weight, part](double x, double y) {
    return f(x, y) + weight * part.value(x, y);
  };
  base.average = [f = std::move(base.average), weight, part](double i, double j) {
    return f(i, j) + weight * part.average(i, j);
  };
  return base;
}

/// The right picture, row by row.
inline std::vector<double> right_pixels(const Field& field) {
  std::vector<double> pixels;
  pixels.reserve(field.width * field.height);
  for (std::size_t j = 0; j < field.height; ++j) {
    for (std::size_t i = 0; i < field.width; ++i) {
      pixels.push_back(field.average(static_cast<double>(i), static_cast<double>(j)));
    }
  }
  return pixels;
}

}  // namespace field_cases
