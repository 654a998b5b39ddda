// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "case.h"

namespace field_cases {

Kind halos() {
  Kind kind{"K11",
            "The light of a lamp in dark pixels beside it",
            "A disc of radius 9.7 and great radiance on 0.1. Pixels wholly outside the disc must "
            "stay at 0.1, and nothing may become negative.",
            {}};
  for (const auto& [radiance, name] : {std::pair{10.0, "10"}, {1e3, "1e3"}, {1e5, "1e5"}}) {
    kind.cases.push_back(
        {std::string("V17.lamp") + name,
         std::string("lamp of radiance ") + name,
         {1, 4, 16},
         [radiance = radiance](double rate) {
           const Disc disc{31.3, 33.1, 9.7};
           const Field field = plus(product_field("lamp", 64, 64, 0.1, {}), radiance - 0.1, disc);
           const Sampler sampler = sampler_of(field);
           const auto settings = settings_of(64, 64);
           const auto over_outside = [&](const std::function<double(double)>& f, bool greatest) {
             return [&disc, f, greatest](const Picture& p) {
               double result = 0;
               for (std::size_t j = 0; j < p.height; ++j) {
                 for (std::size_t i = 0; i < p.width; ++i) {
                   if (disc.average(double(i), double(j)) > 1e-9) continue;
                   const double v = f(p.at(i, j));
                   result = greatest ? std::max(result, v) : result + v;
                 }
               }
               return result;
             };
           };
           const auto figure = [&](const char* what, const Measure& measure) {
             return Figure{what, 0, over_seeds(sampler, settings, rate, measure),
                           over_jittered(sampler, 64, 64, 1, rate, measure)};
           };
           const auto off = [](double v) { return std::abs(v - 0.1); };
           const Measure negative = [](const Picture& p) {
             double count = 0;
             for (const float v : p.pixels) count += v < 0;
             return count;
           };
           const Measure share = [m = mean, right = right_pixels(field)](const Picture& p) {
             double sum = 0;
             for (const double v : right) sum += v;
             return m(p) * static_cast<double>(right.size()) / sum;
           };
           Figure light = figure("share of all light", share);
           light.right = 1;
           return std::vector{
               figure("pixels outside that are off by more than 0.05",
                      over_outside([=](double v) { return off(v) > 0.05 ? 1.0 : 0.0; }, false)),
               figure("greatest error outside", over_outside(off, true)),
               figure("negative pixels", negative), light};
         }});
  }
  return kind;
}

}  // namespace field_cases
