// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "members.h"

namespace field_cases {
namespace {

// What pixels wholly outside a lamp show, as f(pixel) summed or the greatest.
double outside(const Picture& picture, const Disc& disc, bool greatest,
               const std::function<double(double)>& f) {
  double result = 0;
  for (std::size_t j = 0; j < picture.height; ++j) {
    for (std::size_t i = 0; i < picture.width; ++i) {
      if (disc.average(static_cast<double>(i), static_cast<double>(j)) > 1e-9) continue;
      const double v = f(picture.at(i, j));
      result = greatest ? std::max(result, v) : result + v;
    }
  }
  return result;
}

std::vector<Figure> lamp_figures(const Lamp& lamp, double rate) {
  const Field field = lamp.field();
  const Sampler sampler = sampler_of(field);
  const auto figure = [&](const char* what, double right, const Measure& measure) {
    return Figure{what, right, over_seeds(sampler, settings_of(64, 64), rate, measure),
                  over_jittered(sampler, 64, 64, 1, rate, measure)};
  };
  const auto off = [&](double v) { return std::abs(v - lamp.level); };
  double all = 0;
  for (const double v : right_pixels(field)) all += v;
  return {
      figure("pixels outside that are off by more than 0.05", 0,
             [&](const Picture& p) {
               return outside(p, lamp.disc, false,
                              [&](double v) { return off(v) > 0.05 ? 1.0 : 0.0; });
             }),
      figure("greatest error outside", 0,
             [&](const Picture& p) { return outside(p, lamp.disc, true, off); }),
      figure("negative pixels", 0,
             [](const Picture& p) {
               return static_cast<double>(
                   std::count_if(p.pixels.begin(), p.pixels.end(), [](float v) { return v < 0; }));
             }),
      figure("share of all light", 1, [&](const Picture& p) { return mean(p) * 64 * 64 / all; })};
}

}  // namespace

Kind halos() {
  Kind kind{"K11",
            "The light of a lamp in dark pixels beside it",
            "A disc of radius 9.7 and great radiance on 0.1. Pixels wholly outside the disc must "
            "stay at 0.1, and nothing may become negative.",
            {}};
  for (const auto& [radiance, name] : {std::pair{10.0, "10"}, {1e3, "1e3"}, {1e5, "1e5"}}) {
    const Lamp lamp{{31.3, 33.1, 9.7}, radiance};
    kind.cases.push_back({std::string("V17.lamp") + name,
                          std::string("lamp of radiance ") + name,
                          {1, 4, 16},
                          [lamp](double rate) { return lamp_figures(lamp, rate); }});
  }
  kind.cases.push_back({"K11.lamps", "32 random lamps, means", {1, 4, 16}, [](double rate) {
                          std::vector<Figure> sums;
                          for (std::uint64_t number = 1; number <= 32; ++number) {
                            const Lamp lamp = random_lamp(table_seed, number);
                            std::vector<Figure> figures = lamp_figures(lamp, rate);
                            // Lamps differ by orders of magnitude.
                            figures[1].what = "greatest error outside / radiance";
                            figures[1].now /= lamp.radiance;
                            figures[1].jittered /= lamp.radiance;
                            if (sums.empty()) {
                              sums = figures;
                              continue;
                            }
                            for (std::size_t k = 0; k < sums.size(); ++k) {
                              sums[k].now += figures[k].now;
                              sums[k].jittered += figures[k].jittered;
                            }
                          }
                          for (Figure& sum : sums) {
                            sum.now /= 32;
                            sum.jittered /= 32;
                          }
                          return sums;
                        }});
  return kind;
}

}  // namespace field_cases
