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

// Whether a figure is an error that has its yardsticks.
bool is_error(const Figure& figure) {
  return figure.what.rfind("RMSE", 0) == 0 && !std::isnan(figure.jittered);
}

double earlier(const Values& before, const Result& result, const Figure& figure) {
  const auto found = before.find(name_of(*result.field_case, result.rate, figure.what));
  return found == before.end() ? none : found->second;
}

// How many errors there are of a kind, and how many are too great.
struct Count {
  int all = 0;
  int before = 0;   // were 10 percent more than jittered samples'
  int now = 0;      // are
  int uniform = 0;  // are 3 percent more than with equal samples
};

// Text in lines of at most 100 characters.
std::string wrapped(const std::string& text) {
  std::string lines;
  std::size_t begin = 0;
  while (text.size() - begin > 100) {
    const std::size_t space = text.rfind(' ', begin + 100);
    lines += text.substr(begin, space - begin) + '\n';
    begin = space + 1;
  }
  return lines + text.substr(begin) + '\n';
}

void write_summary(const std::vector<Kind>& kinds, const std::vector<Result>& results,
                   const Values& before, std::ostream& out) {
  out << "| kind | errors measured | over 1.1 times jittered, before | now | over 1.03 times "
         "uniform |\n|---|---|---|---|---|\n";
  for (const Kind& kind : kinds) {
    Count count;
    bool known = false;
    for (const Result& result : results) {
      if (result.kind != &kind || result.field_case->family) continue;
      for (const Figure& figure : result.figures) {
        if (!is_error(figure)) continue;
        const double was = earlier(before, result, figure);
        known = known || !std::isnan(was);
        ++count.all;
        count.before += ratio(was, figure.jittered) > 1.1;
        count.now += ratio(figure.now, figure.jittered) > 1.1;
        count.uniform += ratio(figure.now, figure.uniform) > 1.03;
      }
    }
    if (count.all == 0) continue;
    out << "| " << kind.letter << ": " << kind.title << " | " << count.all << " | "
        << (known ? std::to_string(count.before) : "") << " | " << count.now << " | "
        << count.uniform << " |\n";
  }
}

void write_cases(const Kind& kind, const std::vector<Result>& results, const Values& before,
                 std::ostream& out) {
  bool begun = false;
  const Case* last = nullptr;
  for (const Result& result : results) {
    if (result.kind != &kind || result.field_case->family) continue;
    if (!begun) {
      out << "\n| case | at | measured | right | before | now | jittered | now / jittered | now / "
             "uniform |\n|---|---|---|---|---|---|---|---|---|\n";
      begun = true;
    }
    const Case& field_case = *result.field_case;
    for (const Figure& figure : result.figures) {
      // A case is named once.
      std::string name;
      if (&field_case != last) {
        name = field_case.key.substr(0, field_case.key.find('.')) + ' ' + field_case.name;
      }
      last = &field_case;
      out << "| " << name << " | " << rate_name(result.rate) << " | " << figure.what << " | "
          << number(figure.right) << " | " << number(earlier(before, result, figure)) << " | "
          << number(figure.now) << " | " << number(figure.jittered) << " | "
          << (is_error(figure) ? number(ratio(figure.now, figure.jittered), "%.2f") : "") << " | "
          << (is_error(figure) ? number(ratio(figure.now, figure.uniform), "%.2f") : "") << " |\n";
    }
  }
}

void write_families(const Kind& kind, const std::vector<Result>& results, const Values& before,
                    std::ostream& out) {
  bool begun = false;
  const Case* last = nullptr;
  for (const Result& result : results) {
    if (result.kind != &kind || !result.field_case->family) continue;
    if (!begun) {
      out << "\n| random members | at | RMSE / jittered, before | now | the worst, before | now | "
             "RMSE / uniform, now | the worst |\n|---|---|---|---|---|---|---|---|\n";
      begun = true;
    }
    const Case& family = *result.field_case;
    out << "| " << (&family != last ? family.name : "") << " | " << rate_name(result.rate);
    last = &family;
    for (std::size_t k = 0; k < result.figures.size(); ++k) {
      const Figure& figure = result.figures[k];
      if (k < 2) out << " | " << number(earlier(before, result, figure), "%.2f");
      out << " | " << number(figure.now, "%.2f");
    }
    out << " |\n";
  }
}

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
          << (std::isnan(figure.now) ? "nan" : number(figure.now, "%.6g")) << '\n';
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
  write_summary(kinds, results, before, out);
  for (const Kind& kind : kinds) {
    out << "\n## " << kind.letter << ": " << kind.title << "\n\n" << wrapped(kind.text);
    write_cases(kind, results, before, out);
    write_families(kind, results, before, out);
  }
}

}  // namespace field_cases
