// SPDX-License-Identifier: MIT
// A long synthesis that is ended in the middle of a wave, and goes on from a file in another
// program.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/freqsynth.h"
#include "freqsynth/synthesizer_file.h"

static float trace(const freqsynth::Request& ray) {
  return static_cast<float>(0.5 + 0.5 * std::cos(0.002 * (ray.x * ray.x + ray.y * ray.y)));
}

static const freqsynth::SynthesisSettings settings{.width = 160, .height = 120, .channels = 1};
static const freqsynth::StopRule stop{.samples_per_pixel = 2};

// To so many samples, or to the end.
static void render(freqsynth::Synthesizer& engine, std::uint64_t samples) {
  while (engine.stats().samples < samples) {
    std::vector<freqsynth::Request> rays(100);
    rays.resize(engine.request(rays));
    if (rays.empty()) return;
    std::vector<float> values;
    for (const freqsynth::Request& ray : rays) values.push_back(trace(ray));
    engine.deliver(rays, values);
  }
}

// All that a program has to do to be interrupted at any time: load what there is, save now and
// then.
static freqsynth::Synthesizer start(const std::string& file) {
  if (std::filesystem::exists(file)) return freqsynth::load_synthesizer(file, settings);
  return freqsynth::Synthesizer(settings);
}

int main() {
  const std::string file = "save_and_resume.state";
  std::filesystem::remove(file);
  {
    freqsynth::Synthesizer engine = start(file);
    engine.set_stop(stop);
    render(engine, 20000);
    std::vector<freqsynth::Request> owed(7);
    owed.resize(engine.request(owed));  // on their way when the file is written
    save_file(file, engine);
    std::printf("saved after %llu samples, with %zu requests owed\n",
                static_cast<unsigned long long>(engine.stats().samples), owed.size());
  }  // what would come for these now is lost

  freqsynth::Synthesizer engine = start(file);
  std::printf("loaded after %llu samples\n",
              static_cast<unsigned long long>(engine.stats().samples));
  render(engine, 1000000);  // the stop rule was saved as well

  freqsynth::Synthesizer undisturbed(settings);
  undisturbed.run([](const freqsynth::Request& ray) { return trace(ray); }, stop);
  const auto pixels = freqsynth::reconstruct(engine.finished_image());
  const bool same = pixels == freqsynth::reconstruct(undisturbed.finished_image());
  std::printf("%llu samples at the end, %s picture as without an interruption\n",
              static_cast<unsigned long long>(engine.stats().samples),
              same ? "the same" : "another");

  try {
    freqsynth::SynthesisSettings others = settings;
    others.priority.exploration = 0.5;
    const freqsynth::Synthesizer other = freqsynth::load_synthesizer(file, others);
  } catch (const std::runtime_error& error) {
    std::printf("%s\n", error.what());
  }
  std::filesystem::remove(file);
}
