// SPDX-License-Identifier: MIT
// Samplers that must not compile, one at a time (-DCASE=n), each refused with the sentence beside
// it.
#if CASE == 6  // needs the compiled library
#define FREQSYNTH_HEADER_ONLY
#include "freqsynth/engine/thread_pool.h"
#endif

#include <array>

#include "freqsynth/synthesizer.h"

// A host's own types: one of nothing but floats, and others.
struct Rgb {
  float r, g, b;
};
struct Pixel {
  float r, g, b;
  int id;
};
struct Luminance {
  explicit Luminance(float v) : value(v) {}
  float value;
};
template <>
struct freqsynth::SampleTraits<Luminance> {
  static constexpr std::size_t channel = 1;  // a slip of the pen
  static float value(const Luminance& sample, std::size_t) { return sample.value; }
};

int main() {
  freqsynth::Synthesizer engine({.width = 8, .height = 8});
#if CASE == 0  // compiles
  engine.run([](double, double) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 1   // the sampler takes whole numbers
  engine.run([](int, int) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 2   // the sampler takes whole numbers
  engine.run([](double, unsigned) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 3   // the sampler returns no sample
  engine.run([](double, double) { return Pixel{1, 1, 1, 7}; }, {});
#elif CASE == 4   // a sampler is a function
  engine.run(7, {});
#elif CASE == 5   // an executor has execute
  engine.run([](double, double) { return std::array{1.0f, 1.0f, 1.0f}; }, {}, 7);
#elif CASE == 7   // compiles
  engine.run([](double, double) { return Rgb{1, 1, 1}; }, {});
#elif CASE == 8   // a SampleTraits has static constexpr std::size_t channels
  engine.run([](const freqsynth::Request&) { return Luminance(1); }, {});
#elif CASE == 9   // the sampler returns no sample
  engine.run([](const freqsynth::Request&) {}, {});
#elif CASE == 10  // a progress callback is
  engine.run([](double, double) { return Rgb{1, 1, 1}; }, {}, freqsynth::SerialExecutor{}, 7);
#elif CASE == 11  // only a batch sampler
  auto sampler = freqsynth::strided(4, [](double, double) { return Rgb{1, 1, 1}; });
#elif CASE == 12  // a sampler is a function
  engine.run([](double) { return 1.0f; }, {});
#endif
}
