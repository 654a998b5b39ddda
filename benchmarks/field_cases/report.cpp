// SPDX-License-Identifier: MIT
#include "report.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <istream>
#include <mutex>
#include <ostream>
#include <stdexcept>
#include <thread>

namespace field_cases {
namespace {

std::string number(double value, const char* format = "%.3g") {
  if (std::isnan(value)) return "";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string rate_name(double rate) {
  if (std::isinf(rate)) return "no limit";
  return rate == 0.25 ? "1/4" : rate == 0.5 ? "1/2" : number(rate, "%g");
}

std::string name_of(const Case& field_case, double rate, const std::string& what) {
  return field_case.key + '\t' + number(rate, "%g") + '\t' + what;
}

// How many times as wrong, as the tables tell it; errors of nothing but rounding are none.
double ratio(double error, double other) {
  constexpr double rounding = 1e-6;
  if (std::isnan(error) || std::isnan(other)) return none;
  if (other < rounding) return error < rounding ? 1 : std::numeric_limits<double>::infinity();
  return error / other;
}

bool is_error(const Figure& figure) { return figure.what.rfind("RMSE", 0) == 0; }

}  // namespace

std::vector<Result> measure_all(const std::vector<Kind>& kinds, std::ostream& progress) {
  std::vector<Result> results;
  for (const Kind& kind : kinds) {
    for (const Case& field_case : kind.cases) {
      for (const double rate : field_case.rates) results.push_back({&kind, &field_case, rate, {}});
    }
  }
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    for (std::size_t k = next++; k < results.size(); k = next++) {
      Result& result = results[k];
      try {
        result.figures = result.field_case->measure(result.rate);
      } catch (...) {
        const std::lock_guard lock(mutex);
        error = std::current_exception();
        return;
      }
      const std::lock_guard lock(mutex);
      progress << result.field_case->key << ' ' << rate_name(result.rate) << std::endl;
    }
  };
  std::vector<std::thread> threads;
  for (unsigned n = std::max(1u, std::thread::hardware_concurrency()); n > 0; --n) {
    threads.emplace_back(work);
  }
  for (std::thread& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
  return results;
}

void write_values(const std::vector<Result>& results, std::ostream& out) {
  for (const Result& result : results) {
    for (const Figure& figure : result.figures) {
      out << name_of(*result.field_case, result.rate, figure.what) << '\t'
          << number(figure.now, "%.6g") << '\n';
    }
  }
}

Values read_values(std::istream& in) {
  Values values;
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t tab = line.rfind('\t');
    std::size_t end = 0;
    try {
      if (tab == std::string::npos) throw std::invalid_argument("no tab");
      values[line.substr(0, tab)] = std::stod(line.substr(tab + 1), &end);
    } catch (const std::logic_error&) {
      throw std::runtime_error("field_cases: not a value: " + line);
    }
  }
  return values;
}

void write_tables(const std::vector<Kind>& kinds, const std::vector<Result>& results,
                  const Values& before, std::ostream& out) {
  for (const Kind& kind : kinds) {
    out << "\n## " << kind.letter << ": " << kind.title << "\n\n" << kind.text << "\n\n";
    out << "| case | at | measured | right | before | now | jittered | now / jittered | "
           "now / uniform |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const Result& result : results) {
      if (result.kind != &kind) continue;
      const Case& field_case = *result.field_case;
      for (const Figure& figure : result.figures) {
        const auto found = before.find(name_of(field_case, result.rate, figure.what));
        const bool compare = is_error(figure) && !std::isnan(figure.jittered);
        out << "| " << field_case.key.substr(0, field_case.key.find('.')) << ' ' << field_case.name
            << " | " << rate_name(result.rate) << " | " << figure.what << " | "
            << number(figure.right) << " | " << (found == before.end() ? "" : number(found->second))
            << " | " << number(figure.now) << " | " << number(figure.jittered) << " | "
            << (compare ? number(ratio(figure.now, figure.jittered), "%.2f") : "") << " | "
            << (compare ? number(ratio(figure.now, figure.uniform), "%.2f") : "") << " |\n";
      }
    }
  }
}

}  // namespace field_cases
