// SPDX-License-Identifier: MIT
// A small path tracer that lets freqsynth choose its samples, or takes them plainly to compare.

#include <OpenImageIO/argparse.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/channel_file.h"
#include "common/option_values.h"
#include "common/picture.h"
#include "rendering.h"

namespace {

constexpr const char* usage_line = "freqsynth_path_tracer -o FILE [options]";

struct Options {
  std::string scene = "cornell";
  std::string sampler = "freqsynth";
  std::string output;
  path_tracer::Job job{.width = 256, .height = 256, .samples_per_pixel = 4};
  std::size_t threads = 0;
};

/// Empty when --help was asked for and printed.
std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  std::string size, spp, frame, threads;
  bool help = false;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_path_tracer: a path tracer as a host of freqsynth");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  parser.arg("--help", &help).help("Print this help");
  parser.arg("--scene %s:NAME", &options.scene).help("cornell or spheres (cornell)");
  parser.arg("--size %s:WxH", &size).help("Image size in pixels (256x256)");
  parser.arg("--spp %s:N", &spp).help("Samples per pixel, with freqsynth also fractions (4)");
  parser.arg("--sampler %s:NAME", &options.sampler)
      .help("freqsynth; plainly: jittered, with random numbers, or sobol (freqsynth)");
  parser.arg("--frame %s:N", &frame).help("Other frames have other noise (0)");
  parser.arg("--threads %s:N", &threads).help("Threads that trace (all)");
  parser.arg("-o %s:FILE", &options.output)
      .help("The picture: EXR has colours, normals and nearness of surfaces as well");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (help) {
    parser.print_help();
    return std::nullopt;
  }
  read_size("--size", size, options.job.width, options.job.height);
  read_positive("--spp", spp, options.job.samples_per_pixel);
  read_count<std::uint64_t>("--frame", frame, 0, options.job.frame);
  read_count<std::size_t>("--threads", threads, 1, options.threads);
  if (options.threads > 1024) refuse("--threads", threads, "in 1..1024");
  const std::string& sampler = options.sampler;
  if (sampler != "freqsynth" && sampler != "jittered" && sampler != "sobol") {
    refuse("--sampler", sampler, "freqsynth, jittered or sobol");
  }
  const double rate = options.job.samples_per_pixel;
  if (sampler != "freqsynth" && (rate != std::floor(rate) || rate > 1e6)) {
    refuse("--spp", spp, "a whole number up to 1000000, as a plain sampler needs");
  }
  if (options.output.empty()) throw UsageError("-o is missing");
  return options;
}

void render(const Options& options) {
  const path_tracer::Job& job = options.job;
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
