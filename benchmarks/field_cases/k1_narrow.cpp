// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <utility>

#include "case.h"
#include "members.h"

namespace field_cases {
namespace {

// sin(0.9 y + 2.2 x) > 0.
Field bars(std::size_t width, std::size_t height) {
  Field field = product_field("bars", width, height, 0, {});
  const double turn = 2 * std::numbers::pi;
  return plus(std::move(field), 1, BarGrating{2.2 / turn, 0.9 / turn, 0, 0.5});
}

Case columns_case(std::size_t width) {
  const std::string name = std::to_string(width) + " x 128: last block's columns";
  return {"V3.last" + std::to_string(width), name, {1, 4}, [width](double rate) {
            const std::size_t last = (width - 1) / 8 * 8;
            const Field field = bars(width, 128);
            Figure figure = rmse_figure(field, rate, {last, width});
            Figure rest = rmse_figure(field, rate, {0, last});
            rest.what = "RMSE of the other columns";
            return std::vector{figure, rest};
          }};
}

// What an image asks for.
struct Asked {
  double calls = 0;
  double again = 0;    // calls at points that were asked before
  double names = 0;    // ids
  double outside = 0;  // points outside the image
};

Asked ask(std::size_t width, std::size_t height, double rate) {
  std::set<std::pair<double, double>> points;
  std::set<std::uint64_t> ids;
  Asked asked;
  const auto w = static_cast<double>(width);
  const auto h = static_cast<double>(height);
  const Sampler sampler = [&](double x, double y, std::uint64_t id, std::span<float> values) {
    ++asked.calls;
    asked.again += !points.insert({x, y}).second;
    asked.names += ids.insert(id).second;
    asked.outside += !(x >= 0 && x <= w && y >= 0 && y <= h);
    values[0] = static_cast<float>(std::sin(0.9 * y + 2.2 * x));
  };
  (void)synthesize(sampler, settings_of(width, height), rate, 1);
  return asked;
}

Case twice_case(std::size_t width, std::size_t height, std::vector<double> rates) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  return {"V2." + std::to_string(width) + "x" + std::to_string(height), size, std::move(rates),
          [width, height](double rate) {
            const Asked asked = ask(width, height, rate);
            return std::vector<Figure>{
                {"points asked again, percent", 0, 100 * asked.again / asked.calls, 0},
                {"ids more than points", 0, asked.names - (asked.calls - asked.again), 0},
                {"points outside", 0, asked.outside, 0}};
          }};
}

// All sizes from 1 x 1 to 17 x 17.
Case all_sizes_case() {
  return {"V2.sizes", "1 x 1 to 17 x 17, all together", {1, 4, 16}, [](double rate) {
            Asked all;
            for (std::size_t width = 1; width <= 17; ++width) {
              for (std::size_t height = 1; height <= 17; ++height) {
                const Asked asked = ask(width, height, rate);
                all.calls += asked.calls;
                all.again += asked.again;
                all.names += asked.names;
                all.outside += asked.outside;
              }
            }
            return std::vector<Figure>{
                {"points asked again, percent", 0, 100 * all.again / all.calls, 0},
                {"ids more than points", 0, all.names - (all.calls - all.again), 0},
                {"points outside", 0, all.outside, 0}};
          }};
}

}  // namespace

Kind narrow_images() {
  Kind kind{"K1",
            "Blocks that reach beyond the image",
            "Images are cut into blocks of 8 x 8 pixels. Where the width or the height is no "
            "multiple of 8 the last blocks reach beyond the image. What must not happen: points "
            "asked twice, and last columns that are worse than the others.",
            {}};
  for (const bool wide : {false, true}) {
    const std::size_t width = wide ? 1000 : 1;
    const std::size_t height = wide ? 1 : 1000;
    const Steps low = between(0, 0.3);
    const Field field = product_field("step", width, height, 0,
                                      {{1, wide ? always() : low, wide ? low : always()}});
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    kind.cases.push_back({wide ? "V1.wide" : "V1.tall",
                          size + ": 1 in the first 0.3 of the pixel",
                          {1, 4, 16},
                          [field](double rate) {
                            const auto settings = settings_of(field.width, field.height);
                            const Sampler sampler = sampler_of(field);
                            Figure level{"mean", 0.3};
                            level.now = over_seeds(sampler, settings, rate, mean);
                            level.jittered =
                                over_jittered(sampler, field.width, field.height, 1, rate, mean);
                            return std::vector{level, rmse_figure(field, rate)};
                          }});
  }
  kind.cases.push_back(twice_case(1, 1, {4}));
  kind.cases.push_back(twice_case(4, 4, {4}));
  kind.cases.push_back(twice_case(1, 1000, {4}));
  kind.cases.push_back(twice_case(1000, 1, {4}));
  kind.cases.push_back(twice_case(9, 9, {1}));
  kind.cases.push_back(twice_case(13, 13, {4}));
  kind.cases.push_back(twice_case(33, 33, {1, 4}));
  kind.cases.push_back(twice_case(60, 60, {1, 4}));
  kind.cases.push_back(twice_case(65, 64, {1, 4}));
  kind.cases.push_back(twice_case(64, 64, {1, 4}));
  kind.cases.push_back(all_sizes_case());
  kind.cases.push_back(members_case("K1.narrow", "32 random functions, 1 to 17 pixels wide or high",
                                    random_narrow, 32, {1, 4, 16}));
  for (const std::size_t width : {1u, 2u, 3u, 4u, 8u, 9u, 10u, 16u}) {
    kind.cases.push_back(rmse_case("V3.strip" + std::to_string(width),
                                   std::to_string(width) + " x 400: slanted bars", bars(width, 400),
                                   {4}));
  }
  for (const std::size_t width : {9u, 121u, 124u, 127u, 128u})
    kind.cases.push_back(columns_case(width));
  return kind;
}

}  // namespace field_cases
