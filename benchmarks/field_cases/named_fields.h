// SPDX-License-Identifier: MIT
/// \file
/// Named inputs that several files need.
#pragma once

#include <string>

#include "field.h"

namespace field_cases {

/// V5: a rectangle of 0.8 and a level line of 1, a pixel wide, on 0.1, all moved by `shift`.
inline Field rectangle_and_line(double shift) {
  const Steps line = between(20 + shift, 21 + shift);
  const Steps left = between(40 + shift, 88 + shift);
  const Steps top = between(40 + shift, 72 + shift);
  return product_field("rectangle and line", 128, 96, 0.1,
                       {{0.9, always(), line}, {0.7, left, top}});
}

/// V6: stems of 0.6 pixels, 9 apart and 9 high, in lines of 13 pixels, dark on white; moved down.
inline Field text_stems(double shift) {
  return product_field("stems", 128, 128, 1, {{-1, Steps{-0.3, 0.6, 9}, Steps{shift, 9, 13}}});
}

/// V8: a fence of posts that take a fifth of the period.
inline Field fence(double period) {
  return product_field("fence", 64, 64, 0, {{1, Steps{0, 0.2 * period, period}, always()}});
}

/// V10, V11: a gentle ramp, and a corner that is busy.
inline Field ramp_and_busy_corner() {
  Field busy = rows_field("busy corner", 256, 256,
                          [](double y) { return sine_above(0.02 * y, 0, 0, 1, 0); });
  Field field = busy;
  const auto inside = [](double x, double y) { return x >= 140 && y >= 140; };
  field.value = [f = busy.value, inside](double x, double y) {
    return inside(x, y) ? f(x, y) : 0.3 + 0.001 * x;
  };
  field.average = [f = busy.average, inside](double i, double j) {
    return inside(i, j) ? f(i, j) : 0.3 + 0.001 * (i + 0.5);
  };
  return field;
}

}  // namespace field_cases
