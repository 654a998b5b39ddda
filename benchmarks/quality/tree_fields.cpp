// SPDX-License-Identifier: MIT
#include "quality/tree_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "field_cases/case.h"
#include "field_cases/measure.h"
#include "field_cases/members.h"
#include "field_cases/named_fields.h"
#include "quality/tree_method.h"

namespace quality {
namespace {

using field_cases::Field;
using field_cases::Picture;

/// Root mean square errors.
struct Errors {
  double tree = 0, engine = 0, jittered = 0;
};

Picture by_tree(const Field& field, double rate, std::uint64_t seed) {
  freqsynth::TreeSettings settings;
  settings.width = field.width;
  settings.height = field.height;
  settings.weights = {1};
  settings.seed = seed;
  const std::uint64_t samples = field_cases::samples_at(rate, field.width, field.height);
  std::vector<float> pixels =
      tree_picture(settings, samples, [&](double x, double y) { return field.value(x, y); }).pixels;
  return {field.width, field.height, 1, std::move(pixels), samples};
}

/// One seed of each, but of jittered samples.
Errors errors_of(const Field& field, double rate) {
  const std::vector<double> right = right_pixels(field);
  const auto sampler = field_cases::sampler_of(field);
  const field_cases::Measure error = [&](const Picture& picture) {
    return field_cases::squared_error(picture, right);
  };
  Errors errors;
  errors.tree = std::sqrt(error(by_tree(field, rate, 1)));
  errors.engine = std::sqrt(error(field_cases::synthesize(
      sampler, field_cases::settings_of(field.width, field.height), rate, 1)));
  errors.jittered =
      std::sqrt(field_cases::over_jittered(sampler, field.width, field.height, 1, rate, error));
  return errors;
}

/// The logarithmic mean of ratios, and the greatest.
struct Ratios {
  double logarithms = 0, worst = 0;
  std::size_t count = 0;

  void add(double of, double to) {
    const double ratio =
        std::max(of, field_cases::least_error) / std::max(to, field_cases::least_error);
    logarithms += std::log(ratio);
    worst = std::max(worst, ratio);
    ++count;
  }
  [[nodiscard]] double mean() const { return std::exp(logarithms / static_cast<double>(count)); }
};

void write_named(std::FILE* out) {
  const Field named[] = {field_cases::rectangle_and_line(0),
                         field_cases::rectangle_and_line(0.4),
                         field_cases::text_stems(0),
                         field_cases::checker_field("checker of 8", 64, 64, 8, 0, 0),
                         field_cases::checker_field("checker of 5.3", 64, 64, 5.3, 0.2, 1.7),
                         field_cases::fence(0.25),
                         field_cases::fence(1),
                         field_cases::ramp_and_busy_corner()};
  std::fprintf(out, "| field | at | tree | Synthesizer | jittered |\n|---|---|---|---|---|\n");
  for (const Field& field : named) {
    for (const double rate : {1.0, 4.0, 16.0}) {
      const Errors errors = errors_of(field, rate);
      std::fprintf(out, "| %s | %g | %.3g | %.3g | %.3g |\n", field.name.c_str(), rate, errors.tree,
                   errors.engine, errors.jittered);
      std::fflush(out);
    }
  }
}

struct Family {
  const char* name;
  field_cases::Family make;
};

}  // namespace

void write_tree_fields(std::uint64_t members, std::FILE* out) {
  write_named(out);
  const Family families[] = {{"rectangles", field_cases::random_rectangles},
                             {"lines", field_cases::random_lines},
                             {"text stems", field_cases::random_stems},
                             {"checkers", field_cases::random_checker},
                             {"fences", field_cases::random_fence},
                             {"functions", field_cases::random_function},
                             {"narrow images", field_cases::random_narrow},
                             {"one half dark", field_cases::random_dark_half},
                             {"lamps", [](std::uint64_t seed, std::uint64_t number) {
                                return field_cases::random_lamp(seed, number).field();
                              }}};
  std::fprintf(out,
               "\n| random fields | at | tree / Synthesizer | worst | tree / jittered | worst |\n"
               "|---|---|---|---|---|---|\n");
  for (const Family& family : families) {
    for (const double rate : {1.0, 4.0, 16.0}) {
      Ratios engine, jittered;
      for (std::uint64_t number = 1; number <= members; ++number) {
        const Errors errors = errors_of(family.make(field_cases::table_seed, number), rate);
        engine.add(errors.tree, errors.engine);
        jittered.add(errors.tree, errors.jittered);
      }
      std::fprintf(out, "| %s | %g | %.2f | %.2f | %.2f | %.2f |\n", family.name, rate,
                   engine.mean(), engine.worst, jittered.mean(), jittered.worst);
      std::fflush(out);
    }
  }
}

void write_lost_discs(std::uint64_t places, std::FILE* out) {
  constexpr double explorations[] = {0, 0.7, 0.75, 0.82};
  constexpr std::uint64_t seeds = 3;
  // Lists of positions are there as long as somebody has them.
  std::vector<std::unique_ptr<freqsynth::TreeSampler>> keepers;
  const auto settings_of = [](std::uint64_t seed) {
    freqsynth::TreeSettings settings;
    settings.width = 128;
    settings.height = 64;
    settings.weights = {1};
    settings.seed = seed;
    return settings;
  };
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    keepers.push_back(std::make_unique<freqsynth::TreeSampler>(settings_of(seed)));
  }
  std::fprintf(out, "| radius | at |");
  for (const double one : explorations) std::fprintf(out, " %g |", one);
  std::fprintf(out, " jittered |\n|---|---|---|---|---|---|---|\n");
  for (const double radius : {0.8, 1.2, 2.0}) {
    for (const double rate : {0.25, 1.0, 4.0}) {
      // The flat half is dark but for the disc.
      const auto missed = [&](auto&& sample) {
        std::uint64_t count = 0;
        for (std::uint64_t number = 1; number <= places; ++number) {
          const Field field =
              field_cases::random_disc(field_cases::table_seed, number, radius, 1).field;
          bool found = false;
          sample(number, [&](double x, double y) {
            const auto value = static_cast<float>(field.value(x, y));
            found = found || (x < 60 && value > 0);
            return value;
          });
          count += found ? 0 : 1;
        }
        std::fprintf(out, " %.1f |",
                     100 * static_cast<double>(count) / static_cast<double>(places));
        std::fflush(out);
      };
      const std::uint64_t samples = field_cases::samples_at(rate, 128, 64);
      std::fprintf(out, "| %g | %g |", radius, rate);
      for (const double one : explorations) {
        missed([&](std::uint64_t number, auto&& sampler) {
          freqsynth::TreeSettings settings = settings_of(number % seeds + 1);
          settings.exploration = one;
          freqsynth::DirectionRule rule;
          freqsynth::TreeSampler(settings, &rule).run(sampler, samples);
        });
      }
      missed([&](std::uint64_t number, auto&& sampler) {
        static_cast<void>(
            field_cases::jittered([&](double x, double y, std::uint64_t,
                                      std::span<float> values) { values[0] = sampler(x, y); },
                                  128, 64, 1, samples, number));
      });
      std::fprintf(out, "\n");
    }
  }
}

}  // namespace quality
