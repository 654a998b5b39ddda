// What each free parameter of the method does to the error: one at a time is moved away from its
// default. Half of the scenes are there to choose by, the other half to check the choice. Prints
// Markdown.

#include <OpenImageIO/argparse.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth_render/option_values.h"
#include "freqsynth_render/progress_bar.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/scene_radiance.h"
#include "scenes/scene.h"

namespace {

constexpr std::array rates{0.25, 1.0, 4.0};

/// Errors below this are rounding; that one is ten times another then means nothing.
constexpr double least_error = 1e-6;

/// To choose by, and to check with.
const std::array<std::vector<std::string>, 2> halves{
    {{"fan", "star", "zoneplate-high", "gradient", "dot", "softshadow", "glossy"},
     {"chess", "zoneplate", "edge", "checker", "corner", "sun", "dof"}}};

// ------------------------------------------------------------------------------------- parameters

/// All that a run depends on but the scene.
struct Setup {
  freqsynth::SynthesisSettings synthesis;
  freqsynth::FinishSettings finish;
};

/// What Synthesizer does when only the scene is told.
Setup default_setup(std::size_t size, bool noisy) {
  Setup setup;
  setup.synthesis.width = setup.synthesis.height = size;
  setup.synthesis.noisy = noisy;
  if (noisy) setup.finish = freqsynth::FinishSettings::noisy();
  return setup;
}

/// All that parameters() change: setups with equal keys give equal pictures.
using Key = std::array<double, 17>;
Key key_of(const Setup& setup) {
  const freqsynth::SynthesisSettings& synthesis = setup.synthesis;
  const freqsynth::PrioritySettings& priority = synthesis.priority;
  const freqsynth::FinishSettings& finish = setup.finish;
  return {synthesis.list.samples_per_term,
          static_cast<double>(synthesis.list.seed),
          static_cast<double>(synthesis.wave),
          static_cast<double>(priority.measure),
          priority.uncertainty,
          priority.decay,
          priority.weight,
          priority.neighbours,
          priority.image,
          static_cast<double>(finish.butterworth.enabled),
          finish.butterworth.cutoff,
          finish.butterworth.order,
          static_cast<double>(finish.measure_doubt),
          finish.doubt,
          finish.shrinkage,
          finish.slack,
          static_cast<double>(synthesis.noisy)};
}

using Change = std::function<void(Setup&)>;

struct Value {
  std::string text;
  Change apply;
};

/// The scenes that a parameter is for: noisy ones have other defaults of their own.
enum class For { all, quiet, noisy };

struct Parameter {
  std::string name;
  For scenes;
  std::vector<Value> values;
  Change base = [](Setup&) {};  ///< made before any value, and to what the values are compared with
};

/// Values of the number that `field(setup)` refers to; an infinite one switches something off.
template <class Field>
std::vector<Value> numbers(std::initializer_list<double> numbers, Field field) {
  std::vector<Value> values;
  for (const double number : numbers) {
    std::array<char, 32> text{"off"};
    if (std::isfinite(number)) std::snprintf(text.data(), text.size(), "%g", number);
    values.push_back({text.data(), [=](Setup& setup) { field(setup) = number; }});
  }
  return values;
}

/// Waves of a share of all blocks.
Value wave_of(std::string text, std::size_t share) {
  return {std::move(text), [=](Setup& setup) {
            freqsynth::SynthesisSettings& synthesis = setup.synthesis;
            const auto grid = freqsynth::BlockGrid::of(synthesis.width, synthesis.height, 3);
            synthesis.wave = std::max<std::size_t>(1, grid.blocks_x * grid.blocks_y / share);
          }};
}

std::vector<Parameter> make_parameters() {
  using freqsynth::PriorityMeasure;
  constexpr double off = std::numeric_limits<double>::infinity();
  const auto cutoff = [](Setup& s) -> double& { return s.finish.butterworth.cutoff; };
  const auto doubt = [](Setup& s) -> double& { return s.finish.doubt; };
  const auto shrinkage = [](Setup& s) -> double& { return s.finish.shrinkage; };
  const auto slack = [](Setup& s) -> double& { return s.finish.slack; };
  const auto set_measure = [](PriorityMeasure measure) {
    return [=](Setup& s) { s.synthesis.priority.measure = measure; };
  };
  const auto set_measure_doubt = [](bool on) {
    return [=](Setup& s) { s.finish.measure_doubt = on; };
  };
  const auto set_seed = [](std::uint64_t seed) {
    return [=](Setup& s) { s.synthesis.list.seed = seed; };
  };

  std::vector<Parameter> all;
  all.push_back({"samples_per_term", For::all,
                 numbers({1.5, 2, 2.5, 3, 4},
                         [](Setup& s) -> double& { return s.synthesis.list.samples_per_term; })});
  all.push_back({"cutoff", For::all, numbers({0.5, 0.65, 0.8, 1, 1.3}, cutoff)});
  all.back().values.push_back({"off", [](Setup& s) { s.finish.butterworth.enabled = false; }});
  all.push_back({"order", For::all, numbers({1, 2, 4}, [](Setup& s) -> double& {
                   return s.finish.butterworth.order;
                 })});
  all.push_back({"measure",
                 For::all,
                 {{"residual", set_measure(PriorityMeasure::residual)},
                  {"change", set_measure(PriorityMeasure::change)}}});
  all.push_back({"uncertainty", For::all, numbers({0.1, 1, 10}, [](Setup& s) -> double& {
                   return s.synthesis.priority.uncertainty;
                 })});
  all.push_back({"decay", For::all, numbers({0.5, 0.7165, 0.85}, [](Setup& s) -> double& {
                   return s.synthesis.priority.decay;
                 })});
  // It is the change that is averaged over the last samples.
  all.push_back(
      {"weight", For::all,
       numbers({0.1, 0.3, 0.6}, [](Setup& s) -> double& { return s.synthesis.priority.weight; }),
       set_measure(PriorityMeasure::change)});
  all.push_back({"neighbours", For::all, numbers({0, 4, 16, 64}, [](Setup& s) -> double& {
                   return s.synthesis.priority.neighbours;
                 })});
  all.push_back({"image", For::all, numbers({0, 0.25, 1, 4}, [](Setup& s) -> double& {
                   return s.synthesis.priority.image;
                 })});
  // 0 is what the library takes for 1/32 of the blocks.
  all.push_back({"wave",
                 For::all,
                 {{"1 block", [](Setup& s) { s.synthesis.wave = 1; }},
                  wave_of("1/64", 64),
                  {"1/32", [](Setup& s) { s.synthesis.wave = 0; }},
                  wave_of("1/16", 16),
                  wave_of("1/4", 4)}});
  all.push_back({"seed", For::all, {{"0", set_seed(0)}, {"1", set_seed(1)}, {"2", set_seed(2)}}});
  all.push_back({"doubt", For::quiet, numbers({0.25, 0.5, 1, 2}, doubt)});
  all.push_back({"shrinkage", For::quiet, numbers({0, 1, 2, 4}, shrinkage)});
  all.push_back({"slack", For::quiet, numbers({0, 0.2, 0.4, 0.8, off}, slack)});
  all.push_back({"noisy_doubt", For::noisy, numbers({0.5, 1, 4, 16}, doubt)});
  all.push_back({"noisy_measure_doubt",
                 For::noisy,
                 {{"on", set_measure_doubt(true)}, {"off", set_measure_doubt(false)}}});
  all.push_back({"noisy_shrinkage", For::noisy, numbers({1, 2, 4, 8}, shrinkage)});
  all.push_back({"noisy_slack", For::noisy, numbers({0, 0.4, off}, slack)});
  return all;
}

/// \param value  null: what the values of the parameter are compared with
Setup setup_of(const Parameter& parameter, const Value* value, std::size_t size, bool noisy) {
  Setup setup = default_setup(size, noisy);
  parameter.base(setup);
  if (value != nullptr) value->apply(setup);
  return setup;
}

bool is_default(const Parameter& parameter, const Value& value, std::size_t size) {
  const bool noisy = parameter.scenes == For::noisy;
  return key_of(setup_of(parameter, &value, size, noisy)) ==
         key_of(setup_of(parameter, nullptr, size, noisy));
}

/// A default that has moved away from the values here must not go unseen.
void check_defaults(const std::vector<Parameter>& parameters, std::size_t size) {
  for (const Parameter& parameter : parameters) {
    const auto defaults =
        std::count_if(parameter.values.begin(), parameter.values.end(),
                      [&](const Value& value) { return is_default(parameter, value, size); });
    if (defaults != 1) {
      std::string said = parameter.name;
      throw std::logic_error(said.append(": ").append(std::to_string(defaults)) +
                             " of its values are the default instead of 1");
    }
  }
}

// -------------------------------------------------------------------------------------- measuring

struct Options {
  std::size_t size = 128;       // side of the pictures in pixels
  std::size_t reference = 256;  // samples per pixel
  std::vector<Parameter> parameters;
  bool list = false;
};

struct Subject {
  std::size_t half;
  std::unique_ptr<scenes::Scene> scene;
  std::vector<float> reference;
};

using Errors = std::array<double, rates.size()>;  // RMSE at each rate

/// A run to be done once, whoever asks for it.
struct Task {
  const Subject* subject;
  Setup setup;
  Errors errors{};
  std::string failure;  // empty: none
};
using Tasks = std::map<std::pair<const Subject*, Key>, Task>;

bool concerns(const Parameter& parameter, const Subject& subject) {
  return parameter.scenes == For::all || (parameter.scenes == For::noisy) == subject.scene->noisy();
}

Errors measure(const Setup& setup, const Subject& subject) {
  const std::size_t size = setup.synthesis.width;
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      // Other seeds get other noise.
      const std::uint64_t id = requests[i].id ^ (setup.synthesis.list.seed << 40);
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

std::vector<Subject> make_subjects(const Options& options, freqsynth::ThreadPool& pool) {
  std::vector<Subject> subjects;
  for (std::size_t half = 0; half < halves.size(); ++half) {
    for (const std::string& name : halves[half]) {
      const int side = static_cast<int>(options.size);
      Subject subject{half, scenes::make_scene({.name = name, .width = side, .height = side}), {}};
      const auto wanted = [&](const Parameter& parameter) { return concerns(parameter, subject); };
      if (std::none_of(options.parameters.begin(), options.parameters.end(), wanted)) continue;
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

/// Every setup of every subject, measured.
Tasks measure_all(const Options& options, const std::vector<Subject>& subjects,
                  freqsynth::ThreadPool& pool) {
  Tasks tasks;
  std::vector<Task*> order;
  for (const Subject& subject : subjects) {
    const auto add = [&](const Parameter& parameter, const Value* value) {
      Setup setup = setup_of(parameter, value, options.size, subject.scene->noisy());
      const auto [task, added] =
          tasks.try_emplace({&subject, key_of(setup)}, Task{&subject, setup, {}, {}});
      if (added) order.push_back(&task->second);
    };
    for (const Parameter& parameter : options.parameters) {
      if (!concerns(parameter, subject)) continue;
      add(parameter, nullptr);
      for (const Value& value : parameter.values) add(parameter, &value);
    }
  }

  ProgressBar bar;
  std::mutex mutex;
  std::size_t done = 0;
  const auto run = [&](std::size_t index) {
    Task& task = *order[index];
    try {
      task.errors = measure(task.setup, *task.subject);
    } catch (const std::exception& error) {
      task.failure = error.what();
    }
    const std::scoped_lock lock(mutex);
    bar.show(static_cast<double>(++done) / static_cast<double>(order.size()));
  };
  pool.execute(order.size(), freqsynth::TaskRef(run));
  for (const Task* task : order) {
    if (!task->failure.empty()) throw std::runtime_error(task->failure);
  }
  return tasks;
}

/// Geometric mean of RMSE / RMSE with defaults, over the rates and the scenes of a half.
double ratio_of(const Parameter& parameter, const Value& value, std::size_t half,
                const Options& options, const std::vector<Subject>& subjects, const Tasks& tasks) {
  double sum = 0;
  std::size_t count = 0;
  for (const Subject& subject : subjects) {
    if (subject.half != half || !concerns(parameter, subject)) continue;
    const auto errors = [&](const Value* chosen) {
      const Setup setup = setup_of(parameter, chosen, options.size, subject.scene->noisy());
      return tasks.at({&subject, key_of(setup)}).errors;
    };
    const Errors with = errors(&value), without = errors(nullptr);
    for (std::size_t i = 0; i < rates.size(); ++i) sum += std::log(with[i] / without[i]);
    count += rates.size();
  }
  return std::exp(sum / static_cast<double>(count));
}

// ------------------------------------------------------------------------------------- the program

constexpr const char* usage_line =
    "freqsynth_tune [--size N] [--reference N] [--parameters A,B] [--list]";

/// Empty when --help was asked for and printed.
std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  std::string size, reference, names;
  bool help = false;
  OIIO::ArgParse parser;
  parser.intro("freqsynth_tune: what each free parameter does to the error, as Markdown");
  parser.usage(usage_line);
  parser.add_help(false).exit_on_error(false);
  parser.arg("--help", &help).help("Print this help");
  parser.arg("--list", &options.list).help("Print the parameters and their values");
  parser.arg("--size %s:N", &size).help("Side of the pictures in pixels, at most 4096 (128)");
  parser.arg("--reference %s:N", &reference)
      .help("Jittered samples per pixel of the reference, even (256)");
  parser.arg("--parameters %s:A,B", &names).help("Only these parameters (all)");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (help) {
    parser.print_help();
    return std::nullopt;
  }

  read_count<std::size_t>("--size", size, 1, options.size);
  if (options.size > 4096) refuse("--size", size, "at most 4096");
  read_count<std::size_t>("--reference", reference, 2, options.reference);
  if (options.reference % 2 != 0) refuse("--reference", reference, "even");

  options.parameters = make_parameters();
  if (names.empty()) return options;
  std::vector<Parameter> chosen;
  for (const std::string& name : OIIO::Strutil::splits(names, ",")) {
    const auto has_name = [&](const Parameter& parameter) { return parameter.name == name; };
    const auto found = std::find_if(options.parameters.begin(), options.parameters.end(), has_name);
    if (found == options.parameters.end()) {
      std::string known = "one of";
      for (const Parameter& parameter : options.parameters) known.append(" ") += parameter.name;
      refuse("--parameters", name, known);
    }
    if (std::none_of(chosen.begin(), chosen.end(), has_name)) chosen.push_back(*found);
  }
  options.parameters = std::move(chosen);
  return options;
}

void print_list(const Options& options) {
  for (const Parameter& parameter : options.parameters) {
    std::printf("%s:", parameter.name.c_str());
    for (const Value& value : parameter.values) {
      std::printf(" %s%s", value.text.c_str(),
                  is_default(parameter, value, options.size) ? " (default)" : "");
    }
    std::printf("\n");
  }
}

void print_table(const Options& options, const std::vector<Subject>& subjects, const Tasks& tasks) {
  for (std::size_t half = 0; half < halves.size(); ++half) {
    std::printf("* %s half: %s.\n", half == 0 ? "First" : "Second",
                OIIO::Strutil::join(halves[half], ", ").c_str());
  }
  std::printf(
      "* Pictures of %zu x %zu pixels; references of %zu samples per pixel where a scene does not\n"
      "  know the exact mean.\n\n"
      "| parameter | value | first half | second half |\n|---|---|---:|---:|\n",
      options.size, options.size, options.reference);
  for (const Parameter& parameter : options.parameters) {
    for (const Value& value : parameter.values) {
      std::printf("| %s | %s%s |", parameter.name.c_str(), value.text.c_str(),
                  is_default(parameter, value, options.size) ? " (default)" : "");
      for (std::size_t half = 0; half < halves.size(); ++half) {
        std::printf(" %.3f |", ratio_of(parameter, value, half, options, subjects, tasks));
      }
      std::printf("\n");
    }
  }
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    check_defaults(options->parameters, options->size);
    if (options->list) {
      print_list(*options);
      return 0;
    }
    freqsynth::ThreadPool pool;
    const std::vector<Subject> subjects = make_subjects(*options, pool);
    print_table(*options, subjects, measure_all(*options, subjects, pool));
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_tune: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_tune: %s\n", error.what());
    return 1;
  }
}
