// SPDX-License-Identifier: MIT
// Measures the error of this library and of others on the same scenes.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/option_values.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"
#include "options.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/noise_table.h"
#include "quality/reference.h"
#include "quality/results.h"
#include "quality/scene_radiance.h"
#include "quality/window.h"
#include "reference_cache.h"
#include "scenes/scene.h"

namespace {

/// Side of the window that is shown side by side, in pixels.
constexpr std::size_t window_side = 128;

/// References of path-traced scenes have as many times the samples of the others: a few very bright
/// paths decide how far off they are.
constexpr std::size_t path_traced_factor = 4;

struct Subject {
  std::string name;
  std::unique_ptr<scenes::Scene> scene;
  baselines::Radiance radiance;
  std::vector<float> reference;
  std::size_t reference_rate = 0;  // samples per pixel
  double reference_error = 0;
};

/// One line of the results to be.
struct Task {
  const Subject* subject;
  const quality::Method* method;
  double rate;
  quality::Result result;
  std::string error;               // empty: none
  std::vector<float> pixels = {};  // of the first run, where they are wanted side by side
};

void print_list() {
  std::puts("Scenes:");
  for (const std::string_view name : scenes::scene_names()) {
    std::printf("  %.*s\n", static_cast<int>(name.size()), name.data());
  }
  std::puts("  image:FILE\nMethods:");
  std::size_t longest = 0;
  for (const quality::Method& method : quality::methods()) {
    longest = std::max(longest, method.name.size());
  }
  for (const quality::Method& method : quality::methods()) {
    std::printf("  %-*s %s%s%s\n", static_cast<int>(longest), method.name.c_str(),
                method.description.c_str(), method.paper.empty() ? "" : "; ", method.paper.c_str());
  }
}

std::vector<Subject> make_subjects(const Options& options) {
  std::vector<std::string> names = options.scenes;
  if (names.empty()) names.assign(scenes::scene_names().begin(), scenes::scene_names().end());
  std::vector<Subject> subjects;
  for (const std::string& name : names) {
    Subject subject{name, nullptr, nullptr, {}, options.reference, 0};
    try {
      subject.scene = scenes::make_scene({.name = name,
                                          .width = static_cast<int>(options.width),
                                          .height = static_cast<int>(options.height)});
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--scenes: ") + error.what());
    }
    if (name == "cornell" || name == "spheres") subject.reference_rate *= path_traced_factor;
    if (options.noisy && options.scenes.empty() && !subject.scene->noisy()) continue;
    subject.radiance = quality::radiance_of(*subject.scene);
    subjects.push_back(std::move(subject));
  }
  return subjects;
}

std::vector<const quality::Method*> chosen_methods(const Options& options) {
  std::vector<const quality::Method*> chosen;
  for (const std::string& name : options.methods) {
    try {
      chosen.push_back(&quality::find_method(name));
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--methods: ") + error.what());
    }
  }
  if (chosen.empty()) {
    for (const quality::Method& method : quality::methods()) chosen.push_back(&method);
  }
  return chosen;
}

std::string folder_of(const Options& options, const Subject& subject) {
  return options.pictures + "/" + quality::file_name(subject.name);
}

void write_reference(const Options& options, const Subject& subject) {
  const std::string folder = folder_of(options, subject);
  make_folder(folder);
  write_picture(folder + "/reference.png", {options.width, options.height, 3, subject.reference});
  const quality::Window window =
      quality::busiest_window({options.width, options.height, subject.reference}, window_side);
  // As oiiotool wants it.
  write_text(folder + "/window.txt",
             std::to_string(window.width) + "x" + std::to_string(window.height) + "+" +
                 std::to_string(window.x) + "+" + std::to_string(window.y) + "\n");
}

void perform(const Options& options, Task& task) {
  const Subject& subject = *task.subject;
  const quality::PictureView reference{options.width, options.height, subject.reference};
  quality::Result& result = task.result;
  result.scene = subject.name;
  result.method = task.method->name;
  result.rate = task.rate;
  result.width = options.width;
  result.height = options.height;
  result.seeds = options.seeds;
  result.reference_rate = subject.reference_rate;
  result.reference_error = subject.reference_error;

  using quality::Metrics;
  constexpr double Metrics::*fields[] = {&Metrics::rmse,
                                         &Metrics::psnr,
                                         &Metrics::relative_mse,
                                         &Metrics::ssim,
                                         &Metrics::worst_block_rmse,
                                         &Metrics::missed_blocks,
                                         &Metrics::seam,
                                         &Metrics::bad_values,
                                         &Metrics::relmse,
                                         &Metrics::mean_ratio,
                                         &Metrics::border_step,
                                         &Metrics::negative_share};
  const auto seeds = static_cast<double>(options.seeds);
  std::vector<double> errors;
  double least_seconds = std::numeric_limits<double>::infinity();
  for (std::size_t seed = 1; seed <= options.seeds; ++seed) {
    const quality::Run run = quality::run_method(
        *task.method, subject.radiance,
        quality::job_of(*subject.scene, options.width, options.height,
                        quality::samples_of(task.rate, options.width, options.height), seed));
    const Metrics metrics =
        quality::measure({options.width, options.height, run.pixels}, reference, run.samples);
    for (const auto field : fields) result.metrics.*field += metrics.*field / seeds;
    errors.push_back(metrics.rmse);
    result.samples += static_cast<double>(run.calls) / seeds;
    least_seconds = std::min(least_seconds, run.seconds);
    result.sampler_seconds =
        seed == 1 ? run.sampler_seconds : std::min(result.sampler_seconds, run.sampler_seconds);
    if (seed == 1 && !options.pictures.empty()) {
      write_picture(folder_of(options, subject) + "/" + quality::file_name(result.method) + "_" +
                        quality::rate_name(task.rate) + ".png",
                    {options.width, options.height, 3, run.pixels});
      if (options.noisy) task.pixels = run.pixels;
    }
  }
  result.core_seconds = std::max(0.0, least_seconds - result.sampler_seconds);
  double squares = 0;
  for (const double error : errors) squares += std::pow(error - result.metrics.rmse, 2);
  if (options.seeds > 1) result.rmse_deviation = std::sqrt(squares / (seeds - 1));
}

/// A picture of each scene: a row for each rate, a column for each method, white where there is
/// none, and the reference.
void write_sheets(const Options& options, const std::vector<const quality::Method*>& methods,
                  const std::vector<Subject>& subjects, const std::vector<Task>& tasks) {
  for (const Subject& subject : subjects) {
    std::vector<Picture> pictures;
    for (const double rate : options.rates) {
      for (const quality::Method* method : methods) {
        const auto task = std::find_if(tasks.begin(), tasks.end(), [&](const Task& each) {
          return each.subject == &subject && each.method == method && each.rate == rate;
        });
        const bool made = task != tasks.end() && !task->pixels.empty();
        pictures.push_back(
            {options.width, options.height, 3,
             made ? task->pixels : std::vector<float>(3 * options.width * options.height, 1.0f)});
      }
      pictures.push_back({options.width, options.height, 3, subject.reference});
    }
    write_picture(folder_of(options, subject) + ".png",
                  contact_sheet(pictures, methods.size() + 1));
  }
}

void print_noise(const Options& options, const std::vector<Subject>& subjects,
                 const std::vector<quality::Result>& results) {
  std::fputs(quality::noise_table(results).c_str(), stdout);
  for (const Subject& subject : subjects) {
    const quality::PictureView reference{options.width, options.height, subject.reference};
    std::printf("%s: the reference is off by %.2g, its border is %.3f\n", subject.name.c_str(),
                subject.reference_error, quality::border_step(reference));
  }
}

/// \return the number of failures, which were told
std::size_t measure_all(const Options& options) {
  const std::vector<const quality::Method*> methods = chosen_methods(options);
  std::vector<Subject> subjects = make_subjects(options);
  freqsynth::ThreadPool pool(options.threads);

  // Progress counts samples: those of references, then those of runs.
  double all = 0;
  for (const Subject& subject : subjects) all += static_cast<double>(subject.reference_rate);
  std::vector<Task> tasks;
  for (const Subject& subject : subjects) {
    for (const quality::Method* method : methods) {
      for (const double rate : options.rates) {
        if (rate < method->least_rate) continue;
        if (method->for_noise && !subject.scene->noisy()) continue;
        tasks.push_back({&subject, method, rate, {}, {}});
        all += rate * static_cast<double>(options.seeds);
      }
    }
  }
  // What cannot be written is told before the work, not after it.
  const std::filesystem::path folder = std::filesystem::path(options.csv).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw std::runtime_error(options.csv + ": the folder does not exist");
  }
  for (const Subject& subject : subjects) {
    if (!options.pictures.empty()) make_folder(folder_of(options, subject));
  }

  ProgressBar bar;
  double done = 0;
  for (Subject& subject : subjects) {
    const quality::Reference reference = quality::cached_reference(
        options.cache, subject.name, subject.radiance, quality::pixel_average_of(*subject.scene),
        {options.width, options.height, subject.reference_rate, 0}, pool, [&](double share) {
          bar.show((done + share * static_cast<double>(subject.reference_rate)) / all);
        });
    subject.reference = reference.pixels();
    subject.reference_error = reference.standard_error();
    done += static_cast<double>(subject.reference_rate);
    if (!options.pictures.empty()) write_reference(options, subject);
  }

  // Long runs first, so that no thread is left alone with one at the end.
  std::vector<std::size_t> order(tasks.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return tasks[a].rate > tasks[b].rate; });
  std::mutex mutex;
  const auto run = [&](std::size_t index) {
    Task& task = tasks[order[index]];
    try {
      perform(options, task);
    } catch (const std::exception& error) {
      task.error = error.what();
    }
    const std::scoped_lock lock(mutex);
    done += task.rate * static_cast<double>(options.seeds);
    bar.show(done / all);
  };
  pool.execute(tasks.size(), freqsynth::TaskRef(run));

  std::vector<quality::Result> results;
  std::size_t failures = 0;
  for (const Task& task : tasks) {
    if (task.error.empty()) {
      results.push_back(task.result);
      continue;
    }
    ++failures;
    std::fprintf(stderr, "freqsynth_quality: %s, %s at %g samples per pixel: %s\n",
                 task.subject->name.c_str(), task.method->name.c_str(), task.rate,
                 task.error.c_str());
  }
  const std::string csv = quality::to_csv(results);
  if (options.noisy) print_noise(options, subjects, results);
  if (options.noisy && !options.pictures.empty()) write_sheets(options, methods, subjects, tasks);
  if (!options.csv.empty()) {
    write_text(options.csv, csv);
  } else if (!options.noisy) {
    std::fputs(csv.c_str(), stdout);
  }
  return failures;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    if (options->list) {
      print_list();
      return 0;
    }
    return measure_all(*options) == 0 ? 0 : 1;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_quality: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_quality: %s\n", error.what());
    return 1;
  }
}
