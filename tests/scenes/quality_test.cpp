// The promise of the library on the paper's scenes: better pictures than jittered samples give,
// with wide margins. The figures themselves are measured by benchmarks, not here.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <vector>

#include "freqsynth/freqsynth.h"
#include "scenes/scene.h"

namespace {

constexpr std::size_t size = 128;

class Picture {
 public:
  explicit Picture(const char* name)
      : scene_(scenes::make_scene({.name = name, .width = size, .height = size})) {}

  /// `strata` squared jittered samples per pixel, averaged.
  std::vector<float> jittered(std::size_t strata, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    std::vector<float> pixels;
    const auto side = static_cast<double>(strata);
    for (std::size_t i = 0; i < size * size; ++i) {
      std::array<double, 3> sum{};
      for (std::size_t j = 0; j < strata * strata; ++j) {
        const double x = (static_cast<double>(j % strata) + uniform(random)) / side;
        const double y = (static_cast<double>(j / strata) + uniform(random)) / side;
        const auto rgb = at(static_cast<double>(i % size) + x, static_cast<double>(i / size) + y);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += double{rgb[c]};
      }
      for (const double value : sum) pixels.push_back(static_cast<float>(value / (side * side)));
    }
    return pixels;
  }

  freqsynth::FrequencyImage synthesized(double samples_per_pixel) const {
    freqsynth::Synthesizer engine({.width = size, .height = size});
    engine.run([&](double x, double y) { return at(x, y); },
               {.samples_per_pixel = samples_per_pixel});
    return engine.finished_image();
  }

 private:
  std::array<float, 3> at(double x, double y) const {
    std::array<float, 3> rgb{};
    scene_->radiance(x, y, 0, rgb);
    return rgb;
  }

  std::unique_ptr<scenes::Scene> scene_;
};

double root_mean_square(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Quality, OneSamplePerPixelBeatsOneJitteredSample) {
  for (const char* name : {"fan", "chess"}) {
    const Picture picture(name);
    const auto reference = picture.jittered(12, 1);
    const double jittered = root_mean_square(picture.jittered(1, 2), reference);
    const double ours = root_mean_square(freqsynth::reconstruct(picture.synthesized(1)), reference);
    EXPECT_LT(ours, 0.75 * jittered) << name;
  }
}

TEST(Quality, ErrorFallsWithSamples) {
  const Picture picture("chess");
  const auto reference = picture.jittered(12, 1);
  double before = 1e9;
  for (const double rate : {1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0}) {
    const double error =
        root_mean_square(freqsynth::reconstruct(picture.synthesized(rate)), reference);
    EXPECT_LT(error, 0.95 * before) << rate;
    before = error;
  }
}

// A whole block that is missed stands out by its error while it got few samples.
TEST(Quality, NoBlockIsMissed) {
  for (const char* name : {"fan", "chess"}) {
    const Picture picture(name);
    const auto reference = picture.jittered(12, 1);
    const freqsynth::FrequencyImage image = picture.synthesized(1);
    const auto pixels = freqsynth::reconstruct(image);
    const double overall = root_mean_square(pixels, reference);
    for (std::size_t by = 0; by < image.blocks_y(); ++by) {
      for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
        double sum = 0;
        for (std::size_t i = 0; i < 3 * freqsynth::max_terms; ++i) {
          const std::size_t place = ((8 * by + i / 24) * size + 8 * bx) * 3 + i % 24;
          sum += std::pow(double{pixels[place]} - double{reference[place]}, 2);
        }
        const double error = std::sqrt(sum / (3 * freqsynth::max_terms));
        EXPECT_FALSE(error > 5 * overall && image.samples(bx, by) < 64)
            << name << ", block " << bx << ", " << by << ": " << error;
      }
    }
  }
}

}  // namespace
