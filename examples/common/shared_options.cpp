// SPDX-License-Identifier: MIT
#include "shared_options.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace {

/// What holds where an option is not given, as its help says it.
std::string usually(const std::string& value) { return " (" + value + ")"; }

std::string usually(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return usually(text.data());
}

}  // namespace

CommandLine::CommandLine(const char* intro, const char* usage, SharedOptions& options)
    : options_(options) {
  parser_.intro(intro);
  parser_.usage(usage);
  parser_.add_help(false).exit_on_error(false);
  parser_.arg("--help", &help_).help("Print this help");
}

void CommandLine::add_size() {
  parser_.arg("--size %s:WxH", &size_)
      .help("Image size in pixels" +
            usually(std::to_string(options_.width) + "x" + std::to_string(options_.height)));
}

void CommandLine::add_rate() {
  parser_.arg("--spp %s:N", &spp_)
      .help("Average samples per pixel, fractions included" + usually(options_.samples_per_pixel));
}

void CommandLine::add_sampler() {
  parser_.arg("--sampler %s:NAME", &options_.sampler)
      .help("freqsynth; plainly: jittered, with random numbers, or sobol, both with a whole --spp" +
            usually(options_.sampler));
}

void CommandLine::add_output() {
  parser_.arg("-o %s:FILE", &options_.output)
      .help("The picture: EXR and PFM hold linear values, PNG and JPEG are display-encoded (sRGB)");
}

void CommandLine::add_channels() {
  parser_.arg("-o %s:FILE", &options_.output)
      .help(
          "The picture: EXR and PFM hold linear values, PNG and JPEG are display-encoded (sRGB); "
          "EXR has the other channels of surfaces as well");
}

void CommandLine::add_stats() {
  parser_.arg("--stats %s:FILE", &options_.stats).help("Figures of the run as JSON");
}

void CommandLine::add_wave() {
  parser_.arg("--wave %s:N", &wave_)
      .help("Blocks sampled between two choices; 1 = strict order (1/32 of all)");
}

void CommandLine::add_seed() {
  parser_.arg("--seed %s:N", &seed_)
      .help("Seed of the random choices" + usually(std::to_string(options_.seed)));
}

void CommandLine::add_frame() {
  parser_.arg("--frame %s:N", &frame_)
      .help("Other frames have other noise" + usually(std::to_string(options_.frame)));
}

void CommandLine::add_threads() {
  const std::string usual = options_.threads == 0 ? "all" : std::to_string(options_.threads);
  parser_.arg("--threads %s:N", &threads_).help("Threads that take samples" + usually(usual));
}

void CommandLine::add_checkpoints() {
  parser_.separator("Long runs:");
  parser_.arg("--checkpoint %s:FILE", &options_.checkpoint)
      .help("Keeps the state of the run in a file: now and then, when interrupted, and at the end");
  parser_.arg("--checkpoint-every %s:SECONDS", &checkpoint_every_)
      .help("How often" + usually(options_.checkpoint_every));
  parser_.arg("--resume %s:FILE", &options_.resume)
      .help("Goes on from such a file, with the same options; the result is the same to the bit");
}

bool CommandLine::read(int argc, const char** argv) {
  if (parser_.parse_args(argc, argv) < 0) throw UsageError(parser_.geterror());
  if (help_) return false;
  read_size("--size", size_, options_.width, options_.height);
  read_positive("--spp", spp_, options_.samples_per_pixel);
  read_sampler();
  read_count<std::size_t>("--wave", wave_, 1, options_.wave);
  read_count<std::uint64_t>("--seed", seed_, 0, options_.seed);
  read_count<std::uint64_t>("--frame", frame_, 0, options_.frame);
  read_count<std::size_t>("--threads", threads_, 1, options_.threads);
  if (options_.threads > 1024) refuse("--threads", threads_, "in 1..1024");
  read_positive("--checkpoint-every", checkpoint_every_, options_.checkpoint_every);
  if (!checkpoint_every_.empty() && options_.checkpoint.empty()) {
    throw UsageError("--checkpoint-every: needs --checkpoint");
  }
  return true;
}

void CommandLine::read_sampler() const {
  const std::string& sampler = options_.sampler;
  if (sampler == "freqsynth") return;
  if (sampler != "jittered" && sampler != "sobol") {
    refuse("--sampler", sampler, "freqsynth, jittered or sobol");
  }
  const double rate = options_.samples_per_pixel;
  if (rate != std::floor(rate) || rate > 1e6) {
    refuse("--spp", spp_, "a whole number up to 1000000, as a plain sampler needs");
  }
  if (is_long_run()) throw UsageError("--checkpoint, --resume: are for --sampler freqsynth");
}

bool CommandLine::is_long_run() const {
  return !options_.checkpoint.empty() || !options_.resume.empty();
}

void CommandLine::require_output() const {
  if (options_.output.empty()) throw UsageError("-o: no output file is named");
}
