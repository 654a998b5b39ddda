// SPDX-License-Identifier: MIT
#include "noise_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace quality {
namespace {

double own_rmse(const Result& result) {
  const double square = std::pow(result.metrics.rmse, 2) - std::pow(result.reference_error, 2);
  return std::sqrt(std::max(0.0, square));
}

std::string line_of(const std::string& scene, double rate, const std::string& method, double rmse,
                    const Metrics& metrics) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "| %-10s | %4g | %-15s | %7.4f | %7.4f | %6.4f | %6.3f | %6.3f | %8.4f |\n",
                scene.c_str(), rate, method.c_str(), rmse, metrics.relmse, metrics.ssim,
                metrics.mean_ratio, metrics.border_step, metrics.negative_share);
  return text.data();
}

/// Each value once, in the order in which they appear.
template <class Field>
auto distinct(std::span<const Result> results, Field Result::*field) {
  std::vector<Field> values;
  for (const Result& result : results) {
    if (std::find(values.begin(), values.end(), result.*field) == values.end()) {
      values.push_back(result.*field);
    }
  }
  return values;
}

double farther_from_one(double a, double b) { return std::abs(a - 1) > std::abs(b - 1) ? a : b; }

}  // namespace

std::string noise_table(std::span<const Result> results) {
  const std::vector<std::string> all_scenes = distinct(results, &Result::scene);
  const std::vector<std::string> all_methods = distinct(results, &Result::method);
  const std::vector<double> all_rates = distinct(results, &Result::rate);
  const auto find = [&](const std::string& scene, double rate, const std::string& method) {
    const auto found = std::find_if(results.begin(), results.end(), [&](const Result& result) {
      return result.scene == scene && result.rate == rate && result.method == method;
    });
    return found == results.end() ? nullptr : &*found;
  };
  std::string text =
      "| scene      |  spp | method          |    RMSE |  relMSE |   SSIM |   mean | border | "
      "negative |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& scene : all_scenes) {
    for (const double rate : all_rates) {
      for (const std::string& method : all_methods) {
        const Result* result = find(scene, rate, method);
        if (result != nullptr)
          text += line_of(scene, rate, method, own_rmse(*result), result->metrics);
      }
    }
  }
  for (const double rate : all_rates) {
    for (const std::string& method : all_methods) {
      Metrics over_all{.mean_ratio = 1};
      double logarithms = 0, count = 0;
      for (const std::string& scene : all_scenes) {
        const Result* result = find(scene, rate, method);
        const Result* first = find(scene, rate, all_methods.front());
        if (result == nullptr || first == nullptr) continue;
        count += 1;
        logarithms += std::log(own_rmse(*result) / own_rmse(*first));
        over_all.relmse += result->metrics.relmse;
        over_all.ssim += result->metrics.ssim;
        over_all.mean_ratio = farther_from_one(result->metrics.mean_ratio, over_all.mean_ratio);
        over_all.border_step = std::max(result->metrics.border_step, over_all.border_step);
        over_all.negative_share = std::max(result->metrics.negative_share, over_all.negative_share);
      }
      if (count == 0) continue;
      over_all.relmse /= count;
      over_all.ssim /= count;
      text += line_of("all", rate, method, std::exp(logarithms / count), over_all);
    }
  }
  return text;
}

}  // namespace quality
