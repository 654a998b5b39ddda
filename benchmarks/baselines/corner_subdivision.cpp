// SPDX-License-Identifier: MIT
#include "corner_subdivision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sampler.h"
#include "supersampling.h"

namespace baselines {
namespace {

/// Corners lie on a lattice of this many points per pixel, so that one is found again without
/// rounding.
constexpr std::uint32_t kPoints = 256;

struct Square {
  std::uint32_t x, y, side;  // in lattice points
};

class Corners {
 public:
  explicit Corners(Sampler& sampler) : sampler_(sampler) {}

  Rgb take(std::uint32_t x, std::uint32_t y) {
    const auto [found, is_new] = taken_.try_emplace(key(x, y));
    if (is_new) {
      found->second =
          sampler_.take(static_cast<double>(x) / kPoints, static_cast<double>(y) / kPoints).rgb;
    }
    return found->second;
  }

  /// Takes the corners that are new. False, and nothing is taken, when there are too many of them.
  bool take_divided(const Square& square) {
    const std::uint32_t half = square.side / 2;
    constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 5> kNew = {
        {{1, 1}, {1, 0}, {0, 1}, {2, 1}, {1, 2}}};
    std::uint64_t missing = 0;
    for (const auto& [i, j] : kNew) {
      missing += taken_.contains(key(square.x + i * half, square.y + j * half)) ? 0 : 1;
    }
    if (missing > sampler_.left()) return false;
    for (const auto& [i, j] : kNew) take(square.x + i * half, square.y + j * half);
    return true;
  }

  std::array<Rgb, 4> of(const Square& square) {
    const std::uint32_t right = square.x + square.side;
    const std::uint32_t bottom = square.y + square.side;
    return {take(square.x, square.y), take(right, square.y), take(square.x, bottom),
            take(right, bottom)};
  }

 private:
  static std::uint64_t key(std::uint32_t x, std::uint32_t y) {
    return (std::uint64_t{y} << 32) | x;
  }

  Sampler& sampler_;
  std::unordered_map<std::uint64_t, Rgb> taken_;
};

/// The greatest difference of two corners.
float contrast(const std::array<Rgb, 4>& corners, float white) {
  float greatest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      float difference = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        difference += std::abs(std::clamp(corners[i][c], 0.0f, white) -
                               std::clamp(corners[j][c], 0.0f, white));
      }
      greatest = std::max(greatest, difference);
    }
  }
  return greatest;
}

}  // namespace

Rendering corner_subdivision(const Radiance& radiance, const Job& job,
                             const CornerSubdivisionSettings& settings) {
  if (job.samples < (job.width + 1) * (job.height + 1)) {
    return supersampling(radiance, job, {.jittered = false});
  }
  Sampler sampler(radiance, job);
  Corners corners(sampler);
  const auto width = static_cast<std::uint32_t>(job.width);
  const auto height = static_cast<std::uint32_t>(job.height);
  for (std::uint32_t y = 0; y <= height; ++y) {
    for (std::uint32_t x = 0; x <= width; ++x) corners.take(x * kPoints, y * kPoints);
  }
  std::vector<Square> squares;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x)
      squares.push_back({x * kPoints, y * kPoints, kPoints});
  }

  std::vector<double> sums(job.width * job.height * 3, 0.0);
  const auto leave = [&](const Square& square) {
    const double area = static_cast<double>(square.side) / kPoints;
    const std::size_t pixel = square.y / kPoints * job.width + square.x / kPoints;
    for (const Rgb& rgb : corners.of(square)) {
      for (std::size_t c = 0; c < 3; ++c) {
        sums[pixel * 3 + c] += 0.25 * area * area * static_cast<double>(rgb[c]);
      }
    }
  };
  for (unsigned level = 0; level <= settings.depth; ++level) {
    std::vector<std::pair<float, Square>> different;
    for (const Square& square : squares) {
      const float difference = contrast(corners.of(square), settings.white);
      if (level < settings.depth && difference > settings.threshold) {
        different.emplace_back(difference, square);
      } else {
        leave(square);
      }
    }
    squares.clear();
    std::stable_sort(different.begin(), different.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [difference, square] : different) {
      if (!corners.take_divided(square)) {
        leave(square);
        continue;
      }
      const std::uint32_t half = square.side / 2;
      squares.push_back({square.x, square.y, half});
      squares.push_back({square.x + half, square.y, half});
      squares.push_back({square.x, square.y + half, half});
      squares.push_back({square.x + half, square.y + half, half});
    }
  }
  Rendering rendering = sampler.rendering();
  std::transform(sums.begin(), sums.end(), rendering.pixels.begin(),
                 [](double sum) { return static_cast<float>(sum); });
  return rendering;
}

}  // namespace baselines
