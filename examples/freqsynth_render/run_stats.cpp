// SPDX-License-Identifier: MIT
#include "run_stats.h"

#include <sys/resource.h>

#include <array>
#include <cstdio>

#include "common/picture.h"

namespace {

/// Why a run ended, in the words of --stats.
const char* name_of(freqsynth::StopReason reason) {
  switch (reason) {
    case freqsynth::StopReason::samples:
      return "samples";
    case freqsynth::StopReason::threshold:
    case freqsynth::StopReason::target_rmse:
      return "target";
    case freqsynth::StopReason::cancelled:
      return "interrupted";
    case freqsynth::StopReason::seconds:
      return "time";
    default:
      return "exhausted";
  }
}

}  // namespace

double samples_per_pixel(const Options& options, const freqsynth::SynthesisStats& stats) {
  return static_cast<double>(stats.samples) / static_cast<double>(options.width * options.height);
}

void write_stats(const Options& options, const freqsynth::SynthesisStats& stats,
                 freqsynth::StopReason reason, const Seconds& seconds) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::array<char, 1024> text{};
  std::snprintf(text.data(), text.size(),
                "{\n"
                "  \"width\": %zu,\n"
                "  \"height\": %zu,\n"
                "  \"samples\": %llu,\n"
                "  \"samples_per_pixel\": %.9g,\n"
                "  \"ended_by\": \"%s\",\n"
                "  \"absorbed\": %llu,\n"
                "  \"blocks\": %llu,\n"
                "  \"bad_samples\": %llu,\n"
                "  \"sampler_seconds\": %.6f,\n"
                "  \"core_seconds\": %.6f,\n"
                "  \"wall_seconds\": %.6f,\n"
                "  \"peak_rss_bytes\": %lld\n"
                "}\n",
                options.width, options.height, static_cast<unsigned long long>(stats.samples),
                samples_per_pixel(options, stats), name_of(reason),
                static_cast<unsigned long long>(stats.absorbed),
                static_cast<unsigned long long>(stats.blocks),
                static_cast<unsigned long long>(stats.bad_samples), seconds.sampler, seconds.core,
                seconds.wall, static_cast<long long>(usage.ru_maxrss) * 1024);
  write_text(options.stats, text.data());
}
