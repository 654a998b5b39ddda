// SPDX-License-Identifier: MIT
#include "quality/procedural_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/basis/mix_bits.h"

namespace quality {
namespace {

using Colour = std::array<float, 3>;

/// In 0..1, by whole numbers.
double random_at(std::int64_t x, std::int64_t y, std::uint64_t what) {
  std::uint64_t bits = freqsynth::detail::mix_bits(what + 0x9e3779b97f4a7c15u);
  bits = freqsynth::detail::mix_bits(bits ^ static_cast<std::uint64_t>(x));
  bits = freqsynth::detail::mix_bits(bits ^ static_cast<std::uint64_t>(y));
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// Numbers on a grid of whole positions, with smooth steps between them.
double grid_noise(double x, double y, std::uint64_t what) {
  const double left = std::floor(x), top = std::floor(y);
  const auto i = static_cast<std::int64_t>(left), j = static_cast<std::int64_t>(top);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double s = smooth(x - left), t = smooth(y - top);
  return (1 - t) * ((1 - s) * random_at(i, j, what) + s * random_at(i + 1, j, what)) +
         t * ((1 - s) * random_at(i, j + 1, what) + s * random_at(i + 1, j + 1, what));
}

/// Octaves of it, each `less` times the one before, turned against each other; in 0..1.
double fractal(double x, double y, int octaves, double less, std::uint64_t what) {
  double sum = 0, weights = 0, weight = 1;
  for (int k = 0; k < octaves; ++k) {
    sum += weight * grid_noise(x, y, what + static_cast<std::uint64_t>(k));
    weights += weight;
    weight *= less;
    const double turned = 1.6 * x + 1.2 * y;
    y = 1.6 * y - 1.2 * x;
    x = turned;
  }
  return sum / weights;
}

Colour colour_of(std::int64_t number, std::uint64_t what) {
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = static_cast<float>(0.05 + 0.9 * random_at(number, static_cast<int>(c), what));
  }
  return colour;
}

Colour shade(const Colour& colour, double factor) {
  const auto f = static_cast<float>(factor);
  return {f * colour[0], f * colour[1], f * colour[2]};
}

Colour plasma(double x, double y) {
  const double height = fractal(x / 60, y / 60, 5, 0.5, 11);
  return colour_of(static_cast<std::int64_t>(std::floor(10 * height)), 12);
}

Colour clouds(double x, double y) {
  const double thick = fractal(x / 80, y / 80, 7, 0.55, 21);
  const double white = std::clamp(2.5 * (thick - 0.35), 0.0, 1.0);
  const double shadow = 0.7 + 0.3 * fractal(x / 40 + 9, y / 40, 5, 0.5, 31);
  const auto mix = [&](double sky) { return static_cast<float>(sky + white * (shadow - sky)); };
  return {mix(0.12), mix(0.3), mix(0.7)};
}

/// Distance of a point from a segment.
double from_segment(double x, double y, double ax, double ay, double bx, double by) {
  const double dx = bx - ax, dy = by - ay;
  const double square = dx * dx + dy * dy;
  const double along = square > 0 ? ((x - ax) * dx + (y - ay) * dy) / square : 0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(x - ax - t * dx, y - ay - t * dy);
}

Colour strokes(double x, double y) {
  constexpr double apart = 15, advance = 8, paper = 0.85, ink = 0.04;
  const auto line = static_cast<std::int64_t>(std::floor(y / apart));
  const double size = line % 4 == 3 ? 1.4 : 0.9;  // of a letter
  const auto letter = static_cast<std::int64_t>(std::floor(x / (advance * size)));
  const double u = x / size - advance * static_cast<double>(letter);
  const double v = (y - apart * static_cast<double>(line) - 2) / size;
  const auto tint = [](double gray) {
    const auto g = static_cast<float>(gray);
    return Colour{g, g, 0.95F * g};
  };
  const auto draw = [&](int k) { return random_at(letter, line, 40 + static_cast<unsigned>(k)); };
  if (draw(0) < 0.15) return tint(paper);  // between words
  double nearest = 100;
  // Up to three strokes, each between two of a letter's nine places, and a bow.
  const auto place = [&](int k) {
    const int at = static_cast<int>(9 * draw(k));
    return std::pair<double, double>{1.2 + 2.4 * (at % 3), 0.8 + 3.6 * (at / 3)};
  };
  for (int k = 0; k < 3; ++k) {
    if (draw(10 + k) < 0.25) continue;
    const auto from = place(1 + 2 * k), to = place(2 + 2 * k);
    nearest = std::min(nearest, from_segment(u, v, from.first, from.second, to.first, to.second));
  }
  if (draw(13) < 0.6) {
    const double middle = draw(14) < 0.5 ? 2.8 : 5.8;
    nearest = std::min(nearest, std::abs(std::hypot(u - 3.6, v - middle) - 2.3));
  }
  return tint(nearest < 0.55 ? ink : paper);
}

Colour cells(double x, double y) {
  constexpr double size = 17;
  const auto column = static_cast<std::int64_t>(std::floor(x / size));
  const auto row = static_cast<std::int64_t>(std::floor(y / size));
  double first = 1e9, second = 1e9;
  std::int64_t nearest = 0;
  for (std::int64_t j = row - 2; j <= row + 2; ++j) {
    for (std::int64_t i = column - 2; i <= column + 2; ++i) {
      const double dx = size * (static_cast<double>(i) + random_at(i, j, 61)) - x;
      const double dy = size * (static_cast<double>(j) + random_at(i, j, 62)) - y;
      const double distance = std::hypot(dx, dy);
      second = std::min(second, std::max(distance, first));
      if (distance < first) {
        first = distance;
        nearest = j * 100000 + i;
      }
    }
  }
  if (second - first < 1.6) return {0.02F, 0.02F, 0.02F};
  return shade(colour_of(nearest, 63), 1 - 0.02 * first);
}

Colour weave(double x, double y) {
  // Threads of two directions, of a distance that changes slowly.
  const double bend = 14 * grid_noise(x / 90, y / 90, 71),
               lean = 14 * grid_noise(x / 90, y / 90, 72);
  const double turn = 2 * std::numbers::pi;
  const double over = std::sin(turn * (0.24 * x + 0.09 * y + 0.7 * bend));
  const double under = std::sin(turn * (-0.05 * x + 0.13 * y + 0.5 * lean));
  const double value = 0.45 + 0.25 * over + 0.15 * under;
  return shade({0.9F, 0.75F, 0.6F}, value);
}

/// Ellipses, the first on top.
class Leaves {
 public:
  Leaves() : tiles_(tiles * tiles) {
    for (std::uint32_t k = 0; k < count; ++k) {
      const auto draw = [&](std::uint64_t what) { return random_at(k, 0, 80 + what); };
      Leaf leaf;
      leaf.x = 256 * draw(0);
      leaf.y = 256 * draw(1);
      leaf.length = 4 / std::pow(0.006 + draw(2), 0.6);
      leaf.width = leaf.length * (0.25 + 0.4 * draw(3));
      const double angle = 2 * std::numbers::pi * draw(4);
      leaf.cosine = std::cos(angle);
      leaf.sine = std::sin(angle);
      leaf.ribbed = draw(5) < 0.4;
      leaves_.push_back(leaf);
      const auto tile_of = [](double at) {
        return static_cast<std::size_t>(std::clamp(at / tile, 0.0, tiles - 1.0));
      };
      for (std::size_t j = tile_of(leaf.y - leaf.length); j <= tile_of(leaf.y + leaf.length); ++j) {
        for (std::size_t i = tile_of(leaf.x - leaf.length); i <= tile_of(leaf.x + leaf.length);
             ++i) {
          tiles_[j * tiles + i].push_back(k);
        }
      }
    }
  }

  Colour at(double x, double y) const {
    const auto tile_of = [](double at) {
      return static_cast<std::size_t>(std::clamp(at / tile, 0.0, tiles - 1.0));
    };
    for (const std::uint32_t number : tiles_[tile_of(y) * tiles + tile_of(x)]) {
      const Leaf& leaf = leaves_[number];
      const double dx = x - leaf.x, dy = y - leaf.y;
      const double u = (leaf.cosine * dx + leaf.sine * dy) / leaf.length;
      const double v = (leaf.cosine * dy - leaf.sine * dx) / leaf.width;
      if (u * u + v * v >= 1) continue;
      double light = 0.6 + 0.4 * u;
      if (leaf.ribbed) {
        const double rib = (u + 0.5 * std::abs(v)) * leaf.length / 3;
        light *= rib - std::floor(rib) < 0.2 ? 0.6 : 1;
      }
      return shade(colour_of(number, 90), light);
    }
    return {0.05F, 0.04F, 0.03F};
  }

 private:
  struct Leaf {
    double x, y, length, width, cosine, sine;
    bool ribbed;
  };
  static constexpr std::uint32_t count = 1500;
  static constexpr std::size_t tiles = 16;
  static constexpr double tile = 256.0 / tiles;

  std::vector<Leaf> leaves_;
  std::vector<std::vector<std::uint32_t>> tiles_;
};

class Procedural final : public scenes::Scene {
 public:
  using Formula = Colour (*)(double, double);

  Procedural(Formula formula, double scale) : formula_(formula), scale_(scale) {}

  void radiance(double x, double y, std::uint64_t /*id*/, std::span<float, 3> rgb) const override {
    const Colour colour = formula_(x * scale_, y * scale_);
    std::copy(colour.begin(), colour.end(), rgb.begin());
  }

 private:
  Formula formula_;
  double scale_;
};

Colour leaves(double x, double y) {
  static const Leaves all;
  return all.at(x, y);
}

}  // namespace

std::unique_ptr<scenes::Scene> make_procedural(std::string_view name, int width, int height) {
  constexpr std::pair<std::string_view, Procedural::Formula> all[] = {
      {"plasma", plasma}, {"clouds", clouds}, {"strokes", strokes},
      {"leaves", leaves}, {"cells", cells},   {"weave", weave}};
  const double scale = name == "weave" ? 1 : 256.0 / std::max(width, height);
  for (const auto& one : all) {
    if (one.first == name) return std::make_unique<Procedural>(one.second, scale);
  }
  return nullptr;
}

}  // namespace quality
