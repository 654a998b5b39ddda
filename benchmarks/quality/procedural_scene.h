// SPDX-License-Identifier: MIT
/// \file
/// Pictures that are made by a formula, of kinds that the scenes do not have.
#pragma once

#include <memory>
#include <string_view>

#include "scenes/scene.h"

namespace quality {

/// Makes one of
///
/// * `plasma`   fractal noise in seven flat colours: smooth borders of every curvature
/// * `clouds`   fractal noise as it is, down to a sixth of a block
/// * `strokes`  lines of dark strokes and bows on paper, like text
/// * `leaves`   ellipses of all sizes that cover each other, some of them ribbed
/// * `cells`    stained glass: flat cells between dark lines
/// * `weave`    a cloth: threads in two directions that bend, 2 to 20 pixels apart
///
/// for an image of so many pixels; lengths are in 256ths of its width, but those of `weave`.
/// \return null for another name
[[nodiscard]] std::unique_ptr<scenes::Scene> make_procedural(std::string_view name, int width,
                                                             int height);

}  // namespace quality
