// SPDX-License-Identifier: MIT
// What each free parameter of the method does to the error: one at a time is moved away from its
// default. Half of the scenes are there to choose by, the other half to check the choice. Prints
// Markdown.

#include <OpenImageIO/argparse.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/thread_pool.h"
#include "quality/tune_measure.h"
#include "quality/tune_parameters.h"

namespace tune {
namespace {

constexpr const char* usage_line =
    "freqsynth_tune [--size N] [--reference N] [--parameters A,B] [--list]";

/// Those that are named, in that order, each once.
std::vector<Parameter> chosen_of(const std::vector<Parameter>& all, const std::string& names) {
  std::vector<Parameter> chosen;
  for (const std::string& name : OIIO::Strutil::splits(names, ",")) {
    const auto has_name = [&](const Parameter& parameter) { return parameter.name == name; };
    const auto found = std::find_if(all.begin(), all.end(), has_name);
    if (found == all.end()) {
      std::string known = "one of";
      for (const Parameter& parameter : all) known.append(" ") += parameter.name;
      refuse("--parameters", name, known);
    }
    if (std::none_of(chosen.begin(), chosen.end(), has_name)) chosen.push_back(*found);
  }
  return chosen;
}

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
  if (!names.empty()) options.parameters = chosen_of(options.parameters, names);
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

void print_table(const Options& options, const std::vector<Subject>& subjects,
                 const Measured& measured) {
  for (std::size_t half = 0; half < halves().size(); ++half) {
    std::printf("* %s half: %s.\n", half == 0 ? "First" : "Second",
                OIIO::Strutil::join(halves()[half], ", ").c_str());
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
      for (std::size_t half = 0; half < halves().size(); ++half) {
        std::printf(" %.3f |", ratio_of(parameter, value, half, options, subjects, measured));
      }
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace tune

int main(int argc, const char** argv) {
  try {
    const std::optional<tune::Options> options = tune::parse_options(argc, argv);
    if (!options) return 0;
    tune::check_defaults(options->parameters, options->size);
    if (options->list) {
      tune::print_list(*options);
      return 0;
    }
    freqsynth::ThreadPool pool;
    const std::vector<tune::Subject> subjects = tune::make_subjects(*options, pool);
    tune::print_table(*options, subjects, tune::measure_all(*options, subjects, pool));
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_tune: %s\nusage: %s\n", error.what(), tune::usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_tune: %s\n", error.what());
    return 1;
  }
}
