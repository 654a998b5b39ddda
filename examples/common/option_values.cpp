// SPDX-License-Identifier: MIT
#include "option_values.h"

#include <cmath>

void refuse(std::string_view option, std::string_view value, std::string_view wanted) {
  throw UsageError(std::string(option) + " " + std::string(value) + ": not " + std::string(wanted));
}

void read_positive(std::string_view option, const std::string& text, double& number) {
  if (text.empty()) return;
  const std::size_t slash = text.find('/');
  double denominator = 1;
  const bool read = read_all(std::string_view(text).substr(0, slash), number) &&
                    (slash == std::string::npos ||
                     read_all(std::string_view(text).substr(slash + 1), denominator));
  number /= denominator;
  if (!read || !(number > 0) || !std::isfinite(number)) {
    refuse(option, text, "a number > 0 such as 0.5 or 1/64");
  }
}

void read_size(std::string_view option, const std::string& text, std::size_t& width,
               std::size_t& height) {
  if (text.empty()) return;
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos || !read_all(std::string_view(text).substr(0, cross), width) ||
      !read_all(std::string_view(text).substr(cross + 1), height) || width == 0 || height == 0 ||
      width > 65536 || height > 65536) {
    refuse(option, text, "WIDTHxHEIGHT with both in 1..65536");
  }
}
