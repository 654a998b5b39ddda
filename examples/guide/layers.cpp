// SPDX-License-Identifier: MIT
// Colour with alpha, and beside it depth and ids that nothing may average, and a layer of means.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <vector>

#include "freqsynth/freqsynth.h"

constexpr std::size_t side = 64;
constexpr float paper = 1;  // what the picture is laid over

// Two balls before nothing. Colour, alpha, depth, id and slope of what is seen at a point.
struct Surface {
  std::array<float, 3> colour = {};
  float alpha = 0;
  float depth = std::numeric_limits<float>::infinity();
  float id = 0;
  float slope = 0;  // 1: seen from the side
};
static Surface seen(double x, double y) {
  const double left = std::hypot(x - 24, y - 30), right = std::hypot(x - 42, y - 36);
  if (left < 16)
    return {{0.9f, 0.4f, 0.1f},
            1,
            static_cast<float>(9 - std::sqrt(256 - left * left) / 8),
            4001,
            static_cast<float>(left / 16)};
  if (right < 14) return {{0.2f, 0.4f, 0.8f}, 0.75f, 12, 70000, static_cast<float>(right / 14)};
  return {};
}

// The channels of a sample: colour as it is, or times alpha; then alpha, depth, id, slope.
using Values = std::array<float, 7>;
static Values values_of(const Surface& surface, bool premultiplied) {
  const float factor = premultiplied ? surface.alpha : 1;
  const auto& [red, green, blue] = surface.colour;
  return {red * factor,  green * factor, blue * factor, surface.alpha,
          surface.depth, surface.id,     surface.slope};
}

// What a pixel of the first channel is over white paper.
static double over_paper(double red, double alpha, bool premultiplied) {
  return (premultiplied ? red : red * alpha) + (1 - alpha) * double{paper};
}

static void render(bool premultiplied) {
  using enum freqsynth::ChannelRole;
  freqsynth::Synthesizer engine(
      {.width = side,
       .height = side,
       .channels = 7,
       .channel_settings = {{}, {}, {}, {}, {nearest}, {nearest}, {mean}}});
  engine.run([=](double x, double y) { return values_of(seen(x, y), premultiplied); },
             {.samples_per_pixel = 4});
  // Four channels: the others have no coefficients.
  const std::vector<float> pixels = freqsynth::reconstruct(engine.finished_image());
  const std::vector<float> depth = engine.channel_pixels(4), id = engine.channel_pixels(5),
                           slope = engine.channel_pixels(6);

  double sum = 0, of_slope = 0, lowest = 1, highest = 0;
  std::size_t infinite = 0, others = 0;
  for (std::size_t p = 0; p < side * side; ++p) {
    double right = 0, right_slope = 0;
    for (int k = 0; k < 256; ++k) {
      const Surface surface = seen(static_cast<double>(p % side) + (k % 16 + 0.5) / 16,
                                   static_cast<double>(p / side) + (k / 16 + 0.5) / 16);
      right += over_paper(double{surface.colour[0]}, double{surface.alpha}, false) / 256;
      right_slope += double{surface.slope} / 256;
    }
    const float* pixel = pixels.data() + 4 * p;
    sum += std::pow(over_paper(double{pixel[0]}, double{pixel[3]}, premultiplied) - right, 2);
    of_slope += std::pow(double{slope[p]} - right_slope, 2);
    // The red of the first ball by itself, where it covers some of a pixel at its left edge.
    if (p % side < 24 && pixel[3] > 0.05f) {
      const double red = double{premultiplied ? pixel[0] / pixel[3] : pixel[0]};
      lowest = std::min(lowest, red);
      highest = std::max(highest, red);
    }
    infinite += std::isinf(depth[p]) ? 1 : 0;
    others += id[p] != 0 && id[p] != 4001 && id[p] != 70000 ? 1 : 0;
  }
  std::printf("%-14s %12.4f %8.2f .. %.2f %10zu %10zu %12.4f\n",
              premultiplied ? "times alpha" : "as it is", std::sqrt(sum / (side * side)), lowest,
              highest, infinite, others, std::sqrt(of_slope / (side * side)));
}

int main() {
  std::printf("colour         error on paper    red at edge   infinite  other ids  slope error\n");
  render(false);
  render(true);
}
