// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "case.h"
#include "members.h"
#include "named_fields.h"

namespace field_cases {
namespace {

constexpr std::uint64_t places = 200;

// The share of a disc's light that is in the picture, near the disc.
double light(const Picture& picture, const Disc& disc, const Field& without, double radiance) {
  double sum = 0;
  const double reach = disc.radius + 2;
  for (std::size_t j = 0; j < picture.height; ++j) {
    for (std::size_t i = 0; i < picture.width; ++i) {
      const double x = static_cast<double>(i);
      const double y = static_cast<double>(j);
      if (std::hypot(x + 0.5 - disc.x, y + 0.5 - disc.y) > reach) continue;
      sum += picture.at(i, j) - without.average(x, y);
    }
  }
  return sum / (std::numbers::pi * disc.radius * disc.radius * radiance);
}

// Of discs at random places: how many are missed, and how much of their light is there.
Case discs_case(double radius, int busy, std::vector<double> rates) {
  static const char* const beside[] = {"alone", "beside stripes", "beside slanted bars",
                                       "beside turning bars", "beside a fine checker"};
  std::string size = std::to_string(radius).substr(0, 3);
  return {
      "V9.disc" + size + "." + std::to_string(busy), "disc of radius " + size + " " + beside[busy],
      std::move(rates), [radius, busy](double rate) {
        double missed = 0, jittered_missed = 0, found = 0, jittered_found = 0;
        const Field dark = product_field("dark", 128, 64, 0, {});
        for (std::uint64_t number = 1; number <= places; ++number) {
          const LostDisc member = random_disc(table_seed, number, radius, busy);
          const Sampler sampler = sampler_of(member.field);
          const double share =
              light(synthesize(sampler, settings_of(128, 64), rate, number % synthesis_seeds + 1),
                    member.disc, dark, 1);
          const double of_jittered =
              light(jittered(sampler, 128, 64, 1, samples_at(rate, 128, 64), number), member.disc,
                    dark, 1);
          missed += share < 0.02;
          jittered_missed += of_jittered < 0.02;
          found += share;
          jittered_found += of_jittered;
        }
        const double percent = 100.0 / static_cast<double>(places);
        return std::vector<Figure>{
            {"missed, percent of 200 places", 0, percent * missed, percent * jittered_missed},
            {"mean share of its light", 1, found / places, jittered_found / places}};
      }};
}

Case lamp_case(double radiance, const std::string& name) {
  return {"V10.lamp" + name,
          "disc of radius 1.2 and radiance " + name + " on a ramp",
          {1, 4},
          [radiance](double rate) {
            const Field without = ramp_and_busy_corner();
            const Disc disc{40.3, 50.7, 1.2};
            const Sampler sampler = sampler_of(plus(without, radiance, disc));
            const Measure share = [&](const Picture& p) {
              return light(p, disc, without, radiance);
            };
            Figure figure{"share of its light", 1};
            figure.now = over_seeds(sampler, settings_of(256, 256), rate, share);
            figure.jittered = over_jittered(sampler, 256, 256, 1, rate, share);
            return std::vector{figure};
          }};
}

}  // namespace

Kind small_features() {
  Kind kind{
      "K4",
      "Small things in flat parts, while something else is busy",
      "A disc about as large as a pixel lies in a flat half of the picture; the other half is "
      "busy and takes the samples. A disc counts as missed when less than 2 percent of its "
      "light is in the picture. Places are random.",
      {}};
  for (const double radius : {0.8, 1.2, 2.0}) {
    kind.cases.push_back(discs_case(radius, 0, {1}));
    kind.cases.push_back(discs_case(radius, 1, {0.25, 1, 4}));
  }
  kind.cases.push_back(discs_case(0.4, 1, {4}));
  for (const int busy : {2, 3, 4}) {
    for (const double radius : {0.8, 1.2}) kind.cases.push_back(discs_case(radius, busy, {1}));
  }
  kind.cases.push_back(lamp_case(10, "10"));
  kind.cases.push_back(lamp_case(1e3, "1e3"));
  kind.cases.push_back(lamp_case(1e9, "1e9"));
  return kind;
}

}  // namespace field_cases
