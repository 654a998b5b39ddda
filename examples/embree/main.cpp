// SPDX-License-Identifier: MIT
// A renderer on Embree that lets freqsynth choose its samples, or takes them plainly to compare.

#include <chrono>
#include <cstdio>
#include <exception>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "common/channel_file.h"
#include "common/interrupt.h"
#include "common/option_values.h"
#include "common/output_file.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "options.h"

namespace {

using namespace embree_host;

Renderer make_renderer(const Options& options) {
  View view;
  Model model = options.obj.empty() ? make_colonnade(view) : read_obj(options.obj, view);
  if (options.eye) view.eye = *options.eye;
  if (options.target) view.target = *options.target;
  if (options.half_field) view.half_field = *options.half_field;
  const Vec3 forward = view.target - view.eye;
  if (forward.x == 0 && forward.y == 0) {
    throw UsageError("--target: is above or below --eye, or in the same place");
  }
  Sky sky;
  sky.sun_radius = options.sun_size * std::numbers::pi / 360;
  return Renderer(Geometry(std::move(model)), view, sky, options.job.width, options.job.height,
                  options.light_samples);
}

/// \return the exit code
int render(const Options& options) {
  const Job& job = options.job;
  check_picture(options.output, job.width, job.height, 3);
  if (!options.checkpoint.empty()) check_writable(options.checkpoint);
  const Renderer renderer = make_renderer(options);
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
