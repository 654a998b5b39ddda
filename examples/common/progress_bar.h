// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>

/// A line that is drawn over on a terminal, and nothing elsewhere.
class ProgressBar {
 public:
  /// \param seconds_left  infinity: unknown
  void show(double share, double seconds_left = std::numeric_limits<double>::infinity()) {
    const int percent = static_cast<int>(100 * share);
    const double left = std::ceil(seconds_left);
    if (!terminal_ || (percent == percent_ && left == left_)) return;
    percent_ = percent;
    left_ = left;
    const std::string done(static_cast<std::size_t>(std::clamp(percent, 0, 100) / 2), '#');
    std::fprintf(stderr, "\r[%-50s] %3d%%%-20s", done.c_str(), percent, time_of(left).c_str());
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
    if (terminal_ && percent_ >= 0) std::fprintf(stderr, "\r%77s\r", "");
    percent_ = -1;
  }
  /// Less than a second is not worth telling.
  static std::string time_of(double seconds) {
    if (!(seconds > 1) || !std::isfinite(seconds)) return "";
    std::array<char, 40> text{};
    if (seconds < 600) {
      std::snprintf(text.data(), text.size(), ", %.0f s left", seconds);
    } else if (seconds < 36000) {
      std::snprintf(text.data(), text.size(), ", %.0f min left", seconds / 60);
    } else {
      std::snprintf(text.data(), text.size(), ", %.0f h left", std::min(seconds / 3600, 1e6));
    }
    return text.data();
  }

  bool terminal_ = isatty(STDERR_FILENO) != 0;
  int percent_ = -1;
  double left_ = 0;
};
