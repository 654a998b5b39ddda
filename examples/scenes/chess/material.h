// SPDX-License-Identifier: MIT
/// \file
/// What surfaces are made of.
#pragma once

#include "../vec3.h"

namespace scenes::chess {

/// A coloured, diffuse base under a clear lacquer.
struct Material {
  Vec3 color;          ///< share of the light that the base scatters, 0..1
  double reflectance;  ///< share that the lacquer mirrors when seen straight on, 0..1
  double highlight;    ///< brightness of the lights' mirror images
  double shininess;    ///< exponent of the highlights: the higher, the smaller they are
};

}  // namespace scenes::chess
