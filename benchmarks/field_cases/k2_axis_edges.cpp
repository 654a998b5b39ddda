// SPDX-License-Identifier: MIT
#include <array>
#include <limits>

#include "case.h"
#include "members.h"
#include "named_fields.h"

namespace field_cases {
namespace {

// The finished pixels of a picture as JPEG's signal.
freqsynth::FrequencyImage image_of(const Picture& picture) {
  freqsynth::FrequencyImage image(picture.width, picture.height, 1,
                                  freqsynth::CoefficientMeaning::pixel_average);
  std::array<float, 64> block{};
  for (std::size_t by = 0; by < image.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
      for (std::size_t k = 0; k < 64; ++k) {
        block[k] = static_cast<float>(picture.at(8 * bx + k % 8, 8 * by + k / 8));
      }
      freqsynth::forward_dct(block, image.coefficients(bx, by, 0));
    }
  }
  return image;
}

double file_squared_error(const freqsynth::FrequencyImage& image, std::span<const double> right,
                          const freqsynth::QuantizationSettings& tables) {
  const std::vector<float> pixels =
      freqsynth::reconstruct(freqsynth::dequantize(freqsynth::quantize(image, tables)));
  double sum = 0;
  for (std::size_t k = 0; k < right.size(); ++k) {
    // A decoder clamps.
    const double error = std::fmin(std::fmax(double(pixels[k]), 0.0), 255.0) - 255 * right[k];
    sum += error * error;
  }
  return sum / static_cast<double>(right.size());
}

// A run that ends by itself when a JPEG file of that quality is as good as it gets. The rate is a
// cap on the samples.
Case quality_case(const std::string& key, const std::string& name, const Field& field, int quality,
                  std::vector<double> caps) {
  return {
      key, name, std::move(caps), [field, quality](double cap) {
        const Sampler sampler = [&](double x, double y, std::uint64_t, std::span<float> values) {
          values[0] = static_cast<float>(255 * display(field.value(x, y)));
        };
        freqsynth::QuantizationSettings tables;
        tables.luminance = freqsynth::scale_table(freqsynth::luminance_table(), quality);
        auto settings = settings_of(field.width, field.height);
        settings.quantization = freqsynth::quantization_target(tables, 1);
        const std::vector<double> right = right_pixels(field);
        Picture exact{field.width, field.height, 1, {}, 0};
        for (const double value : right) exact.pixels.push_back(static_cast<float>(255 * value));

        std::uint64_t samples = 0;
        const auto image = synthesize_image(sampler, settings, cap, 1, &samples);
        const double rate =
            static_cast<double>(samples) / static_cast<double>(field.width * field.height);
        Figure taken{"samples per pixel at the end", none, rate};
        Figure error{"RMSE of the file, of 255"};
        error.right = std::sqrt(file_squared_error(image_of(exact), right, tables));
        error.now = std::sqrt(file_squared_error(image, right, tables));
        error.jittered = std::sqrt(over_jittered(
            sampler, field.width, field.height, 1, rate,
            [&](const Picture& p) { return file_squared_error(image_of(p), right, tables); }, 2));
        return std::vector{taken, error};
      }};
}

}  // namespace

Kind axis_edges() {
  Kind kind{"K2",
            "Edges along the axes, and text",
            "Level and upright edges, above all those on the borders of pixels: lines, rectangles, "
            "checkers, the stems of letters. Jittered samples are exact where all edges lie on "
            "pixel borders.",
            {}};
  const std::vector<double> rates{0.25, 1, 4, 16};
  const auto checker = [](double cell, double shift) {
    return checker_field("checker", 128, 128, cell, shift, shift);
  };
  auto& cases = kind.cases;
  cases.push_back(rmse_case("V4.checker8", "checker, cells of 8 px", checker(8, 0), rates));
  cases.push_back(rmse_case("V4.checker8s", "checker, cells of 8 px, shifted by 0.01",
                            checker(8, -.01), rates));
  cases.push_back(rmse_case("V4.checker9", "checker, cells of 9 px", checker(9, 0), rates));
  for (const double shift : {0.0, 0.4}) {
    const std::string s = shift > 0 ? "s" : "";
    const std::string name =
        shift > 0 ? "rectangle and line, shifted by 0.4" : "rectangle and line";
    const Field field = rectangle_and_line(shift);
    cases.push_back(rmse_case("V5.rectangle" + s, name, field, rates));
    cases.push_back({"V5.row" + s, name, {1, 4, 16}, [field](double rate) {
                       std::vector<Figure> figures;
                       for (const std::size_t row : {19u, 20u, 21u}) {
                         const Measure measure = [row](const Picture& p) {
                           double sum = 0;
                           for (std::size_t i = 0; i < p.width; ++i) sum += p.at(i, row);
                           return sum / static_cast<double>(p.width);
                         };
                         const Sampler sampler = sampler_of(field);
                         figures.push_back(
                             {"mean of row " + std::to_string(row),
                              field.average(0, static_cast<double>(row)),
                              over_seeds(sampler, settings_of(128, 96), rate, measure),
                              over_jittered(sampler, 128, 96, 1, rate, measure)});
                       }
                       return figures;
                     }});
  }
  for (const double shift : {0.0, 0.37}) {
    const std::string s = shift > 0 ? "s" : "";
    const std::string name = shift > 0 ? "stems of text, shifted down by 0.37" : "stems of text";
    const Field field = text_stems(shift);
    cases.push_back(rmse_case("V6.stems" + s, name, field, rates));
    if (shift > 0) continue;
    cases.push_back({"V6.mean", name, {16}, [field](double rate) {
                       const Sampler sampler = sampler_of(field);
                       Figure level{"mean"};
                       level.right = 0;
                       for (const double value : right_pixels(field)) level.right += value;
                       level.right /= 128 * 128;
                       level.now = over_seeds(sampler, settings_of(128, 128), rate, mean);
                       level.jittered = over_jittered(sampler, 128, 128, 1, rate, mean);
                       return std::vector{level};
                     }});
  }
  const double no_limit = std::numeric_limits<double>::infinity();
  cases.push_back(quality_case("V7.stems90", "stems of text, until JPEG quality 90", text_stems(0),
                               90, {4, 8, 16, no_limit}));
  cases.push_back(quality_case("V7.stems75", "stems of text, until JPEG quality 75", text_stems(0),
                               75, {no_limit}));
  cases.push_back(quality_case("V7.stems50", "stems of text, until JPEG quality 50", text_stems(0),
                               50, {no_limit}));
  cases.push_back(quality_case("V7.checker75", "checker, cells of 8 px, until JPEG quality 75",
                               checker(8, 0), 75, {no_limit}));
  cases.push_back(quality_case("V7.checker75s",
                               "checker, cells of 8 px, shifted by 0.3, until JPEG quality 75",
                               checker(8, 0.3), 75, {no_limit}));
  const Field disc = plus(product_field("disc", 128, 128, 0, {}), 1, Disc{64.3, 63.1, 37});
  for (const int quality : {75, 90}) {
    const std::string q = std::to_string(quality);
    cases.push_back(quality_case("V7.disc" + q, "for comparison: a disc, until JPEG quality " + q,
                                 disc, quality, {no_limit}));
  }
  cases.push_back(members_case("K2.rectangles", "32 pictures of random rectangles",
                               random_rectangles, 32, rates));
  cases.push_back(members_case("K2.lines", "32 pictures of random lines", random_lines, 32, rates));
  cases.push_back(members_case("K2.stems", "32 random stems", random_stems, 32, rates));
  cases.push_back(members_case("K2.checkers", "32 random checkers", random_checker, 32, rates));
  return kind;
}

}  // namespace field_cases
