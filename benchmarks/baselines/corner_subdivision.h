// SPDX-License-Identifier: MIT
/// \file
/// The recursive antialiasing of POV-Ray.
#pragma once

#include "rendering.h"

namespace baselines {

struct CornerSubdivisionSettings {
  /// A square is divided where two of its corners differ by more than this, summed over red, green
  /// and blue. > 0.
  float threshold = 0.3f;
  /// How often a pixel's side is halved at most, from 0 to 8: 3 are 9 x 9 points in a pixel.
  unsigned depth = 3;
  /// Radiance above which differences do not count. > 0.
  float white = 1;
};

/// Method 2 of POV-Ray (User Documentation, Antialias), with its default threshold and depth:
/// samples at the corners of pixels, shared by neighbours; a square whose corners differ is divided
/// into four. A pixel is the mean of its parts, of which an undivided one is the mean of its
/// corners.
///
/// POV-Ray goes from pixel to pixel and takes what it takes. Here all pixels are divided once, then
/// all quarters, and where the samples do not suffice for all squares of a size, those of the
/// greatest difference come first: it takes the samples allowed or fewer. When they do not suffice
/// for the corners of the pixels they are taken on a regular grid and averaged. Left out: the
/// displacement of points at random, and gamma.
[[nodiscard]] Rendering corner_subdivision(const Radiance& radiance, const Job& job,
                                           const CornerSubdivisionSettings& settings = {});

}  // namespace baselines
