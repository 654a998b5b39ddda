// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

/// A line that is drawn over on a terminal, and nothing elsewhere.
class ProgressBar {
 public:
  void show(double share) {
    const int percent = static_cast<int>(100 * share);
    if (!terminal_ || percent == percent_) return;
    percent_ = percent;
    const std::string done(static_cast<std::size_t>(std::clamp(percent, 0, 100) / 2), '#');
    std::fprintf(stderr, "\r[%-50s] %3d%%", done.c_str(), percent);
    if (percent >= 100) clear();
  }
  /// For a run without a known end.
  void count(double samples_per_pixel) {
    if (!terminal_) return;
    percent_ = 0;
    std::fprintf(stderr, "\r%10.2f samples per pixel", samples_per_pixel);
  }
  ~ProgressBar() { clear(); }

 private:
  void clear() {
    if (terminal_ && percent_ >= 0) std::fprintf(stderr, "\r%60s\r", "");
    percent_ = -1;
  }

  bool terminal_ = isatty(STDERR_FILENO) != 0;
  int percent_ = -1;
};
