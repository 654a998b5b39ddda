// SPDX-License-Identifier: MIT
/// \file
/// Adaptive progressive refinement by a tree of samples.
#pragma once

#include <functional>

#include "sampler.h"

namespace baselines {

struct PainterSloanSettings {
  /// Standard deviation of the radiance that a node is taken to have at least: the weight of
  /// coverage against that of edges. > 0; the greater, the more even the samples.
  double coverage = 0.05;
  /// Radiance above which differences do not count, because a display does not show them. > 0.
  float white = 1;
};

/// Called with each cell and the radiance of its sample.
using VisitCell = std::function<void(const Rectangle& cell, const Rgb& radiance)>;

/// Painter and Sloan, Antialiased Ray Tracing by Adaptive Progressive Refinement, 1989: a k-d tree
/// whose leaves are cells with one sample each, at a random position. Each further sample descends
/// from the root; the leaf that it reaches is halved across its longer side and the sample is taken
/// in the half that has none.
///
/// At each node the branch is chosen whose next sample is expected to reduce the squared error of
/// the picture most: the error of a leaf is its squared area times the variance around it, that of
/// a node is the sum of its leaves', and it falls in inverse proportion to the number of samples.
/// So the choice depends on variance, area, number of samples and level as the authors ask: the
/// variance of `coverage` is added to a leaf's and multiplied by its area where that is more than a
/// pixel, so that in the upper levels of the tree coverage decides, and variance in the lower.
///
/// The picture is constant in each cell; a pixel is its exact mean (a box filter). Takes exactly
/// the samples allowed.
[[nodiscard]] Rendering painter_sloan(const Radiance& radiance, const Job& job,
                                      const PainterSloanSettings& settings = {});

/// The same, and visits all cells at the end. They tile the image.
[[nodiscard]] Rendering painter_sloan(const Radiance& radiance, const Job& job,
                                      const PainterSloanSettings& settings, const VisitCell& visit);

}  // namespace baselines
