// SPDX-License-Identifier: MIT
#include "whitted.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>

#include "sampler.h"
#include "supersampling.h"

namespace baselines {
namespace {

/// Corners lie on a lattice of this many points per pixel, so that squares can be divided eight
/// times below the pixel and a corner is found again without rounding.
constexpr std::uint32_t kPoints = 256;

struct Square {
  std::uint32_t left, top, right, bottom;  // in lattice points
  std::uint32_t corners[4];                // indices: left top, right top, left bottom, ...

  [[nodiscard]] double area() const {
    return static_cast<double>(right - left) * static_cast<double>(bottom - top);
  }
};

struct Candidate {
  double importance;
  double area;
  std::uint32_t square;

  // The last one makes the order, and so the picture, independent of the library.
  bool operator<(const Candidate& other) const {
    return std::tie(importance, area, other.square) <
           std::tie(other.importance, other.area, square);
  }
};

std::uint64_t key(std::uint32_t x, std::uint32_t y) { return (std::uint64_t{y} << 32) | x; }

/// Numbers of the corners by key: open addressing, because looking corners up takes most of the
/// time where a radiance is cheap.
class CornerTable {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  explicit CornerTable(std::uint64_t most)
      : keys_(std::bit_ceil(2 * most + 1)), numbers_(keys_.size(), kNone) {}

  /// The number of a corner, kNone when it is new. Set it then, before the next call.
  std::uint32_t& operator[](std::uint64_t key) {
    const std::uint64_t mask = keys_.size() - 1;
    std::uint64_t slot = (key ^ (key >> 29)) * 0x9e3779b97f4a7c15U;
    for (slot = (slot ^ (slot >> 32)) & mask; numbers_[slot] != kNone; slot = (slot + 1) & mask) {
      if (keys_[slot] == key) return numbers_[slot];
    }
    keys_[slot] = key;
    return numbers_[slot];
  }

 private:
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> numbers_;
};

class Subdivision {
 public:
  Subdivision(Sampler& sampler, const Job& job, const WhittedSettings& settings)
      : sampler_(sampler), settings_(settings), corner_at_(job.samples) {
    radiances_.reserve(job.samples);
    cover(job);
  }

  /// Divides squares until the samples are spent.
  void divide() {
    while (!candidates_.empty() && divide_square(candidates_.top().square)) {
    }
  }

  void reconstruct(Rendering& rendering) const {
    std::vector<double> sums(rendering.pixels.size(), 0.0);
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      if (!divided_[i]) add(squares_[i], rendering.width, sums);
    }
    std::transform(sums.begin(), sums.end(), rendering.pixels.begin(),
                   [](double sum) { return static_cast<float>(sum); });
  }

 private:
  void cover(const Job& job) {
    const double share = settings_.base_share * static_cast<double>(job.samples);
    // Four corners are the least.
    const auto affordable = std::max(static_cast<std::uint64_t>(share), std::uint64_t{4});
    const auto width = static_cast<std::uint32_t>(job.width) * kPoints;
    const auto height = static_cast<std::uint32_t>(job.height) * kPoints;
    // In lattice points: from 1/16 of a pixel on.
    std::uint32_t step = kPoints / 16;
    const auto lines = [&step](std::uint64_t size) { return (size + step - 1) / step + 1; };
    while (lines(width) * lines(height) > affordable) step *= 2;
    for (std::uint32_t y = 0; y < height; y += step) {
      for (std::uint32_t x = 0; x < width; x += step) {
        append(x, y, std::min(x + step, width), std::min(y + step, height));
      }
    }
  }

  std::uint32_t corner(std::uint32_t x, std::uint32_t y) {
    std::uint32_t& number = corner_at_[key(x, y)];
    if (number == CornerTable::kNone) {
      number = static_cast<std::uint32_t>(radiances_.size());
      radiances_.push_back(
          sampler_.take(static_cast<double>(x) / kPoints, static_cast<double>(y) / kPoints).rgb);
    }
    return number;
  }

  void append(std::uint32_t left, std::uint32_t top, std::uint32_t right, std::uint32_t bottom) {
    const auto index = static_cast<std::uint32_t>(squares_.size());
    // In braces, the order of evaluation is that of the text.
    const Square square{
        left,
        top,
        right,
        bottom,
        {corner(left, top), corner(right, top), corner(left, bottom), corner(right, bottom)}};
    squares_.push_back(square);
    divided_.push_back(false);
    candidates_.push({contrast(square) * square.area(), square.area(), index});
  }

  [[nodiscard]] double contrast(const Square& square) const {
    float largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      float low = settings_.white;
      float high = 0;
      for (const std::uint32_t corner : square.corners) {
        const float value = std::clamp(radiances_[corner][c], 0.0f, settings_.white);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      largest = std::max(largest, high - low);
    }
    return static_cast<double>(largest);
  }

  /// False when the samples do not suffice.
  bool divide_square(std::uint32_t index) {
    const Square square = squares_[index];
    const std::uint32_t x = std::midpoint(square.left, square.right);
    const std::uint32_t y = std::midpoint(square.top, square.bottom);
    const std::uint64_t keys[5] = {key(x, y), key(x, square.top), key(square.left, y),
                                   key(square.right, y), key(x, square.bottom)};
    std::uint64_t missing = 0;
    for (const std::uint64_t k : keys) missing += corner_at_[k] == CornerTable::kNone;
    if (missing > sampler_.left()) return false;
    candidates_.pop();
    // Too small for the lattice.
    if (square.right - square.left < 2 || square.bottom - square.top < 2) return true;
    divided_[index] = true;
    append(square.left, square.top, x, y);
    append(x, square.top, square.right, y);
    append(square.left, y, x, square.bottom);
    append(x, y, square.right, square.bottom);
    return true;
  }

  void add(const Square& square, std::size_t width, std::vector<double>& sums) const {
    const Rgb* corners[4];
    for (std::size_t i = 0; i < 4; ++i) corners[i] = &radiances_[square.corners[i]];
    const double square_width = square.right - square.left;
    const double square_height = square.bottom - square.top;
    for (std::uint32_t y = square.top / kPoints; y * kPoints < square.bottom; ++y) {
      const std::uint32_t top = std::max(square.top, y * kPoints);
      const std::uint32_t bottom = std::min(square.bottom, (y + 1) * kPoints);
      // The integral of a bilinear function is its value at the middle times the area.
      const double t = ((top + bottom) * 0.5 - square.top) / square_height;
      for (std::uint32_t x = square.left / kPoints; x * kPoints < square.right; ++x) {
        const std::uint32_t left = std::max(square.left, x * kPoints);
        const std::uint32_t right = std::min(square.right, (x + 1) * kPoints);
        const double s = ((left + right) * 0.5 - square.left) / square_width;
        const double area = static_cast<double>(right - left) * static_cast<double>(bottom - top) /
                            (double{kPoints} * kPoints);
        const double weights[4] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
        double* pixel = &sums[(y * width + x) * 3];
        for (std::size_t i = 0; i < 4; ++i) {
          for (std::size_t c = 0; c < 3; ++c) {
            pixel[c] += area * weights[i] * static_cast<double>((*corners[i])[c]);
          }
        }
      }
    }
  }

  Sampler& sampler_;
  const WhittedSettings& settings_;
  CornerTable corner_at_;
  std::vector<Rgb> radiances_;  // of the corners
  std::vector<Square> squares_;
  std::vector<bool> divided_;
  std::priority_queue<Candidate> candidates_;
};

}  // namespace

Rendering whitted(const Radiance& radiance, const Job& job, const WhittedSettings& settings) {
  Sampler sampler(radiance, job);
  if (job.samples < 4) {
    const std::vector<Sample> samples = supersamples(sampler, job, true);
    Rendering rendering = sampler.rendering();
    // Wide enough for a box to hold the whole image wherever it is centred.
    const float everywhere = static_cast<float>(2 * std::max(job.width, job.height));
    weighted_average(samples, PixelFilter::box, {&everywhere, 1}, rendering);
    return rendering;
  }
  Subdivision subdivision(sampler, job, settings);
  subdivision.divide();
  Rendering rendering = sampler.rendering();
  subdivision.reconstruct(rendering);
  return rendering;
}

}  // namespace baselines
