// SPDX-License-Identifier: MIT
#include "quality/tune_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/progress_bar.h"
#include "freqsynth/freqsynth.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/scene_radiance.h"

namespace tune {
namespace {

/// Errors below this are rounding; that one is ten times another then means nothing.
constexpr double least_error = 1e-6;

/// A run to be done.
struct Task {
  Setup setup;
  const Subject& subject;
  Errors& errors;
  std::string failure{};  // empty: none
};

Errors measure(const Setup& setup, const Subject& subject) {
  const std::size_t size = setup.synthesis.width;
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const std::uint64_t id = quality::id_of(requests[i], setup.synthesis.list.seed);
      subject.scene->radiance(requests[i].x, requests[i].y, id, values.subspan(3 * i).first<3>());
    }
  };
  freqsynth::Synthesizer engine(setup.synthesis);
  Errors errors{};
  for (std::size_t i = 0; i < rates.size(); ++i) {
    engine.run(sampler, {.samples = quality::samples_of(rates[i], size, size)});
    const std::vector<float> pixels =
        freqsynth::reconstruct(engine.finished_image(setup.finish), {.clamp_negative = true});
    errors[i] =
        std::max(least_error, quality::rmse({size, size, pixels}, {size, size, subject.reference}));
  }
  return errors;
}

/// One for each setup of each subject.
/// \param measured  gets a place for the errors of each
std::vector<Task> make_tasks(const Options& options, const std::vector<Subject>& subjects,
                             Measured& measured) {
  std::vector<Task> tasks;
  for (const Subject& subject : subjects) {
    const bool noisy = subject.scene->noisy();
    const auto add = [&](const Parameter& parameter, const Value* value) {
      const Setup setup = setup_of(parameter, value, options.size);
      const auto [place, added] = measured.try_emplace({&subject, key_of(setup)});
      if (added) tasks.push_back({setup, subject, place->second});
    };
    for (const Parameter& parameter : options.parameters) {
      if (!parameter.concerns(noisy)) continue;
      add(parameter, nullptr);
      for (const Value& value : parameter.values) add(parameter, &value);
    }
  }
  return tasks;
}

}  // namespace

const std::array<std::vector<std::string>, 2>& halves() {
  static const std::array<std::vector<std::string>, 2> names{
      {{"fan", "star", "zoneplate-high", "gradient", "dot", "softshadow", "glossy"},
       {"chess", "zoneplate", "edge", "checker", "corner", "sun", "dof"}}};
  return names;
}

std::vector<Subject> make_subjects(const Options& options, freqsynth::ThreadPool& pool) {
  std::vector<Subject> subjects;
  for (std::size_t half = 0; half < halves().size(); ++half) {
    for (const std::string& name : halves()[half]) {
      const int side = static_cast<int>(options.size);
      Subject subject{half, scenes::make_scene({.name = name, .width = side, .height = side}), {}};
      const bool noisy = subject.scene->noisy();
      if (std::none_of(options.parameters.begin(), options.parameters.end(),
                       [&](const Parameter& parameter) { return parameter.concerns(noisy); })) {
        continue;
      }
      subject.reference =
          quality::render_reference(quality::radiance_of(*subject.scene),
                                    quality::pixel_average_of(*subject.scene),
                                    {options.size, options.size, options.reference, 0}, pool)
              .pixels();
      subjects.push_back(std::move(subject));
    }
  }
  return subjects;
}

Measured measure_all(const Options& options, const std::vector<Subject>& subjects,
                     freqsynth::ThreadPool& pool) {
  Measured measured;
  std::vector<Task> tasks = make_tasks(options, subjects, measured);
  ProgressBar bar;
  std::mutex mutex;
  std::size_t done = 0;
  const auto run = [&](std::size_t index) {
    Task& task = tasks[index];
    try {
      task.errors = measure(task.setup, task.subject);
    } catch (const std::exception& error) {
      task.failure = error.what();
    }
    const std::scoped_lock lock(mutex);
    bar.show(static_cast<double>(++done) / static_cast<double>(tasks.size()));
  };
  pool.execute(tasks.size(), freqsynth::TaskRef(run));
  for (const Task& task : tasks) {
    if (!task.failure.empty()) throw std::runtime_error(task.failure);
  }
  return measured;
}

double ratio_of(const Parameter& parameter, const Value& value, std::size_t half,
                const Options& options, const std::vector<Subject>& subjects,
                const Measured& measured) {
  double sum = 0;
  std::size_t count = 0;
  for (const Subject& subject : subjects) {
    const bool noisy = subject.scene->noisy();
    if (subject.half != half || !parameter.concerns(noisy)) continue;
    const auto errors = [&](const Value* chosen) {
      return measured.at({&subject, key_of(setup_of(parameter, chosen, options.size))});
    };
    const Errors with = errors(&value), without = errors(nullptr);
    for (std::size_t i = 0; i < rates.size(); ++i) sum += std::log(with[i] / without[i]);
    count += rates.size();
  }
  return std::exp(sum / static_cast<double>(count));
}

}  // namespace tune
