// SPDX-License-Identifier: MIT
#pragma once

#include "options.h"
#include "scenes/scene.h"

/// Renders by adaptive synthesis and writes all that the options name.
/// \throws std::runtime_error naming the file and the reason when one cannot be written.
void synthesize(const Options& options, const scenes::Scene& scene);

/// Makes the folder of the frames, and sees that they can be written there.
/// \throws std::runtime_error naming the file and the reason.
void prepare_frames(const Options& options);
