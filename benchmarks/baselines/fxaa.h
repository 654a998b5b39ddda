// SPDX-License-Identifier: MIT
/// \file
/// An edge filter of games.
#pragma once

#include <cstddef>

#include "rendering.h"

namespace baselines {

struct FxaaSettings {
  /// Least contrast, relative to the brightest neighbour, that counts as an edge (of luma).
  float edge_threshold = 0.125f;
  /// Least contrast at all that does (of luma).
  float edge_threshold_min = 0.0625f;
  /// How strongly a pixel that differs from all around it is smoothed, in [0, 1].
  float subpixel = 0.75f;
  /// How far the end of an edge is looked for, in pixels.
  std::size_t search = 26;
};

/// The filter alone, after Lottes, FXAA 3.11 Quality, 2011. Where the luma of a pixel and its four
/// neighbours has contrast, the side of the pixel on which the edge lies is found, and the edge is
/// followed in both directions to its ends. The nearer end tells by how much of the neighbour
/// beyond the edge the pixel is covered, and as much of it is mixed in; more where the pixel stands
/// out of its 3 x 3 neighbours.
///
/// Luma is the root of the luminance, clamped to [0, 1], as a display would be sent it; radiances
/// are mixed as they are, as light. Left out: the steps that grow with the distance (here each is a
/// pixel), and the presets. Beyond the border of the picture its last pixels go on.
[[nodiscard]] Rendering fxaa_filtered(const Rendering& picture, const FxaaSettings& settings = {});

/// fxaa_filtered() of one sample in the middle of each pixel; of the mean of a regular grid where
/// there are more samples. Takes exactly the samples allowed.
[[nodiscard]] Rendering fxaa(const Radiance& radiance, const Job& job,
                             const FxaaSettings& settings = {});

}  // namespace baselines
