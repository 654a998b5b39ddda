// SPDX-License-Identifier: MIT
#include "attention.h"

#include <cmath>

namespace live {
namespace {

constexpr std::size_t side = 8;  // of a block

bool attended(const Attention& attention, double left, double top) {
  if (attention.frame) {
    const Frame& frame = *attention.frame;
    if (frame.left < left + side && frame.right > left && frame.top < top + side &&
        frame.bottom > top) {
      return true;
    }
  }
  if (!attention.pointer) return false;
  return std::hypot(attention.pointer->x - left - side / 2.0,
                    attention.pointer->y - top - side / 2.0) <= pointer_radius;
}

}  // namespace

std::vector<float> importance_of(const Attention& attention, std::size_t width,
                                 std::size_t height) {
  std::vector<float> importance;
  importance.reserve(((width + side - 1) / side) * ((height + side - 1) / side));
  for (std::size_t top = 0; top < height; top += side) {
    for (std::size_t left = 0; left < width; left += side) {
      importance.push_back(attended(attention, static_cast<double>(left), static_cast<double>(top))
                               ? attended_weight
                               : 1);
    }
  }
  return importance;
}

}  // namespace live
