// SPDX-License-Identifier: MIT
#include "options.h"

#include <OpenImageIO/argparse.h>

#include <limits>

#include "common/option_values.h"
#include "freqsynth/basis/sample_sequence.h"
#include "scenes/scene.h"

namespace farm {
namespace {

/// The values of options as they were given; empty: not given.
struct Texts {
  std::string size, spp, uniform, wave, seed, threads, windows, checkpoint_every, busy, sleep,
      delays, failures;
  bool help = false;
};

void describe(OIIO::ArgParse& parser, Options& options, Texts& texts) {
  parser.arg("--help", &texts.help).help("Print this help");
  parser.arg("--scene %s:NAME", &options.scene).help(scenes::scene_list() + " (chess)");
  parser.arg("--size %s:WxH", &texts.size).help("Image size in pixels (512x512)");
  parser.arg("--spp %s:N", &texts.spp).help("Average samples per pixel, fractions included (1)");
  parser.arg("--uniform %s:N", &texts.uniform).help("Instead: N samples in each block of 8 x 8");
  parser.arg("-o %s:FILE", &options.output)
      .help("The picture: EXR and PFM hold linear values, PNG and JPEG are display-encoded (sRGB)");
  parser.arg("--stats %s:FILE", &options.stats).help("Figures of the run as JSON");
  parser.arg("--windows %s:CxR", &texts.windows)
      .help("C x R windows, each an engine on its own rank, for large pictures (one engine)");
  parser.arg("--wave %s:N", &texts.wave)
      .help("Blocks sampled between two choices: more for more ranks (1/32 of all)");
  parser.arg("--seed %s:N", &texts.seed).help("Seed of the random choices (0)");
  parser.arg("--threads %s:N", &texts.threads).help("Threads that trace on each rank (1)");
  parser.arg("--checkpoint %s:FILE", &options.checkpoint)
      .help("Keep the state of the run in a file of rank 0, to go on after the loss of all ranks");
  parser.arg("--checkpoint-every %s:SECONDS", &texts.checkpoint_every).help("How often (60)");
  parser.arg("--resume %s:FILE", &options.resume).help("Go on from there, with the same options");
  parser.separator("For trials:");
  parser.arg("--busy %s:US", &texts.busy)
      .help("Each sample computes for so many microseconds more");
  parser.arg("--sleep %s:US", &texts.sleep).help("Each sample sleeps so many microseconds");
  parser.arg("--delays %s:N", &texts.delays).help("Random delays, with a seed");
  parser.arg("--failures %s:P", &texts.failures)
      .help("Tracing 16 samples fails with this probability, but on rank 0");
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv, bool print) {
  Options options;
  Texts texts;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_mpi: renders a scene by adaptive synthesis on many machines");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  describe(parser, options, texts);
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (texts.help) {
    if (print) parser.print_help();
    return std::nullopt;
  }
  read_size("--size", texts.size, options.width, options.height);
  read_positive("--spp", texts.spp, options.samples_per_pixel);
  read_count<std::size_t>("--uniform", texts.uniform, 1, options.uniform);
  if (options.uniform > freqsynth::SampleSequence::max_size) {
    refuse("--uniform", texts.uniform,
           "at most " + std::to_string(freqsynth::SampleSequence::max_size));
  }
  read_count<std::size_t>("--wave", texts.wave, 1, options.wave);
  read_count<std::uint64_t>("--seed", texts.seed, 0, options.seed);
  read_count<std::size_t>("--threads", texts.threads, 1, options.threads);
  if (options.threads > 1024) refuse("--threads", texts.threads, "in 1..1024");
  read_size("--windows", texts.windows, options.columns, options.rows);
  read_positive("--checkpoint-every", texts.checkpoint_every, options.checkpoint_every);
  read_positive("--busy", texts.busy, options.trial.busy_microseconds);
  read_positive("--sleep", texts.sleep, options.trial.sleep_microseconds);
  if (!texts.delays.empty()) {
    read_count<std::uint64_t>("--delays", texts.delays, 0, options.trial.delays.emplace());
  }
  read_positive("--failures", texts.failures, options.trial.failures);
  if (!texts.spp.empty() && options.uniform != 0) throw UsageError("--uniform: has no --spp");
  if (options.columns != 0 && !(options.checkpoint.empty() && options.resume.empty())) {
    throw UsageError("--windows: has no --checkpoint and no --resume");
  }
  if (options.output.empty()) throw UsageError("-o: no output file is named");
  if (options.uniform != 0) {
    options.samples_per_pixel = std::numeric_limits<double>::infinity();
  }
  return options;
}

}  // namespace farm
