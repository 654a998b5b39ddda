// SPDX-License-Identifier: MIT
// Samplers that must not compile, one at a time (-DCASE=n), each refused with the sentence beside
// it.
#if CASE == 6  // needs the compiled library
#define FREQSYNTH_HEADER_ONLY
#include "freqsynth/engine/thread_pool.h"
#endif

#include <array>

#include "freqsynth/synthesizer.h"

struct Rgb {
  float r, g, b;
};

int main() {
  freqsynth::Synthesizer engine({.width = 8, .height = 8});
#if CASE == 0  // compiles
  engine.run([](double, double) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 1  // the sampler takes whole numbers
  engine.run([](int, int) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 2  // the sampler takes whole numbers
  engine.run([](double, unsigned) { return std::array{1.0f, 1.0f, 1.0f}; }, {});
#elif CASE == 3  // a sampler is a function
  engine.run([](double, double) { return Rgb{1, 1, 1}; }, {});
#elif CASE == 4  // a sampler is a function
  engine.run(7, {});
#elif CASE == 5  // an executor has execute
  engine.run([](double, double) { return std::array{1.0f, 1.0f, 1.0f}; }, {}, 7);
#endif
}
