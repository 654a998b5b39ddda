// SPDX-License-Identifier: MIT
#include "options.h"

#include <OpenImageIO/argparse.h>

#include "common/option_values.h"
#include "scenes/scene.h"
#include "subject.h"

namespace live {
namespace {

/// The values of options as they were given; empty: not given.
struct Texts {
  std::string size, spp, threads, port, measure;
  bool help = false;
};

void describe(OIIO::ArgParse& parser, Options& options, Texts& texts) {
  parser.arg("--help", &texts.help).help("Print this help");
  parser.arg("--scene %s:NAME", &options.scene)
      .help(scenes::scene_list() + ", " + embree_name + " (chess)");
  parser.arg("--size %s:WxH", &texts.size).help("Image size in pixels (512x512)");
  parser.arg("--spp %s:N", &texts.spp)
      .help("Samples per pixel at which sampling ends; the picture stays (none: Ctrl-C)");
  parser.arg("--threads %s:N", &texts.threads).help("Threads that sample (all)");
  parser.arg("-o %s:STEM", &options.stem)
      .help("Name of the files that are stored: STEM.jpg, STEM.exr, STEM.state (live)");
  parser.arg("--resume %s:FILE", &options.resume)
      .help("Goes on from a STEM.state, with the same scene and size");
  parser.separator("Who is served:");
  parser.arg("--port %s:N", &texts.port).help("Port; 0 takes a free one (8000)");
  parser.arg("--host %s:ADDRESS", &options.host)
      .help("Address to listen on; 0.0.0.0: all of this machine, for all who reach it (127.0.0.1)");
  parser.arg("--name %s:NAME", &options.name)
      .help("A name or address that browsers call it by, with --host");
  parser.separator("Figures:");
  parser.arg("--measure %s:RUNS", &texts.measure)
      .help(
          "Serves a client of its own, and prints time to the first picture, revisions a second "
          "and what it costs; needs --spp");
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  Texts texts;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_live: a picture that grows in the browser");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  describe(parser, options, texts);
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (texts.help) {
    parser.print_help();
    return std::nullopt;
  }
  read_size("--size", texts.size, options.width, options.height);
  read_positive("--spp", texts.spp, options.samples_per_pixel);
  read_count<std::size_t>("--threads", texts.threads, 1, options.threads);
  if (options.threads > 1024) refuse("--threads", texts.threads, "in 1..1024");
  read_count<unsigned>("--port", texts.port, 0, options.port);
  if (options.port > 65535) refuse("--port", texts.port, "in 0..65535");
  read_count<std::size_t>("--measure", texts.measure, 1, options.measure);
  if (options.measure > 0 && texts.spp.empty()) throw UsageError("--measure: needs --spp");
  if (options.stem.empty()) throw UsageError("-o: is empty");
  return options;
}

}  // namespace live
