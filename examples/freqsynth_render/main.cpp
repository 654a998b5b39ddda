// SPDX-License-Identifier: MIT
// Renders a scene with freqsynth, or with jittered samples for comparison.

#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/interrupt.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "common/sampling.h"
#include "direct.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "options.h"
#include "reference.h"
#include "run_stats.h"
#include "scenes/scene.h"
#include "synthesis.h"

namespace {

std::unique_ptr<scenes::Scene> scene_of(const Options& options) {
  scenes::SceneOptions scene_options{.name = options.scene,
                                     .width = static_cast<int>(options.width),
                                     .height = static_cast<int>(options.height),
                                     .seed = options.seed};
  if (options.zone_frequency) scene_options.zone_frequency = *options.zone_frequency;
  return named_scene(scene_options);
}

/// All that can be known before the first sample of where the results go.
void check_outputs(const Options& options) {
  const std::size_t channels = options.gray ? 1 : 3;
  if (options.direct) {
    check_direct(options);
  } else if (!options.output.empty()) {
    check_picture(options.output, freqsynth::scaled_size(options.width, options.scale),
                  freqsynth::scaled_size(options.height, options.scale), channels);
  }
  if (!options.density.empty()) check_picture(options.density, options.width, options.height, 1);
  if (!options.error.empty()) {
    check_picture(options.error, options.width, options.height, channels);
  }
  if (!options.stats.empty()) check_writable(options.stats);
  if (!options.checkpoint.empty()) check_writable(options.checkpoint);
  if (!options.frames.empty()) prepare_frames(options);
}

/// \return whether it came to its end, and was not interrupted
bool render_jittered(const Options& options, const scenes::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  freqsynth::ThreadPool pool(options.threads);
  ProgressBar bar;
  const auto [picture, rows] =
      render_reference(scene, options.width, options.height, options.gray ? 1 : 3,
                       options.reference, options.seed, options.averaging, pool, [&](double share) {
                         bar.show(share);
                         return noted_interrupt() == 0;
                       });
  Seconds seconds;
  seconds.sampler = seconds.wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_picture(options.output, picture, {options.quality, options.subsampling});
  freqsynth::SynthesisStats stats;
  stats.samples = options.reference * options.width * rows;
  const bool ended = rows == options.height;
  if (!options.stats.empty()) {
    write_stats(options, stats,
                ended ? freqsynth::StopReason::samples : freqsynth::StopReason::cancelled, seconds);
  }
  return ended;
}

/// \return the exit code
int render(const Options& options) {
  const std::unique_ptr<scenes::Scene> scene = scene_of(options);
  note_interrupts();
  check_outputs(options);
  const bool ended =
      options.reference != 0 ? render_jittered(options, *scene) : synthesize(options, *scene);
  if (ended) return 0;
  std::fprintf(stderr, "freqsynth_render: interrupted; what there was is written\n");
  return 128 + noted_interrupt();  // as a shell says it
}

/// What did not fit, in the words of the command line.
std::string size_of(const Options& options) {
  std::string text =
      "--size " + std::to_string(options.width) + "x" + std::to_string(options.height);
  if (options.scale != 1) text += " --scale " + std::to_string(options.scale);
  return text;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    try {
      return render(*options);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error(size_of(*options) + ": does not fit in memory");
    }
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_render: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_render: %s\n", error.what());
    return 1;
  }
}
