// SPDX-License-Identifier: MIT
#include "figures.h"

#include <array>
#include <cstdio>

namespace farm {
namespace {

template <class... Values>
std::string print(const char* form, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), form, values...);
  return text.data();
}

unsigned long long whole(std::uint64_t number) { return number; }

double samples_per_pixel(const RunFigures& run) {
  return static_cast<double>(run.samples) /
         static_cast<double>(run.options.width * run.options.height);
}

}  // namespace

std::string as_text(const RunFigures& run) {
  return print("%.4g samples per pixel in %.2f s, %zu ranks, %zu + %zu bytes per sample",
               samples_per_pixel(run), run.seconds, run.figures.ranks.size(),
               run.format.request_bytes(), run.format.value_bytes());
}

std::string as_json(const RunFigures& run) {
  const Figures& figures = run.figures;
  std::string text = "{\n";
  text += print("  \"width\": %zu,\n  \"height\": %zu,\n", run.options.width, run.options.height);
  text += print("  \"samples\": %llu,\n  \"samples_per_pixel\": %.9g,\n", whole(run.samples),
                samples_per_pixel(run));
  text += print("  \"waves\": %llu,\n  \"wall_seconds\": %.6f,\n", whole(run.waves), run.seconds);
  text += print("  \"request_bytes\": %zu,\n  \"value_bytes\": %zu,\n", run.format.request_bytes(),
                run.format.value_bytes());
  text += print("  \"bytes_out\": %llu,\n  \"bytes_in\": %llu,\n", whole(figures.bytes_out),
                whole(figures.bytes_in));
  text += print("  \"choosing_seconds\": %.6f,\n  \"absorbing_seconds\": %.6f,\n", figures.choosing,
                figures.absorbing);
  text += print("  \"finishing_seconds\": %.6f,\n", figures.finishing);
  text += print("  \"mailing_seconds\": %.6f,\n  \"windows\": [", figures.mailing);
  for (std::size_t w = 0; w < figures.windows.size(); ++w) {
    text += print("%s%llu", w > 0 ? ", " : "", whole(figures.windows[w]));
  }
  text += "],\n  \"ranks\": [\n";
  for (std::size_t r = 0; r < figures.ranks.size(); ++r) {
    const RankFigures& rank = figures.ranks[r];
    text += print(
        "    {\"samples\": %llu, \"packets\": %llu, \"most_under_way\": %zu, \"errors\": %llu, "
        "\"tracing_seconds\": %.6f}%s\n",
        whole(rank.samples), whole(rank.packets), rank.most_under_way, whole(rank.errors),
        rank.seconds, r + 1 < figures.ranks.size() ? "," : "");
  }
  return text + "  ]\n}\n";
}

}  // namespace farm
