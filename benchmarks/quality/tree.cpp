// SPDX-License-Identifier: MIT
// Pictures by a tree of nodes and a bank of priors, beside Synthesizer and Whitted's subdivision at
// equal samples:
//   freqsynth_tree [--rates 0.25,1,4,16] [--size 128] [--seeds 1] [--reference 256]
//                  [--folder out/references] [--documents docs] [--photographs FOLDER]
//                  [--exploration 0] [--fields MEMBERS | --discs PLACES]
//                  [choosing | reporting | SCENE ...]
// Prints Markdown tables. Errors are those of linear values against averages of so many jittered
// samples per pixel, or exact ones, which are kept in a folder, if there is one. Five scenes and
// five pictures are for choosing members, rules and parameters; five and five others, which
// nothing may be chosen on, are reported (quality/tree_subjects.cpp). --fields: the field cases
// instead;
// --discs: how many small discs in flat parts are missed, by TreeSettings::exploration.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/reference_cache.h"
#include "quality/scene_radiance.h"
#include "quality/tree_fields.h"
#include "quality/tree_method.h"
#include "quality/tree_subjects.h"

namespace {

struct Options {
  std::vector<double> rates = {0.25, 1, 4, 16};
  std::uint64_t seeds = 1;
  int size = 128;
  std::size_t reference = 256;  // samples per pixel
  std::string folder;           // of references
  quality::SubjectFolders folders;
  std::uint64_t fields = 0;
  std::uint64_t discs = 0;
  double exploration = freqsynth::TreeSettings().exploration;
  std::vector<std::string> names;
};

Options options_of(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (name.rfind("--", 0) != 0) {
      options.names.push_back(name);
      continue;
    }
    if (++i == count) throw std::invalid_argument(name + " needs a value");
    const std::string value = arguments[i];
    if (name == "--rates") {
      options.rates.clear();
      std::istringstream list(value);
      for (std::string rate; std::getline(list, rate, ',');) {
        options.rates.push_back(std::stod(rate));
      }
    } else if (name == "--seeds") {
      options.seeds = std::stoull(value);
    } else if (name == "--reference") {
      options.reference = std::stoull(value);
    } else if (name == "--folder") {
      options.folder = value;
    } else if (name == "--documents") {
      options.folders.documents = value;
    } else if (name == "--photographs") {
      options.folders.photographs = value;
    } else if (name == "--fields") {
      options.fields = std::stoull(value);
    } else if (name == "--discs") {
      options.discs = std::stoull(value);
    } else if (name == "--exploration") {
      options.exploration = std::stod(value);
    } else if (name == "--size") {
      options.size = std::stoi(value);
    } else {
      throw std::invalid_argument("no option " + name);
    }
  }
  if (options.names.empty()) options.names = {"choosing", "reporting"};
  return options;
}

/// `predicted` receives the error that is expected.
baselines::Rendering by_tree(const baselines::Radiance& radiance, const baselines::Job& job,
                             double exploration, double& predicted) {
  freqsynth::TreeSettings settings;
  settings.exploration = exploration;
  settings.width = job.width;
  settings.height = job.height;
  settings.seed = job.seed;
  settings.noisy = job.noisy;
  baselines::Rendering result{job.width, job.height, {}, {}};
  result.samples.resize(job.width * job.height);
  quality::TreePicture picture = quality::tree_picture(
      settings, job.samples,
      [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          const freqsynth::Request& request = requests[i];
          radiance(request.x, request.y, quality::id_of(request, job.seed),
                   values.subspan(3 * i).first<3>());
          ++result.samples[request.pixel];
        }
      });
  predicted = picture.predicted;
  result.pixels = std::move(picture.pixels);
  for (float& pixel : result.pixels) pixel = pixel > 0 ? pixel : 0;
  return result;
}

/// What is measured of a method, over all seeds.
struct Measured {
  double rmse = 0, seam = 0, predicted = 0;
};

class Measuring {
 public:
  explicit Measuring(const Options& options)
      : options_(options),
        size_(static_cast<std::size_t>(options.size)),
        methods_{quality::find_method("freqsynth"),
                 {"tree", "", "",
                  [this](const baselines::Radiance& radiance, const baselines::Job& job) {
                    return by_tree(radiance, job, options_.exploration, predicted_);
                  }},
                 quality::find_method("whitted")} {}

  /// A table with a row for each scene and rate, and the geometric means.
  void write_table(const std::vector<std::string>& names) {
    std::printf(
        "| scene | at | Synthesizer | tree | tree / Synthesizer | tree / Whitted | predicted / "
        "true | seam: "
        "Synthesizer | tree | reference off by |\n|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<double> engine(options_.rates.size()), whitted(options_.rates.size());
    std::size_t count = 0;
    for (const std::string& name : names) {
      const auto scene = quality::make_subject(name, options_.size, options_.folders);
      if (scene == nullptr) {
        std::fprintf(stderr, "%s is left out: its file is not there\n", name.c_str());
        continue;
      }
      ++count;
      const quality::Reference reference = quality::cached_reference(
          options_.folder, name, quality::radiance_of(*scene), quality::pixel_average_of(*scene),
          {size_, size_, options_.reference, 1}, pool_, [](double) {});
      const std::vector<float> pixels = reference.pixels();
      for (std::size_t r = 0; r < options_.rates.size(); ++r) {
        std::vector<Measured> found;
        for (const quality::Method& method : methods_) {
          found.push_back(measure(method, *scene, options_.rates[r], pixels));
        }
        std::printf("| %s | %g | %.3g | %.3g | %.3f | %.3f | %.2f | %.2f | %.2f | %.1g |\n",
                    name.c_str(), options_.rates[r], found[0].rmse, found[1].rmse,
                    found[1].rmse / found[0].rmse, found[1].rmse / found[2].rmse,
                    found[1].predicted / found[1].rmse, found[0].seam, found[1].seam,
                    reference.standard_error());
        std::fflush(stdout);
        engine[r] += std::log(found[1].rmse / found[0].rmse);
        whitted[r] += std::log(found[1].rmse / found[2].rmse);
      }
    }
    for (std::size_t r = 0; r < options_.rates.size() && count > 1; ++r) {
      const auto mean = [&](double sum) { return std::exp(sum / static_cast<double>(count)); };
      std::printf("| *geometric mean* | %g | | | %.3f | %.3f | | | | |\n", options_.rates[r],
                  mean(engine[r]), mean(whitted[r]));
    }
    std::printf("\n");
  }

 private:
  Measured measure(const quality::Method& method, const scenes::Scene& scene, double rate,
                   const std::vector<float>& right) {
    const quality::PictureView reference{size_, size_, right};
    const auto share = 1 / static_cast<double>(options_.seeds);
    double squares = 0;
    Measured result;
    for (std::uint64_t seed = 1; seed <= options_.seeds; ++seed) {
      const baselines::Job job =
          quality::job_of(scene, size_, size_, quality::samples_of(rate, size_, size_), seed);
      const quality::Run run = quality::run_method(method, quality::radiance_of(scene), job);
      const quality::PictureView picture{size_, size_, run.pixels};
      const double rmse = quality::rmse(picture, reference);
      squares += share * rmse * rmse;
      result.predicted += share * predicted_ * predicted_;
      result.seam += share * quality::seam_visibility(picture, reference);
    }
    result.rmse = std::sqrt(squares);
    result.predicted = std::sqrt(result.predicted);
    return result;
  }

  const Options& options_;
  std::size_t size_;
  std::vector<quality::Method> methods_;
  freqsynth::ThreadPool pool_{1};
  double predicted_ = 0;  // of the last picture by the tree
};

void write_tables(const Options& options) {
  Measuring measuring(options);
  std::vector<std::string> others;
  for (const std::string& name : options.names) {
    if (name != "choosing" && name != "reporting") {
      others.push_back(name);
      continue;
    }
    std::vector<std::string> names;
    for (const quality::TreeSubject& subject : quality::tree_subjects()) {
      if (subject.choosing == (name == "choosing")) names.emplace_back(subject.name);
    }
    std::printf("For %s, %d x %d pixels:\n\n", name.c_str(), options.size, options.size);
    measuring.write_table(names);
  }
  if (!others.empty()) measuring.write_table(others);
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const Options options = options_of(count, arguments);
    if (options.discs > 0) {
      quality::write_lost_discs(options.discs, stdout);
    } else if (options.fields > 0) {
      quality::write_tree_fields(options.fields, stdout);
    } else {
      write_tables(options);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_tree: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
