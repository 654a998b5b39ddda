// SPDX-License-Identifier: MIT
#include "methods.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "alpha_trimmed.h"
#include "corner_subdivision.h"
#include "dippe_wold.h"
#include "energy_preserving.h"
#include "feature_regression.h"
#include "fxaa.h"
#include "low_discrepancy.h"
#include "non_local_means.h"
#ifdef FREQSYNTH_BASELINES_OPENCV
#include "opencv_fsr.h"
#endif
#include "painter_sloan.h"
#include "supersampling.h"
#include "two_level.h"
#include "whitted.h"

namespace baselines {
namespace {

auto supersample(bool jittered, PixelFilter filter) {
  return [=](const Radiance& radiance, const Job& job) {
    return supersampling(radiance, job, {.jittered = jittered, .filter = filter});
  };
}

std::vector<Method> make_methods() {
  const auto jittered_box = supersample(true, PixelFilter::box);
  return {
      {"uniform-box", "regular grid, mean of the pixel", "Whitted 1980",
       supersample(false, PixelFilter::box)},
      {"jittered-box", "jittered grid, mean of the pixel", "Cook 1986", jittered_box},
      {"rotated-grid", "the same rank-1 lattice in each pixel, mean of the pixel",
       "Korobov 1959, Akenine-Moller and Strom 2003", rotated_grid},
      {"sobol-box", "Sobol points, Owen-scrambled in each pixel, mean of the pixel",
       "Sobol 1967, Owen 1995", sobol_box},
      {"jittered-tent", "jittered grid, weighted average, tent 2 pixels wide", "Cook 1986",
       supersample(true, PixelFilter::tent)},
      {"jittered-gaussian", "jittered grid, weighted average, Gaussian 3 pixels wide", "Cook 1986",
       supersample(true, PixelFilter::gaussian)},
      {"jittered-mitchell", "jittered grid, weighted average, cubic 4 pixels wide",
       "Mitchell and Netravali 1988", supersample(true, PixelFilter::mitchell_netravali)},
      {"whitted", "squares divided by the contrast of their corners", "Whitted 1980",
       [](const Radiance& radiance, const Job& job) { return whitted(radiance, job); }},
      {"pov-method-2", "pixels divided while the colours of corners differ, mean of corners",
       "POV-Ray 1991",
       [](const Radiance& radiance, const Job& job) { return corner_subdivision(radiance, job); },
       // The corners of pixels are a few more than the pixels.
       1.25},
      {"two-level-box", "more samples where contrast is high, mean of the pixel",
       "Cook 1986, Mitchell 1987",
       [](const Radiance& radiance, const Job& job) { return two_level(radiance, job); }},
      {"two-level-multistage", "more samples where contrast is high, multi-stage filter",
       "Mitchell 1987",
       [](const Radiance& radiance, const Job& job) {
         return two_level(radiance, job, {.multi_stage = true});
       }},
      {"painter-sloan", "tree of samples refined by variance and area, exact mean of its cells",
       "Painter and Sloan 1989",
       [](const Radiance& radiance, const Job& job) { return painter_sloan(radiance, job); }},
      {"dippe-wold", "jittered grid, filter width by local signal to noise ratio",
       "Dippe and Wold 1985",
       [](const Radiance& radiance, const Job& job) { return dippe_wold(radiance, job); }},
      {"fxaa", "centred samples, then a filter that follows edges", "Lottes 2011",
       [](const Radiance& radiance, const Job& job) { return fxaa(radiance, job); }, 1},
      {"jittered-alpha-trimmed", "jittered-box, then a filter that discards outliers",
       "Lee and Redner 1990",
       [=](const Radiance& radiance, const Job& job) {
         return alpha_trimmed(jittered_box(radiance, job));
       }},
      {"jittered-energy-preserving", "jittered-box, then a filter that spreads outliers",
       "Rushmeier and Ward 1994",
       [=](const Radiance& radiance, const Job& job) {
         return energy_preserving(jittered_box(radiance, job));
       }},
      {"nlm", "sobol-box, then non-local means with the variance of pixels; for noise",
       "Rousselle et al. 2012",
       [](const Radiance& radiance, const Job& job) { return non_local_means(radiance, job); }, 1,
       true},
      {"nfor", "sobol-box, then regression on features of surfaces; for noise",
       "Bitterli et al. 2016",
       [](const Radiance& radiance, const Job& job) { return feature_regression(radiance, job); },
       1, true},
#ifdef FREQSYNTH_BASELINES_OPENCV
      {"opencv-fsr", "below 1 sample per pixel: the other pixels filled in by OpenCV's FSR, fast",
       "Seiler et al. 2015, Genser et al. 2018",
       [](const Radiance& radiance, const Job& job) { return opencv_fsr(radiance, job); }},
#endif
  };
}

}  // namespace

std::span<const Method> methods() {
  static const std::vector<Method> all = make_methods();
  return all;
}

const Method& find_method(std::span<const Method> all, std::string_view name) {
  std::string known;
  for (const Method& each : all) {
    if (each.name == name) return each;
    known.append(known.empty() ? "" : ", ").append(each.name);
  }
  std::string said = "unknown method '";
  throw std::invalid_argument(said.append(name).append("' (known are ").append(known).append(")"));
}

const Method& method(std::string_view name) { return find_method(methods(), name); }

}  // namespace baselines
