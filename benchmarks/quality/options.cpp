// SPDX-License-Identifier: MIT
#include "options.h"

#include <OpenImageIO/argparse.h>

#include <algorithm>

#include "common/option_values.h"
#include "quality/metrics.h"

namespace {

/// The parts between commas, each once.
std::vector<std::string> split(std::string_view option, const std::string& text) {
  std::vector<std::string> parts;
  if (text.empty()) return parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    if (part.empty()) refuse(option, text, "a list such as a,b");
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  std::string scenes, methods, spp, size, seeds, reference, threads;
  bool quick = false;
  bool help = false;

  OIIO::ArgParse parser;
  parser.intro("freqsynth_quality: the error of this library and of others, on the same scenes");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  parser.arg("--help", &help).help("Print this help");
  parser.arg("--list", &options.list).help("Print the scenes and the methods");
  parser.arg("--scenes %s:A,B", &scenes).help("Scenes, also image:FILE (all)");
  parser.arg("--methods %s:A,B", &methods).help("Methods (all)");
  parser.arg("--spp %s:N,M", &spp)
      .help("Average samples per pixel, fractions included (1/16,1/8,1/4,1/2,1,2,4)");
  parser.arg("--size %s:WxH", &size).help("Size of the pictures in pixels (256x256)");
  parser.arg("--seeds %s:N", &seeds).help("Runs with different seeds that are averaged (1)");
  parser.arg("--reference %s:N", &reference)
      .help(
          "Jittered samples per pixel of the reference, even; of path-traced scenes 4 times as many"
          " (1024)");
  parser.arg("--cache %s:DIR", &options.cache).help("Keep references here");
  parser.arg("--csv %s:FILE", &options.csv).help("The results (standard output)");
  parser.arg("--pictures %s:DIR", &options.pictures)
      .help("A PNG of each reference and of the first run of each method");
  parser.arg("--threads %s:N", &threads).help("Runs at the same time (all)");
  parser.arg("--quick", &quick)
      .help("Unless said otherwise: fan and chess at 1/4, 1 and 4, 128x128, reference of 256");
  parser.arg("--noisy", &options.noisy)
      .help(
          "Unless said otherwise: all noisy scenes at 1, 4 and 16, freqsynth and denoisers; prints"
          " a table to read, and --pictures has them side by side, too");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (help) {
    parser.print_help();
    return std::nullopt;
  }

  if (quick) {
    options.width = options.height = 128;
    options.reference = 256;
    if (scenes.empty()) scenes = "fan,chess";
    if (spp.empty()) spp = "1/4,1,4";
  }
  if (options.noisy) {
    if (methods.empty()) methods = "freqsynth,freqsynth-plain,sobol-box,nlm,nfor";
    if (spp.empty()) spp = "1,4,16";
  }
  if (spp.empty()) spp = "1/16,1/8,1/4,1/2,1,2,4";
  options.scenes = split("--scenes", scenes);
  options.methods = split("--methods", methods);
  for (const std::string& part : split("--spp", spp)) {
    double rate = 0;
    read_positive("--spp", part, rate);
    if (rate > 4096) refuse("--spp", part, "at most 4096");
    if (std::find(options.rates.begin(), options.rates.end(), rate) == options.rates.end()) {
      options.rates.push_back(rate);
    }
  }
  read_size("--size", size, options.width, options.height);
  if (options.width < quality::ssim_window || options.height < quality::ssim_window) {
    refuse("--size", size, "at least 11x11, the window of SSIM");
  }
  read_count<std::size_t>("--seeds", seeds, 1, options.seeds);
  read_count<std::size_t>("--reference", reference, 2, options.reference);
  if (options.reference % 2 != 0) refuse("--reference", reference, "even");
  read_count<std::size_t>("--threads", threads, 1, options.threads);
  if (options.threads > 1024) refuse("--threads", threads, "in 1..1024");
  return options;
}
