// SPDX-License-Identifier: MIT
// Pixel filters: how far filtered pictures are from the filtered function, beside finished pixels
// filtered as squares of one colour, and jittered samples weighted by the same filter.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <vector>

#include "freqsynth/basis/owen_sobol.h"
#include "freqsynth/freqsynth.h"

constexpr int side = 128;

// A floor of tiles in perspective with waves on it.
static double radiance(double x, double y) {
  const double depth = 60 / (y + 8);
  const bool tile = std::sin(0.2 * (x - 70) * depth + 0.3) * std::sin(40 * depth) > 0;
  return (tile ? 0.8 : 0.15) + 0.1 * std::sin(0.004 * (x * x + y * y));
}

struct Filter {
  const char* name;
  freqsynth::PixelFilter filter;
  double radius;
  double (*weight)(double);  // of a distance up to the radius, as renderers have it
};

static const Filter filters[] = {
    {"box", freqsynth::PixelFilter::box, 0.5, [](double) { return 1.0; }},
    {"tent", freqsynth::PixelFilter::tent, 1, [](double t) { return 1 - t; }},
    {"gaussian", freqsynth::PixelFilter::gaussian, 1.5,
     [](double t) { return std::exp(-2 * t * t) - std::exp(-4.5); }},
    {"blackman_harris", freqsynth::PixelFilter::blackman_harris, 1.5,
     [](double t) {
       const double p = std::acos(-1) * t / 1.5;
       return 0.35875 + 0.48829 * std::cos(p) + 0.14128 * std::cos(2 * p) +
              0.01168 * std::cos(3 * p);
     }},
    {"mitchell", freqsynth::PixelFilter::mitchell, 2, [](double t) {
       return t < 1 ? 7 * t * t * t - 12 * t * t + 16.0 / 3
                    : -7 * t * t * t / 3 + 12 * t * t - 20 * t + 32.0 / 3;
     }}};

struct Sample {
  double x, y, value;
};

// n x n samples in each pixel, each in the middle of its cell or anywhere in it.
static std::vector<Sample> samples_of(int n, bool jittered) {
  std::vector<Sample> samples;
  for (int i = 0; i < side * side * n * n; ++i) {
    const int pixel = i / (n * n), cell = i % (n * n);
    const freqsynth::OwenSobol random(static_cast<std::uint64_t>(i), 0, 1);
    const double x = pixel % side + (cell % n + (jittered ? random(0) : 0.5)) / n;
    const double y = pixel / side + (cell / n + (jittered ? random(1) : 0.5)) / n;
    samples.push_back({x, y, radiance(x, y)});
  }
  return samples;
}

// Pixels as weighted means of all samples within the radius.
static std::vector<double> weighted(const std::vector<Sample>& samples, const Filter& filter) {
  std::vector<double> sums(side * side), weights(side * side);
  const double r = filter.radius;
  for (const Sample& sample : samples) {
    const auto from = [&](double at) { return std::max(0, int(std::ceil(at - 0.5 - r))); };
    const auto to = [&](double at) { return std::min(side - 1, int(std::floor(at - 0.5 + r))); };
    for (int j = from(sample.y); j <= to(sample.y); ++j) {
      const double row = filter.weight(std::abs(j + 0.5 - sample.y));
      for (int i = from(sample.x); i <= to(sample.x); ++i) {
        const double weight = row * filter.weight(std::abs(i + 0.5 - sample.x));
        sums[static_cast<std::size_t>(j * side + i)] += weight * sample.value;
        weights[static_cast<std::size_t>(j * side + i)] += weight;
      }
    }
  }
  for (std::size_t p = 0; p < sums.size(); ++p) sums[p] /= weights[p];
  return sums;
}

// Pixels as squares of one colour.
static std::vector<double> weighted(const freqsynth::FrequencyImage& image, const Filter& filter) {
  const std::vector<float> pixels = freqsynth::reconstruct(image);
  std::vector<Sample> samples = samples_of(10, false);
  for (Sample& sample : samples) {
    sample.value = pixels[static_cast<std::size_t>(int(sample.y) * side + int(sample.x))];
  }
  return weighted(samples, filter);
}

template <class Pixels>
static double rmse(const Pixels& pixels, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t p = 0; p < truth.size(); ++p) sum += std::pow(pixels[p] - truth[p], 2);
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

int main() {
  std::printf("                       freqsynth               as squares               jittered\n");
  std::printf(
      "samples a pixel      1      4     16         1      4     16         1      4     16\n");
  const std::vector<Sample> many = samples_of(10, false);
  std::vector<freqsynth::FrequencyImage> images;
  for (const int n : {1, 2, 4}) {
    freqsynth::Synthesizer engine({.width = side, .height = side, .channels = 1});
    engine.run(radiance, {.samples_per_pixel = static_cast<double>(n * n)});
    images.push_back(engine.finished_image());
  }
  for (const Filter& filter : filters) {
    const std::vector<double> truth = weighted(many, filter);
    std::printf("%-15s", filter.name);
    for (const freqsynth::FrequencyImage& image : images) {
      std::printf(" %6.4f",
                  rmse(freqsynth::reconstruct(image, {.pixel_filter = filter.filter}), truth));
    }
    std::printf("   ");
    for (const freqsynth::FrequencyImage& image : images) {
      std::printf(" %6.4f", rmse(weighted(image, filter), truth));
    }
    std::printf("   ");
    for (const int n : {1, 2, 4}) {
      std::printf(" %6.4f", rmse(weighted(samples_of(n, true), filter), truth));
    }
    std::printf("\n");
  }
}
