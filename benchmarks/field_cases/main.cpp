// SPDX-License-Identifier: MIT
// Measures the field cases and writes their tables.

#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>

#include "report.h"
#if defined(FIELD_CASES_PICTURES)
#include "pictures.h"
#endif

namespace {

constexpr const char* usage =
    "Usage: field_cases [KIND...] [--before FILE] [--values FILE] [--pictures DIR]\n"
    "Measures the field cases and prints their tables in Markdown.\n"
    "  KIND            K1, K2, ..: these only; none: all\n"
    "  --before FILE   figures of an earlier version, as --values wrote them\n"
    "  --values FILE   write the figures of this version\n"
    "  --pictures DIR  write pictures to look at instead: right, now, jittered side by side\n";

struct Options {
  std::set<std::string> kinds;
  std::string before, values, pictures;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      options.kinds.insert(word);
      continue;
    }
    std::string* const value = word == "--before"     ? &options.before
                               : word == "--values"   ? &options.values
                               : word == "--pictures" ? &options.pictures
                                                      : nullptr;
    if (!value || i + 1 == argc) throw std::invalid_argument(word);
    *value = argv[++i];
  }
  return options;
}

int run(const Options& options) {
  if (!options.pictures.empty()) {
#if defined(FIELD_CASES_PICTURES)
    field_cases::write_pictures(options.pictures);
    return 0;
#else
    throw std::runtime_error("built without pictures");
#endif
  }
  field_cases::Values before;
  if (!options.before.empty()) {
    std::ifstream in(options.before);
    if (!in) throw std::runtime_error(options.before + ": cannot be read");
    before = field_cases::read_values(in);
  }
  std::vector<field_cases::Kind> kinds;
  for (field_cases::Kind& kind : field_cases::all_kinds()) {
    if (options.kinds.empty() || options.kinds.count(kind.letter) > 0) {
      kinds.push_back(std::move(kind));
    }
  }
  if (kinds.empty()) throw std::runtime_error("no such kind");
  const auto results = field_cases::measure_all(kinds, std::cerr);
  field_cases::write_tables(kinds, results, before, std::cout);
  if (!options.values.empty()) {
    std::ofstream out(options.values);
    field_cases::write_values(results, out);
    if (!out.flush()) throw std::runtime_error(options.values + ": cannot be written");
  }
  if (!std::cout.flush()) throw std::runtime_error("the tables cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%sfield_cases: %s: not an option, or without a value\n", usage,
                 error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "field_cases: %s\n", error.what());
    return 1;
  }
}
