// SPDX-License-Identifier: MIT
#include "options.h"

#include <cstddef>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "common/sampling.h"

namespace {

/// A quality of JPEG.
void read_quality(std::string_view option, const std::string& text, std::optional<int>& quality) {
  if (text.empty()) return;
  int number = 0;
  if (!read_all(text, number) || number < 1 || number > 100) {
    refuse(option, text, "a whole number in 1..100");
  }
  quality = number;
}

/// One of some names, for the values 0, 1 and so on.
template <class Choice, std::size_t Count>
void read_name(std::string_view option, const std::string& text,
               const std::string_view (&names)[Count], Choice& choice) {
  if (text.empty()) return;
  std::string wanted;
  for (std::size_t i = 0; i < Count; ++i) {
    if (text == names[i]) {
      choice = static_cast<Choice>(i);
      return;
    }
    wanted.append(i == 0 ? "" : i + 1 < Count ? ", " : " or ").append(names[i]);
  }
  refuse(option, text, wanted);
}

/// The values of options as they were given; empty: not given.
struct Texts {
  std::string reference, terms_every, cutoff, order, pixel_filter;
  std::string scale, channels, zone_frequency, average, steer, refiner;
  std::string quality, until_quality, subsampling, tolerance;
  bool no_butterworth = false;
};

void describe_outputs(CommandLine& line, Options& options, Texts& texts) {
  OIIO::ArgParse& parser = line.parser();
  describe_scene(parser, options.scene);
  line.add_size();
  line.add_rate();
  line.add_output();
  parser.arg("--density %s:FILE", &options.density)
      .help("Picture of the samples per block: black none, white the most");
  parser.arg("--error %s:FILE", &options.error)
      .help("Picture of the error that each pixel is expected to have");
  parser.arg("--frames %s:DIR", &options.frames)
      .help("Pictures at 1/64, 1/32 .. 2 samples per pixel of one run, and a contact sheet");
  line.add_stats();
  parser.arg("--reference %s:N", &texts.reference)
      .help("Instead: N jittered samples per pixel, averaged over each pixel");
}

void describe_method(CommandLine& line, Options& options, Texts& texts) {
  OIIO::ArgParse& parser = line.parser();
  line.add_wave();
  line.add_seed();
  line.add_threads();
  parser.arg("--terms-every %s:N", &texts.terms_every).help("Samples per added cosine term (2.5)");
  parser.arg("--cutoff %s:C", &texts.cutoff).help("Butterworth cutoff C sqrt(n) (0.8)");
  parser.arg("--order %s:M", &texts.order).help("Butterworth order (2)");
  parser.arg("--no-butterworth", &texts.no_butterworth).help("Do not filter");
  parser.arg("--pixel-filter %s:NAME", &texts.pixel_filter)
      .help(
          "none: the fit at the pixels' centres; box: averages over the pixels; tent, gaussian, "
          "blackman_harris, mitchell: as renderers have them (box)");
  parser.arg("--no-residuals", &options.no_residuals)
      .help("The paper's estimate: the fit alone, without what it leaves over");
  parser.arg("--scale %s:S", &texts.scale).help("Size of the output relative to --size (1)");
  parser.arg("--channels %s:NAME", &texts.channels).help("rgb or gray (rgb)");
  parser.arg("--zone-frequency %s:F", &texts.zone_frequency)
      .help("zoneplate: cycles per pixel at the corner");
  parser.arg("--average %s:NAME", &texts.average)
      .help("light: radiance; display: encoded values (light, with --direct display)");
  parser.arg("--steer %s:NAME", &texts.steer)
      .help(
          "What errors decide where samples are taken: linear, relative to the brightness, or "
          "display: as seen in sRGB (linear)");
  parser.arg("--refiner %s:NAME", &texts.refiner)
      .help(
          "What makes samples an image: least_squares, block by block, or kriging: a tree of nodes "
          "and a bank of priors (least_squares)");
}

void describe_jpeg(OIIO::ArgParse& parser, Options& options, Texts& texts) {
  parser.separator("JPEG files:");
  parser.arg("--quality %s:Q", &texts.quality)
      .help("1..100, as libjpeg counts (95; with --direct 75)");
  parser.arg("--subsampling %s:NAME", &texts.subsampling).help("444, or 420: chroma halved (444)");
  parser.arg("--direct", &options.direct)
      .help("Quantise the fitted coefficients: no pixel is ever made, unless --average light");
  parser.arg("--progressive", &options.progressive).help("With --direct: coarse to fine");
  parser.arg("--until-quality %s:Q", &texts.until_quality)
      .help(
          "--direct --quality Q that samples until the quantiser would hardly notice; --spp is a "
          "limit then");
  parser.arg("--tolerance %s:T", &texts.tolerance)
      .help("With --until-quality: error of sampling relative to the quantiser's own (0.25)");
}

void read_method(const Texts& texts, Options& options) {
  read_count<std::size_t>("--reference", texts.reference, 1, options.reference);
  read_positive("--terms-every", texts.terms_every, options.terms_every);
  if (options.terms_every < 1) refuse("--terms-every", texts.terms_every, "at least 1");
  read_positive("--cutoff", texts.cutoff, options.butterworth.cutoff);
  read_positive("--order", texts.order, options.butterworth.order);
  options.butterworth.enabled = !texts.no_butterworth;
  read_positive("--scale", texts.scale, options.scale);
  if (!texts.zone_frequency.empty()) {
    read_positive("--zone-frequency", texts.zone_frequency, options.zone_frequency.emplace());
  }
  read_name("--pixel-filter", texts.pixel_filter,
            {"none", "box", "tent", "gaussian", "blackman_harris", "mitchell"},
            options.pixel_filter);
  read_name("--channels", texts.channels, {"rgb", "gray"}, options.gray);
  read_name("--steer", texts.steer, {"linear", "relative", "display"}, options.steer);
  read_name("--refiner", texts.refiner, {"least_squares", "kriging"}, options.refiner);
}

/// What depends on whether coefficients become a JPEG file.
void read_jpeg(const CommandLine& line, const Texts& texts, Options& options) {
  read_quality("--until-quality", texts.until_quality, options.until_quality);
  options.direct = options.direct || options.until_quality;
  std::optional<int> file_quality = options.until_quality;
  read_quality("--quality", texts.quality, file_quality);
  options.quality = file_quality.value_or(options.direct ? 75 : 95);
  read_positive("--tolerance", texts.tolerance, options.tolerance);
  if (options.until_quality && !line.has_rate()) {
    options.samples_per_pixel = std::numeric_limits<double>::infinity();
  }
  if (options.direct) options.averaging = Averaging::display;
  read_name("--average", texts.average, {"light", "display"}, options.averaging);
  read_name("--subsampling", texts.subsampling, {"444", "420"}, options.subsampling);
}

/// Options that do not go together.
void check_combinations(const CommandLine& line, const Texts& texts, const Options& options) {
  const auto refuse_if = [](bool wrong, const char* why) {
    if (wrong) throw UsageError(why);
  };
  const bool has_frames = !options.frames.empty();
  refuse_if(options.until_quality && options.averaging == Averaging::light,
            "--until-quality: has no --average light");
  refuse_if(options.steer != freqsynth::Steer::linear && options.averaging == Averaging::display,
            "--steer: is for linear values, has no --average display");
  refuse_if(options.direct && (options.output.empty() || options.scale != 1 ||
                               options.reference != 0 || has_frames),
            "--direct: needs -o and has no --frames, --scale and --reference");
  refuse_if(options.direct && options.pixel_filter != freqsynth::PixelFilter::box,
            "--direct: averages over pixels, has no other --pixel-filter");
  refuse_if(options.refiner == freqsynth::RefinerKind::kriging &&
                (options.until_quality || !texts.terms_every.empty()),
            "--refiner kriging: has no --until-quality and no --terms-every");
  refuse_if(options.progressive && !options.direct, "--progressive: needs --direct");
  refuse_if(!texts.tolerance.empty() && !options.until_quality,
            "--tolerance: needs --until-quality");
  if (!has_frames) line.require_output();
  refuse_if(
      options.reference != 0 && (has_frames || !options.density.empty() || !options.error.empty()),
      "--reference: has no --frames, no --density and no --error");
  refuse_if(options.reference != 0 && options.scale != 1, "--reference: has no --scale");
  refuse_if(line.is_long_run() && (options.reference != 0 || has_frames),
            "--checkpoint, --resume: have no --frames and no --reference");
}

}  // namespace

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  Texts texts;
  CommandLine line(
      "freqsynth_render: renders a scene by adaptive synthesis in the frequency domain", usage_line,
      options);
  describe_outputs(line, options, texts);
  describe_method(line, options, texts);
  line.add_checkpoints();
  describe_jpeg(line.parser(), options, texts);
  if (!line.read(argc, argv)) {
    line.print_help();
    std::puts(
        "\nFiles are written whole or not at all. SIGINT (Ctrl-C) and SIGTERM end the run early: "
        "what "
        "there is\nis written, and the exit code is 130 or 143; a second one ends at once. Exit "
        "code "
        "1: it failed;\n2: wrong options.");
    if (std::fflush(stdout) != 0) throw std::runtime_error("standard output: cannot be written");
    return std::nullopt;
  }
  read_method(texts, options);
  read_jpeg(line, texts, options);
  check_combinations(line, texts, options);
  return options;
}
