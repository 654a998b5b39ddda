// SPDX-License-Identifier: MIT
// A small path tracer that lets freqsynth choose its samples, or takes them plainly to compare.

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/channel_file.h"
#include "common/picture.h"
#include "common/shared_options.h"
#include "rendering.h"

namespace {

constexpr const char* usage_line = "freqsynth_path_tracer -o FILE [options]";

struct Options : SharedOptions {
  Options() {
    width = height = 256;
    samples_per_pixel = 4;
  }
  std::string scene = "cornell";
};

/// Empty when --help was asked for and printed.
std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  CommandLine line("freqsynth_path_tracer: a path tracer as a host of freqsynth", usage_line,
                   options);
  line.parser().arg("--scene %s:NAME", &options.scene).help("cornell or spheres (cornell)");
  line.add_size();
  line.add_rate();
  line.add_sampler();
  line.add_frame();
  line.add_threads();
  line.add_channels();
  if (!line.read(argc, argv)) {
    line.print_help();
    return std::nullopt;
  }
  line.require_output();
  return options;
}

void render(const Options& options) {
  const path_tracer::Job job{options.width, options.height, options.samples_per_pixel,
                             options.frame};
  const path_tracer::Scene scene = [&] {
    try {
      return path_tracer::make_scene(options.scene, job.width, job.height);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--scene: ") + error.what());
    }
  }();
  check_picture(options.output, job.width, job.height, 3);
  freqsynth::ThreadPool pool(options.threads);
  const auto begin = std::chrono::steady_clock::now();
  const path_tracer::Pixels pixels =
      options.sampler == "freqsynth"
          ? render_adaptively(scene, job, pool)
          : render_plainly(scene, job,
                           options.sampler == "sobol" ? path_tracer::Numbers::sobol
                                                      : path_tracer::Numbers::random,
                           pool);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  write_channels(options.output, {job.width, job.height, path_tracer::channel_names, pixels});
  std::printf("%s: %g samples per pixel in %.2f s\n", options.output.c_str(), job.samples_per_pixel,
              seconds.count());
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    if (const std::optional<Options> options = parse_options(argc, argv)) render(*options);
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_path_tracer: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_path_tracer: %s\n", error.what());
    return 1;
  }
}
