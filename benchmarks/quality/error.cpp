// SPDX-License-Identifier: MIT
// Measures how well the predicted error of a picture agrees with the true one, scene by scene.

#include <OpenImageIO/argparse.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/option_values.h"
#include "common/output_file.h"
#include "common/picture.h"
#include "error_functions.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/results.h"
#include "quality/scene_radiance.h"
#include "reference_cache.h"
#include "scenes/scene.h"

namespace {

constexpr std::size_t side = 256;
constexpr std::size_t reference_rate = 1024, path_traced_factor = 4;
constexpr double rates[] = {0.25, 1, 4, 16};

struct Options {
  std::vector<std::string> scenes;
  std::string cache, csv, pictures;
  std::size_t seeds = 3;
  std::size_t functions = 0;
};

struct Subject {
  std::string name;
  std::unique_ptr<scenes::Scene> scene;
  std::vector<float> reference;
  double reference_square = 0;
};

struct Outcome {
  double predicted = 0;  // mean square
  double measured = 0;   // mean square, less that of the reference
  double rank = 0;       // correlation of blocks' ranks
  double found = 0;      // share of the squares in the tenth of pixels that is said to be worst
  double findable = 0;   // and in the tenth that is
};

double log_ratio(const Outcome& outcome) {
  return 0.5 * std::log(outcome.predicted / outcome.measured);
}

/// Places in rising order of the values, those of equal ones the mean.
std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t j = i; j < end; ++j) ranks[order[j]] = static_cast<double>(i + end - 1) / 2;
    i = end;
  }
  return ranks;
}

double correlation(std::span<const double> a, std::span<const double> b) {
  const auto count = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / count;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / count;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// The share of all `squares` in the tenth of them where `by` is greatest.
double share_of_worst(std::span<const double> by, std::span<const double> squares) {
  std::vector<std::size_t> order(by.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return by[a] > by[b]; });
  double all = 0, worst = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    all += squares[order[i]];
    if (i < order.size() / 10) worst += squares[order[i]];
  }
  return all > 0 ? worst / all : 1;
}

/// Finished, predicted error, true error: errors in units of twice the true RMSE.
void write_sheet(const Options& options, const Subject& subject, double rate,
                 const std::vector<float>& picture, const std::vector<float>& predicted,
                 double rmse) {
  std::vector<Picture> sheet(3, {side, side, 3, picture});
  const auto scale = static_cast<float>(0.5 / std::max(rmse, 1e-30));
  for (std::size_t i = 0; i < picture.size(); ++i) {
    sheet[1].pixels[i] = predicted[i] * scale;
    sheet[2].pixels[i] = std::abs(picture[i] - subject.reference[i]) * scale;
  }
  write_picture(options.pictures + "/" + quality::file_name(subject.name) + "_" +
                    quality::rate_name(rate) + ".png",
                contact_sheet(sheet, 3));
}

Outcome run(const Options& options, const Subject& subject, double rate, std::uint64_t seed) {
  const std::size_t features = subject.scene->features();
  const std::size_t channels = 3 + features;
  freqsynth::SynthesisSettings settings{.width = side, .height = side, .channels = channels};
  settings.channel_settings.assign(channels, {freqsynth::ChannelRole::feature});
  std::fill_n(settings.channel_settings.begin(), 3, freqsynth::ChannelSettings{});
  settings.list.seed = seed;
  freqsynth::Synthesizer engine(settings);
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      subject.scene->radiance_and_features(requests[i].x, requests[i].y,
                                           quality::id_of(requests[i], seed),
                                           values.subspan(channels * i, channels));
    }
  };
  engine.run(sampler, {.samples_per_pixel = rate});
  const std::vector<float> finished = freqsynth::reconstruct(engine.finished_image());
  const std::vector<float> errors = engine.error_image();

  std::vector<float> picture, predicted;
  std::vector<double> squares, expected, block_squares(side * side / 64), block_expected;
  block_expected = block_squares;
  Outcome outcome;
  for (std::size_t pixel = 0; pixel < side * side; ++pixel) {
    const std::size_t block = pixel / side / 8 * (side / 8) + pixel % side / 8;
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = finished[pixel * channels + c], error = errors[pixel * channels + c];
      picture.push_back(value);
      predicted.push_back(error);
      const double off = double{value} - double{subject.reference[3 * pixel + c]};
      squares.push_back(off * off);
      expected.push_back(double{error} * double{error});
      block_squares[block] += squares.back();
      block_expected[block] += expected.back();
      outcome.measured += squares.back() / (3 * side * side);
    }
  }
  outcome.predicted = std::pow(engine.predicted_rmse(), 2);
  outcome.measured -= subject.reference_square;
  outcome.rank = correlation(ranks(block_expected), ranks(block_squares));
  outcome.found = share_of_worst(expected, squares);
  outcome.findable = share_of_worst(squares, squares);
  if (seed == 1 && !options.pictures.empty()) {
    write_sheet(options, subject, rate, picture, predicted, std::sqrt(outcome.measured));
  }
  return outcome;
}

std::vector<Subject> make_subjects(const Options& options, freqsynth::ThreadPool& pool) {
  std::vector<std::string> names = options.scenes;
  if (names.empty()) names.assign(scenes::scene_names().begin(), scenes::scene_names().end());
  std::vector<Subject> subjects;
  for (const std::string& name : names) {
    Subject subject{.name = name,
                    .scene = scenes::make_scene({.name = name, .width = side, .height = side}),
                    .reference = {}};
    const bool path_traced = name == "cornell" || name == "spheres";
    const std::size_t rate = reference_rate * (path_traced ? path_traced_factor : 1);
    const quality::Reference reference = quality::cached_reference(
        options.cache, name, quality::radiance_of(*subject.scene),
        quality::pixel_average_of(*subject.scene), {side, side, rate, 0}, pool, [](double) {});
    subject.reference = reference.pixels();
    subject.reference_square = std::pow(reference.standard_error(), 2);
    subjects.push_back(std::move(subject));
  }
  return subjects;
}

void measure_all(const Options& options) {
  freqsynth::ThreadPool pool;
  const std::vector<Subject> subjects = make_subjects(options, pool);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const std::size_t runs = std::size(rates) * options.seeds;
  std::vector<Outcome> outcomes(subjects.size() * runs);
  const auto one = [&](std::size_t task) {
    const std::size_t of_subject = task % runs;
    outcomes[task] = run(options, subjects[task / runs], rates[of_subject / options.seeds],
                         of_subject % options.seeds + 1);
  };
  pool.execute(outcomes.size(), freqsynth::TaskRef(one));

  std::string csv = "scene,rate,predicted,measured,ratio,least,greatest,rank,found,findable\n";
  std::printf(
      "| scene | samples | true RMSE | predicted | ratio | of single runs | blocks' ranks | worst "
      "tenth |\n|---|---|---|---|---|---|---|---|\n");
  for (std::size_t s = 0; s < subjects.size(); ++s) {
    for (std::size_t r = 0; r < std::size(rates); ++r) {
      Outcome all;
      double least = std::numeric_limits<double>::infinity(), most = 0;
      const auto count = static_cast<double>(options.seeds);
      for (std::size_t seed = 0; seed < options.seeds; ++seed) {
        const Outcome& each = outcomes[s * runs + r * options.seeds + seed];
        all.predicted += each.predicted / count;
        all.measured += each.measured / count;
        all.rank += each.rank / count;
        all.found += each.found / count;
        all.findable += each.findable / count;
        least = std::min(least, std::exp(log_ratio(each)));
        most = std::max(most, std::exp(log_ratio(each)));
      }
      const double ratio = std::exp(log_ratio(all));
      const char* name = subjects[s].name.c_str();
      std::printf("| %s | %s | %.3g | %.3g | %.2f | %.2f .. %.2f | %.2f | %.2f of %.2f |\n", name,
                  rates[r] < 1 ? "1/4" : quality::rate_name(rates[r]).c_str(),
                  std::sqrt(all.measured), std::sqrt(all.predicted), ratio, least, most, all.rank,
                  all.found, all.findable);
      char line[256];
      std::snprintf(line, sizeof line, "%s,%g,%.6g,%.6g,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", name,
                    rates[r], std::sqrt(all.predicted), std::sqrt(all.measured), ratio, least, most,
                    all.rank, all.found, all.findable);
      csv += line;
    }
  }
  if (!options.csv.empty()) write_text(options.csv, csv);
}

Options parse(int argc, const char** argv) {
  Options options;
  std::string seeds, functions;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_error: predicted and true errors of the scenes, as Markdown");
  parser.exit_on_error(false);
  parser.arg("--cache %s:DIR", &options.cache).help("Keep references here");
  parser.arg("--csv %s:FILE", &options.csv).help("The same as comma-separated values");
  parser.arg("--pictures %s:DIR", &options.pictures)
      .help("Of each scene and rate: the picture, its predicted and its true error");
  parser.arg("--seeds %s:N", &seeds).help("Runs with different seeds (3)");
  parser.arg("--functions %s:N", &functions).help("So many random functions in place of scenes");
  parser.arg("filename").hidden().action([&](OIIO::cspan<const char*> words) {
    options.scenes.emplace_back(words[0]);
  });
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  read_count<std::size_t>("--seeds", seeds, 1, options.seeds);
  read_count<std::size_t>("--functions", functions, 1, options.functions);
  return options;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const Options options = parse(argc, argv);
    if (options.functions > 0) {
      freqsynth::ThreadPool pool;
      std::fputs(quality::random_functions_table(options.functions, pool).c_str(), stdout);
    } else {
      measure_all(options);
    }
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_error: %s\n", error.what());
    return 1;
  }
}
