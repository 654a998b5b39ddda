// SPDX-License-Identifier: MIT
#include "options.h"

#include <limits>
#include <sstream>

#include "common/sampling.h"
#include "freqsynth/basis/sample_sequence.h"

namespace farm {
namespace {

/// The values of options as they were given; empty: not given.
struct Texts {
  std::string uniform, windows, busy, sleep, delays, failures;
};

void describe_picture(CommandLine& line, Options& options, Texts& texts) {
  OIIO::ArgParse& parser = line.parser();
  const std::string others =
      std::string(colonnade) + ", " + std::string(obj_prefix) + "FILE (both with Embree), ";
  describe_scene(parser, options.scene, others);
  line.add_size();
  line.add_rate();
  parser.arg("--uniform %s:N", &texts.uniform).help("Instead: N samples in each block of 8 x 8");
  line.add_channels();
  line.add_stats();
  parser.arg("--windows %s:CxR", &texts.windows)
      .help("C x R windows, each an engine on its own rank, for large pictures (one engine)");
  line.add_wave();
  line.add_seed();
  line.add_threads();
}

void describe_trials(OIIO::ArgParse& parser, Options& options, Texts& texts) {
  parser.separator("For trials:");
  parser.arg("--busy %s:US", &texts.busy)
      .help("Each sample computes for so many microseconds more");
  parser.arg("--sleep %s:US", &texts.sleep).help("Each sample sleeps so many microseconds");
  parser.arg("--uneven", &options.trial.uneven).help("--sleep: on rank r, r times as long");
  parser.arg("--delays %s:N", &texts.delays).help("Random delays, with a seed");
  parser.arg("--failures %s:P", &texts.failures)
      .help("Tracing a portion of samples fails with this probability, but on rank 0");
}

void read_own(const Texts& texts, Options& options) {
  read_count<std::size_t>("--uniform", texts.uniform, 1, options.uniform);
  if (options.uniform > freqsynth::SampleSequence::max_size) {
    refuse("--uniform", texts.uniform,
           "at most " + std::to_string(freqsynth::SampleSequence::max_size));
  }
  read_size("--windows", texts.windows, options.columns, options.rows);
  read_positive("--busy", texts.busy, options.trial.busy_microseconds);
  read_positive("--sleep", texts.sleep, options.trial.sleep_microseconds);
  if (!texts.delays.empty()) {
    read_count<std::uint64_t>("--delays", texts.delays, 0, options.trial.delays.emplace());
  }
  read_positive("--failures", texts.failures, options.trial.failures);
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv, bool print) {
  Options options;
  Texts texts;
  embree_host::SceneOptionReader embree(options.embree);
  CommandLine line("freqsynth_mpi: renders a scene by adaptive synthesis on many machines",
                   usage_line, options);
  describe_picture(line, options, texts);
  line.add_checkpoints();
  line.parser().separator("Of the colonnade and of OBJ files:");
  line.add_frame();
  embree.describe(line.parser(), false);
  describe_trials(line.parser(), options, texts);
  if (!line.read(argc, argv)) {
    if (print) line.print_help();
    return std::nullopt;
  }
  read_own(texts, options);
  embree.read();
  if ((embree.any() || options.frame != 0) && !is_embree_scene(options)) {
    throw UsageError("--frame, --eye and the like: are for --scene colonnade and obj:FILE");
  }
  if (line.has_rate() && options.uniform != 0) throw UsageError("--uniform: has no --spp");
  line.require_output();
  if (options.uniform != 0) {
    options.samples_per_pixel = std::numeric_limits<double>::infinity();
  }
  return options;
}

std::string picture_of(const Options& options) {
  std::ostringstream words;
  words.precision(17);
  const embree_host::SceneOptions& embree = options.embree;
  words << options.scene << ' ' << options.width << 'x' << options.height << " windows "
        << options.columns << 'x' << options.rows << " spp " << options.samples_per_pixel
        << " uniform " << options.uniform << " wave " << options.wave << " seed " << options.seed
        << " frame " << options.frame << " sun " << embree.sun_size << " paths "
        << embree.light_samples;
  for (const auto& place : {embree.eye, embree.target}) {
    if (place) words << " at " << place->x << ',' << place->y << ',' << place->z;
    words << ';';
  }
  if (embree.half_field) words << " field " << *embree.half_field;
  return words.str();
}

bool is_embree_scene(const Options& options) {
  return options.scene == colonnade ||
         (options.scene.starts_with(obj_prefix) && options.scene.size() > obj_prefix.size());
}

}  // namespace farm
