// SPDX-License-Identifier: MIT
// Makes the paper's figures 2, 3 and 4 from any picture, and the picture at three JPEG qualities.

#include <OpenImageIO/argparse.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "coefficients.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/jpeg/dequantization.h"
#include "freqsynth/jpeg/quantization.h"
#include "mountain.h"

namespace {

struct Options {
  std::string picture;
  std::string folder;
  bool pixels = false;
  int gain = 4;
  int bits = 4;
  std::uint64_t seed = 3;
};

/// The command line is wrong.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

constexpr const char* usage_line = "dct_figures PICTURE -o DIR [options]";

template <class Number>
void read_count(const std::string& option, const std::string& text, Number least, Number most,
                Number& number) {
  if (text.empty()) return;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number < least || number > most) {
    throw UsageError(std::string(option)
                         .append(" ")
                         .append(text)
                         .append(": not a whole number in ")
                         .append(std::to_string(least))
                         .append("..")
                         .append(std::to_string(most)));
  }
}

/// Empty when --help was asked for and printed.
std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  std::vector<std::string> pictures;
  std::string gain, bits, seed;
  bool help = false;

  OIIO::ArgParse parser;
  parser.intro("dct_figures: what the terms of the cosine transform hold of a picture");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  parser.arg("PICTURE").hidden().action(
      [&](OIIO::cspan<const char*> words) { pictures.emplace_back(words[0]); });
  parser.arg("--help", &help).help("Print this help");
  parser.arg("-o %s:DIR", &options.folder).help("Folder for the figures");
  parser.arg("--pixels", &options.pixels)
      .help("Transform the pixels also of a JPEG file instead of taking its own coefficients");
  parser.arg("--gain %s:N", &gain)
      .help("Figure 3: all but the constant term are shown N times as bright (4)");
  parser.arg("--bits %s:N", &bits).help("Figure 4: bits per channel of the lower row, 1..8 (4)");
  parser.arg("--seed %s:N", &seed).help("Figure 4: seed of the mountainsides (3)");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (help) {
    parser.print_help();
    return std::nullopt;
  }

  read_count("--gain", gain, 1, 1000, options.gain);
  read_count("--bits", bits, 1, 8, options.bits);
  read_count<std::uint64_t>("--seed", seed, 0, UINT64_MAX, options.seed);
  if (pictures.empty()) throw UsageError("PICTURE: no picture is named");
  if (pictures.size() > 1) throw UsageError(pictures[1] + ": a second picture");
  if (options.folder.empty()) throw UsageError("-o: no folder is named");
  options.picture = pictures[0];
  return options;
}

constexpr std::array<std::size_t, 8> numbers_of_terms{64, 36, 21, 15, 10, 6, 3, 1};

std::string terms_name(const std::string& folder, std::size_t terms) {
  return folder + (terms < 10 ? "/figure_2_terms_0" : "/figure_2_terms_") + std::to_string(terms) +
         ".png";
}

/// Makes the folder, and sees that all figures can be written there.
void prepare_folder(const std::string& folder) {
  make_folder(folder);
  for (const std::size_t terms : numbers_of_terms) check_writable(terms_name(folder, terms));
  for (const char* const name : {"/figure_2", "/figure_3", "/figure_4", "/qualities"}) {
    check_writable(folder + name + ".png");
  }
}

/// Figure 2: the first terms in zig-zag order only.
void show_terms(freqsynth::FrequencyImage image, const std::string& folder) {
  std::vector<Picture> pictures;
  for (const std::size_t terms : numbers_of_terms) {
    for (std::size_t block = 0; block < image.blocks_x() * image.blocks_y(); ++block) {
      for (std::size_t channel = 0; channel < image.channels(); ++channel) {
        std::ranges::fill(
            image.coefficients(block % image.blocks_x(), block / image.blocks_x(), channel)
                .subspan(terms),
            0.0f);
      }
    }
    pictures.insert(pictures.begin(), picture_of(image));
    write_picture(terms_name(folder, terms), pictures.front());
  }
  write_picture(folder + "/figure_2.png", contact_sheet(pictures, 4));
}

/// Figure 3: magnitudes of 4 x 4 terms of the luma, a pixel per block. |F| / 8 of the constant term
/// is the block's mean; the others are shown `gain` times as bright.
void show_magnitudes(const freqsynth::FrequencyImage& image, int gain, const std::string& folder) {
  std::vector<Picture> pictures;
  for (std::size_t i = 0; i < 16; ++i) {
    const std::size_t term = freqsynth::term_of_frequency(i % 4, i / 4);
    const float scale = static_cast<float>(term == 0 ? 1 : gain) / 8;
    Picture picture{image.blocks_x(), image.blocks_y(), 1, {}};
    for (std::size_t y = 0; y < image.blocks_y(); ++y) {
      for (std::size_t x = 0; x < image.blocks_x(); ++x) {
        picture.pixels.push_back(scale * std::fabs(image.coefficients(x, y, 0)[term]));
      }
    }
    pictures.push_back(linear_picture(std::move(picture)));
  }
  write_picture(folder + "/figure_3.png", contact_sheet(pictures, 4));
}

/// Figure 4: a smooth and a rough mountainside, and both with few levels per channel.
void show_masking(int bits, std::uint64_t seed, const std::string& folder) {
  std::vector<Picture> pictures{mountainside({.octaves = 2, .gain = 0.3, .seed = seed}, 384, 288),
                                mountainside({.octaves = 8, .gain = 0.52, .seed = seed}, 384, 288)};
  const float step = 255 / static_cast<float>((1 << bits) - 1);
  for (std::size_t i = 0; i < 2; ++i) {
    Picture coarse = pictures[i];
    for (float& value : coarse.pixels) value = step * std::round(value / step);
    pictures.push_back(std::move(coarse));
  }
  for (Picture& picture : pictures) picture = linear_picture(std::move(picture));
  write_picture(folder + "/figure_4.png", contact_sheet(pictures, 2));
}

/// The picture as JPEG files of three qualities hold it.
void show_qualities(const freqsynth::FrequencyImage& image, const std::string& folder) {
  std::vector<Picture> pictures;
  for (const int quality : {10, 50, 90}) {
    freqsynth::QuantizationSettings settings;
    settings.luminance = freqsynth::scale_table(freqsynth::luminance_table(), quality);
    settings.chrominance = freqsynth::scale_table(freqsynth::chrominance_table(), quality);
    pictures.push_back(picture_of(freqsynth::dequantize(freqsynth::quantize(image, settings))));
  }
  write_picture(folder + "/qualities.png", contact_sheet(pictures, 3));
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    const auto [image, from_file] = read_coefficients(options->picture, options->pixels);
    prepare_folder(options->folder);
    show_terms(image, options->folder);
    show_magnitudes(image, options->gain, options->folder);
    show_masking(options->bits, options->seed, options->folder);
    show_qualities(image, options->folder);
    std::printf(
        "%s: %zu x %zu pixels, %s\n"
        "figure_2.png: 1, 3, 6, 10 and 15, 21, 36, 64 terms\n"
        "figure_3.png: |F(u,v)| of the luma, u, v = 0..3: |F| / 8, and %d |F| / 8 but for F(0,0)\n"
        "figure_4.png: smooth and rough; below, %d bits per channel\n"
        "qualities.png: JPEG qualities 10, 50, 90\n",
        options->picture.c_str(), image.width(), image.height(),
        from_file ? "the file's own coefficients" : "coefficients of its pixels", options->gain,
        options->bits);
    if (std::fflush(stdout) != 0) throw std::runtime_error("standard output: cannot be written");
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "dct_figures: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dct_figures: %s\n", error.what());
    return 1;
  }
}
