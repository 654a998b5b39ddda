// SPDX-License-Identifier: MIT
#pragma once

#include "options.h"
#include "scenes/scene.h"

/// Renders by adaptive synthesis and writes all that the options name; after noted_interrupt(), of
/// what there is by then.
/// \return whether it came to its end, and was not interrupted
/// \throws std::runtime_error naming the file and the reason when one cannot be written.
bool synthesize(const Options& options, const scenes::Scene& scene);

/// Makes the folder of the frames, and sees that they can be written there.
/// \throws std::runtime_error naming the file and the reason.
void prepare_frames(const Options& options);
