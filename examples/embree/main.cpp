// SPDX-License-Identifier: MIT
// A renderer on Embree that lets freqsynth choose its samples, or takes them plainly to compare.

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "common/channel_file.h"
#include "common/interrupt.h"
#include "common/option_values.h"
#include "common/output_file.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "options.h"
#include "rendering.h"

namespace {

using namespace embree_host;

/// \return the exit code
int render(const Options& options) {
  const Job job{options.width, options.height, options.samples_per_pixel, options.frame};
  check_picture(options.output, job.width, job.height, 3);
  if (!options.checkpoint.empty()) check_writable(options.checkpoint);
  const Renderer renderer = make_renderer(options.scene, job.width, job.height);
  note_interrupts();
  HostPool pool = make_pool(options.threads);
  ProgressBar bar;
  const Watch watch = [&](const freqsynth::Progress& progress) {
    bar.show(progress.fraction, progress.seconds_left);
    return noted_interrupt() == 0;
  };
  const auto begin = std::chrono::steady_clock::now();
  const Pixels pixels =
      options.sampler == "freqsynth"
          ? render_adaptively(renderer, job, pool, watch,
                              {"freqsynth_embree", options.checkpoint, options.checkpoint_every},
                              options.resume)
          : render_plainly(renderer, job,
                           options.sampler == "sobol" ? path_tracer::Numbers::sobol
                                                      : path_tracer::Numbers::random,
                           pool, watch);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  write_channels(options.output, {job.width, job.height, channel_names, pixels});
  if (noted_interrupt() != 0) {
    std::fprintf(stderr, "freqsynth_embree: interrupted; what there was is written\n");
    return 128 + noted_interrupt();  // as a shell says it
  }
  std::printf("%s: %zu triangles, %g samples per pixel in %.2f s\n", options.output.c_str(),
              renderer.geometry().model().triangles.size(), job.samples_per_pixel, seconds.count());
  return 0;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    return options ? render(*options) : 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_embree: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_embree: %s\n", error.what());
    return 1;
  }
}
