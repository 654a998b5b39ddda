// SPDX-License-Identifier: MIT
// Results that must not change by accident: a hash of the bits of every coefficient, count and
// pixel of each configuration below, compared with the one on record. Without arguments; prints
// one line each, and fails where a hash differs. It needs nothing but the library, so that other
// compilers, processors and ways to build can run it.

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "freqsynth/freqsynth.h"

namespace {

using namespace freqsynth;

/// FNV-1a over 32-bit words.
class Hash {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(std::span<const float> values) {
    for (const float value : values) add(value);
  }
  void add(const FrequencyImage& image) {
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) {
        add(image.samples(x, y));
        for (std::size_t c = 0; c < image.channels(); ++c) add(image.coefficients(x, y, c));
      }
    }
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

double square(double x) { return x * x; }

/// A disc, an edge, a smooth hill and stripes. Arithmetic only, so that it has the same bits
/// wherever there is IEEE arithmetic.
double picture(double x, double y) {
  const double disc = square(x - 31.3) + square(y - 40.7) < 400 ? 0.8 : 0.1;
  const double edge = 3 * x + 7 * y > 700 ? 0.4 : 0;
  const double hill = 1 / (1 + (square(x - 90) + square(y - 20)) / 300);
  const auto stripe = static_cast<long>(x * 0.31 + y * 0.17);
  return disc + edge + hill + (y > 64 ? 0.25 * static_cast<double>(stripe % 2) : 0);
}

std::array<float, 3> rgb(double x, double y) {
  const double p = picture(x, y);
  return {static_cast<float>(p), static_cast<float>(0.5 * p + 0.002 * x),
          static_cast<float>(picture(y, x) * 0.7)};
}

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Hashes what an engine has: its images, finished pixels and counters.
template <class Sampler>
std::uint64_t hash_of(const SynthesisSettings& settings, Sampler&& sampler, const StopRule& stop) {
  Synthesizer engine(settings);
  const RunReport report = engine.run(sampler, stop);
  Hash hash;
  hash.add(engine.image());
  hash.add(engine.finished_image());
  hash.add(static_cast<std::uint32_t>(engine.stats().samples));
  hash.add(static_cast<std::uint32_t>(engine.stats().absorbed));
  hash.add(static_cast<std::uint32_t>(engine.stats().bad_samples));
  hash.add(static_cast<std::uint32_t>(report.reason));
  return hash.value();
}

std::uint64_t color() {
  return hash_of({.width = 203, .height = 117}, rgb, {.samples_per_pixel = 0.5});
}

std::uint64_t gray() {
  return hash_of({.width = 64, .height = 64, .channels = 1}, picture, {.samples_per_pixel = 4});
}

std::uint64_t change() {
  SynthesisSettings settings{.width = 160, .height = 120};
  settings.priority.measure = PriorityMeasure::change;
  return hash_of(settings, rgb, {.samples_per_pixel = 1});
}

std::uint64_t strict() {
  return hash_of({.width = 96, .height = 64, .wave = 1}, rgb, {.samples_per_pixel = 1});
}

std::uint64_t weighted() {
  SynthesisSettings settings{.width = 100, .height = 60};
  settings.channel_settings = {{.weight = 0.2f}, {.weight = 0.7f}, {.weight = 0.1f}};
  for (int i = 0; i < 13 * 8; ++i) settings.importance.push_back(static_cast<float>(i % 5));
  return hash_of(settings, rgb, {.samples_per_pixel = 1.5});
}

std::uint64_t noisy() {
  const auto sampler = [](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const double noise = static_cast<double>(mix(requests[i].id + 1) >> 11) * 0x1p-53;
      values[i] = static_cast<float>(picture(requests[i].x, requests[i].y) * 2 * noise);
    }
  };
  return hash_of({.width = 128, .height = 96, .channels = 1, .noise = freqsynth::Noise::present},
                 sampler, {.samples_per_pixel = 3});
}

std::uint64_t until_quantized() {
  SynthesisSettings settings{.width = 120, .height = 88};
  settings.quantization = quantization_target({.luminance = scale_table(luminance_table(), 60),
                                               .chrominance = scale_table(chrominance_table(), 60),
                                               .subsampling = Subsampling::both},
                                              3);
  const auto sampler = [](double x, double y) {
    std::array<float, 3> values = rgb(x, y);
    for (float& value : values) value *= 100;
    return values;
  };
  return hash_of(settings, sampler, {.samples_per_pixel = 20});
}

std::uint64_t threshold() {
  return hash_of({.width = 96, .height = 96}, rgb,
                 {.aliasing_threshold = 0.004, .least_samples = 0});
}

std::uint64_t capped() {
  return hash_of({.width = 72, .height = 72, .max_samples_per_block = 50}, rgb, {});
}

std::uint64_t other_list() {
  SynthesisSettings settings{.width = 120, .height = 90};
  settings.list = {.samples_per_term = 2, .max_terms = 30, .seed = 7};
  return hash_of(settings, rgb, {.samples_per_pixel = 1});
}

std::uint64_t bad_values() {
  const auto sampler = [](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const std::array<float, 3> all = rgb(requests[i].x, requests[i].y);
      for (std::size_t c = 0; c < 3; ++c) values[3 * i + c] = all[c];
      if (mix(requests[i].id) % 9 == 0) values[3 * i + 1] = std::numeric_limits<float>::infinity();
      if (mix(requests[i].id) % 11 == 0) values[3 * i] = std::numeric_limits<float>::quiet_NaN();
    }
  };
  return hash_of({.width = 104, .height = 80}, sampler, {.samples_per_pixel = 1});
}

std::uint64_t high_range() {
  const auto sampler = [](double x, double y) {
    const double p = picture(x, y);
    return p > 0.9 ? p * 1e6 : p;
  };
  return hash_of({.width = 80, .height = 80, .channels = 1}, sampler, {.samples_per_pixel = 2});
}

std::uint64_t many_channels() {
  const auto sampler = [](double x, double y) {
    std::array<float, 7> values{};
    for (std::size_t c = 0; c < 7; ++c) {
      values[c] = static_cast<float>(picture(x + 3.0 * static_cast<double>(c), y));
    }
    return values;
  };
  return hash_of({.width = 50, .height = 33, .channels = 7}, sampler, {.samples_per_pixel = 2});
}

/// What comes after the engine: pixels of other sizes, quantised blocks and the way back.
std::uint64_t outputs() {
  Synthesizer engine({.width = 77, .height = 59});
  engine.run(rgb, {.samples_per_pixel = 1.25});
  Hash hash;
  for (const double scale : {0.4, 1.0, 2.5}) {
    hash.add(reconstruct(engine.finished_image(), {}, scale));
    hash.add(reconstruct(engine.image(), {.clamp_negative = true}, scale));
    hash.add(reconstruct(engine.image(), {.pixel_filter = PixelFilter::none}, scale));
  }
  std::array<float, 3> value;
  evaluate(engine.image(), {}, 20.25, 41.5, value);
  hash.add(value);
  for (const Subsampling subsampling : {Subsampling::none, Subsampling::both}) {
    const QuantizedImage quantized =
        quantize(engine.finished_image(), {.subsampling = subsampling});
    for (const QuantizedComponent& component : quantized.components) {
      for (const std::int16_t level : component.values) {
        hash.add(static_cast<std::uint32_t>(level));
      }
    }
    hash.add(dequantize(quantized));
  }
  return hash.value();
}

struct Configuration {
  std::string_view name;
  std::uint64_t (*run)();
  std::uint64_t recorded;
};

constexpr Configuration configurations[] = {
    {"color", color, 0x6deee15d66456c18u},
    {"gray", gray, 0x5ffbe803097c01efu},
    {"change", change, 0x1bc9936aa4434647u},
    {"strict", strict, 0x54524a16bdf84efcu},
    {"weighted", weighted, 0x835ed91e6ef2ec8bu},
    {"noisy", noisy, 0x5856f13124508d7du},
    {"until_quantized", until_quantized, 0x9ed90a8c22dad437u},
    {"threshold", threshold, 0xe8e4a171b62d6ff6u},
    {"capped", capped, 0x8e992b5183e04e6fu},
    {"other_list", other_list, 0x1727332b8a27e57au},
    {"bad_values", bad_values, 0x2a42b68fcfc52215u},
    {"high_range", high_range, 0x524369e913731906u},
    {"many_channels", many_channels, 0x96cf2baf8456bb5du},
    {"outputs", outputs, 0xdc3593c1b5ad48dcu},
};

}  // namespace

int main() {
  int differing = 0;
  for (const Configuration& configuration : configurations) {
    const std::uint64_t hash = configuration.run();
    const bool same = hash == configuration.recorded;
    std::printf("%-16s %016llx%s\n", configuration.name.data(),
                static_cast<unsigned long long>(hash), same ? "" : "  differs from the record");
    if (!same) ++differing;
  }
  return differing == 0 ? 0 : 1;
}
