// SPDX-License-Identifier: MIT
#include "results.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace quality {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

/// A text in quotes where its characters would be mistaken for a separator.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char each : text) {
    if (each == '"') result += '"';
    result += each;
  }
  return result += '"';
}

}  // namespace

std::string to_csv(std::span<const Result> results) {
  std::string text =
      "scene,method,spp,width,height,seeds,samples,rmse,rmse_deviation,psnr,relative_mse,ssim,"
      "worst_block_rmse,missed_blocks,seam,bad_values,reference_spp,reference_error,"
      "relmse,mean_ratio,border_step,negative_share,core_seconds,sampler_seconds\n";
  for (const Result& result : results) {
    text.append(quoted(result.scene)).append(",").append(quoted(result.method));
    const Metrics& metrics = result.metrics;
    for (const double value : {result.rate,
                               static_cast<double>(result.width),
                               static_cast<double>(result.height),
                               static_cast<double>(result.seeds),
                               result.samples,
                               metrics.rmse,
                               result.rmse_deviation,
                               metrics.psnr,
                               metrics.relative_mse,
                               metrics.ssim,
                               metrics.worst_block_rmse,
                               metrics.missed_blocks,
                               metrics.seam,
                               metrics.bad_values,
                               static_cast<double>(result.reference_rate),
                               result.reference_error,
                               metrics.relmse,
                               metrics.mean_ratio,
                               metrics.border_step,
                               metrics.negative_share,
                               result.core_seconds,
                               result.sampler_seconds}) {
      text.append(",").append(number(value));
    }
    text += '\n';
  }
  return text;
}

std::string file_name(const std::string& name) {
  std::string result = name;
  for (char& each : result) {
    const bool plain = (each >= 'a' && each <= 'z') || (each >= 'A' && each <= 'Z') ||
                       (each >= '0' && each <= '9') || each == '-' || each == '.';
    if (!plain) each = '_';
  }
  return result;
}

std::string rate_name(double rate) {
  const double inverse = 1 / rate;
  if (rate < 1 && inverse == std::round(inverse)) return "1_" + number(inverse);
  return number(rate);
}

}  // namespace quality
