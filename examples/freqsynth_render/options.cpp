#include "options.h"

#include <OpenImageIO/argparse.h>

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  std::string size, spp, reference, wave, seed, threads, terms_every, cutoff, order, pixel_filter;
  std::string scale, channels, zone_frequency;
  bool no_butterworth = false;
  bool help = false;

  OIIO::ArgParse parser;
  parser.intro("freqsynth_render: renders a scene by adaptive synthesis in the frequency domain");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  parser.arg("--help", &help).help("Print this help");
  parser.arg("--scene %s:NAME", &options.scene)
      .help("fan, chess, zoneplate, or image:FILE (chess)");
  parser.arg("--size %s:WxH", &size).help("Image size in pixels (512x512)");
  parser.arg("--spp %s:N", &spp).help("Average samples per pixel, fractions included (1)");
  parser.arg("-o %s:FILE", &options.output)
      .help("The picture: EXR and PFM hold linear values, PNG and JPEG are display-encoded (sRGB)");
  parser.arg("--density %s:FILE", &options.density)
      .help("Picture of the samples per block: black none, white the most");
  parser.arg("--frames %s:DIR", &options.frames)
      .help("Pictures at 1/64, 1/32 .. 2 samples per pixel of one run, and a contact sheet");
  parser.arg("--stats %s:FILE", &options.stats).help("Figures of the run as JSON");
  parser.arg("--reference %s:N", &reference)
      .help("Instead: N jittered samples per pixel, averaged over each pixel");
  parser.arg("--wave %s:N", &wave).help("Blocks sampled between two choices; 1 = strict order");
  parser.arg("--seed %s:N", &seed).help("Seed of the random choices (0)");
  parser.arg("--threads %s:N", &threads).help("Threads that call the scene (all)");
  parser.arg("--terms-every %s:N", &terms_every).help("Samples per added cosine term (2.5)");
  parser.arg("--cutoff %s:C", &cutoff).help("Butterworth cutoff C sqrt(n) (0.8)");
  parser.arg("--order %s:M", &order).help("Butterworth order (2)");
  parser.arg("--no-butterworth", &no_butterworth).help("Do not filter");
  parser.arg("--pixel-filter %s:NAME", &pixel_filter)
      .help("none: the fit at the pixels' centres; box: averages over the pixels (box)");
  parser.arg("--no-residuals", &options.no_residuals)
      .help("The paper's estimate: the fit alone, without what it leaves over");
  parser.arg("--scale %s:S", &scale).help("Size of the output relative to --size (1)");
  parser.arg("--channels %s:NAME", &channels).help("rgb or gray (rgb)");
  parser.arg("--zone-frequency %s:F", &zone_frequency)
      .help("zoneplate: cycles per pixel at the corner");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (help) {
    parser.print_help();
    return std::nullopt;
  }

  read_size("--size", size, options.width, options.height);
  read_positive("--spp", spp, options.samples_per_pixel);
  read_count<std::size_t>("--reference", reference, 1, options.reference);
  read_count<std::size_t>("--wave", wave, 1, options.wave);
  read_count<std::uint64_t>("--seed", seed, 0, options.seed);
  read_count<std::size_t>("--threads", threads, 1, options.threads);
  read_positive("--terms-every", terms_every, options.terms_every);
  read_positive("--cutoff", cutoff, options.butterworth.cutoff);
  read_positive("--order", order, options.butterworth.order);
  read_positive("--scale", scale, options.scale);
  options.butterworth.enabled = !no_butterworth;
  if (!pixel_filter.empty()) {
    if (pixel_filter != "none" && pixel_filter != "box") {
      refuse("--pixel-filter", pixel_filter, "none or box");
    }
    options.pixel_filter =
        pixel_filter == "box" ? freqsynth::PixelFilter::box : freqsynth::PixelFilter::none;
  }
  if (!channels.empty()) {
    if (channels != "rgb" && channels != "gray") refuse("--channels", channels, "rgb or gray");
    options.gray = channels == "gray";
  }
  if (!zone_frequency.empty()) {
    read_positive("--zone-frequency", zone_frequency, options.zone_frequency.emplace());
  }
  if (options.terms_every < 1) refuse("--terms-every", terms_every, "at least 1");
  if (options.threads > 1024) refuse("--threads", threads, "in 1..1024");
  if (options.output.empty() && options.frames.empty()) {
    throw UsageError("-o: no output file is named");
  }
  if (options.reference != 0 && !(options.frames.empty() && options.density.empty())) {
    throw UsageError("--reference: has no --frames and no --density");
  }
  if (options.reference != 0 && options.scale != 1) {
    throw UsageError("--reference: has no --scale");
  }
  return options;
}
