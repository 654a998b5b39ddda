// SPDX-License-Identifier: MIT
#include "options.h"

#include <OpenImageIO/argparse.h>

#include <array>
#include <cmath>
#include <numbers>

#include "common/option_values.h"

namespace embree_host {
namespace {

/// X,Y,Z
void read_place(std::string_view option, const std::string& text, std::optional<Vec3>& place) {
  if (text.empty()) return;
  std::array<double, 3> values{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2) ||
        !read_all(rest.substr(0, comma), values[i]) || !(std::abs(values[i]) < 1e9)) {
      refuse(option, text, "three numbers X,Y,Z");
    }
    rest.remove_prefix(i == 2 ? rest.size() : comma + 1);
  }
  place = {values[0], values[1], values[2]};
}

/// The values of options as they were given; empty: not given.
struct Texts {
  std::string size, spp, frame, threads, eye, target, field, sun_size, light_samples, every;
  bool help = false;
};

void describe(OIIO::ArgParse& parser, Options& options, Texts& texts) {
  parser.arg("--help", &texts.help).help("Print this help");
  parser.arg("--obj %s:FILE", &options.obj)
      .help("A Wavefront OBJ file, y up, with its materials (a colonnade of 100,000 triangles)");
  parser.arg("--eye %s:X,Y,Z", &texts.eye).help("Where the camera is; z is up");
  parser.arg("--target %s:X,Y,Z", &texts.target).help("What it looks at");
  parser.arg("--field %s:A", &texts.field).help("Degrees that the lesser side shows");
  parser.arg("--sun-size %s:A", &texts.sun_size).help("Degrees that the sun fills (2)");
  parser.arg("--size %s:WxH", &texts.size).help("Image size in pixels (960x540)");
  parser.arg("--spp %s:N", &texts.spp).help("Samples per pixel, with freqsynth also fractions (4)");
  parser.arg("--light-samples %s:N", &texts.light_samples)
      .help("Paths from what each sample sees, to the sun and to the sky (1)");
  parser.arg("--sampler %s:NAME", &options.sampler)
      .help("freqsynth; plainly: jittered, with random numbers, or sobol (freqsynth)");
  parser.arg("--frame %s:N", &texts.frame).help("Other frames have other noise (0)");
  parser.arg("--threads %s:N", &texts.threads).help("Threads that trace (all)");
  parser.arg("-o %s:FILE", &options.output)
      .help("The picture: EXR has colours, normals, sun and depth of surfaces as well");
  parser.separator("Long runs:");
  parser.arg("--checkpoint %s:FILE", &options.checkpoint)
      .help("Keeps the state of the run in a file: now and then, when interrupted, and at the end");
  parser.arg("--checkpoint-every %s:SECONDS", &texts.every).help("How often (60)");
  parser.arg("--resume %s:FILE", &options.resume)
      .help("Goes on from such a file, with the same options; the result is the same to the bit");
}

void read_values(const Texts& texts, Options& options) {
  Job& job = options.job;
  read_size("--size", texts.size, job.width, job.height);
  read_positive("--spp", texts.spp, job.samples_per_pixel);
  read_count<std::uint64_t>("--frame", texts.frame, 0, job.frame);
  read_count<std::size_t>("--threads", texts.threads, 1, options.threads);
  if (options.threads > 1024) refuse("--threads", texts.threads, "in 1..1024");
  read_count<std::uint32_t>("--light-samples", texts.light_samples, 1, options.light_samples);
  if (options.light_samples > 4096) refuse("--light-samples", texts.light_samples, "in 1..4096");
  read_positive("--checkpoint-every", texts.every, options.checkpoint_every);
  read_place("--eye", texts.eye, options.eye);
  read_place("--target", texts.target, options.target);
  read_positive("--sun-size", texts.sun_size, options.sun_size);
  if (options.sun_size > 90) refuse("--sun-size", texts.sun_size, "at most 90");
  if (!texts.field.empty()) {
    double field = 0;
    read_positive("--field", texts.field, field);
    if (field > 170) refuse("--field", texts.field, "at most 170");
    options.half_field = std::tan(field * std::numbers::pi / 360);
  }
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  Texts texts;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_embree: a renderer on Embree as a host of freqsynth");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  describe(parser, options, texts);
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (texts.help) {
    parser.print_help();
    return std::nullopt;
  }
  read_values(texts, options);
  const std::string& sampler = options.sampler;
  if (sampler != "freqsynth" && sampler != "jittered" && sampler != "sobol") {
    refuse("--sampler", sampler, "freqsynth, jittered or sobol");
  }
  const double rate = options.job.samples_per_pixel;
  if (sampler != "freqsynth" && (rate != std::floor(rate) || rate > 1e6)) {
    refuse("--spp", texts.spp, "a whole number up to 1000000, as a plain sampler needs");
  }
  if (sampler != "freqsynth" && !(options.checkpoint.empty() && options.resume.empty())) {
    throw UsageError("--checkpoint, --resume: are for --sampler freqsynth");
  }
  if (!texts.every.empty() && options.checkpoint.empty()) {
    throw UsageError("--checkpoint-every: needs --checkpoint");
  }
  if (options.output.empty()) throw UsageError("-o is missing");
  return options;
}

}  // namespace embree_host
