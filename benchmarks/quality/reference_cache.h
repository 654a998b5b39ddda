// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "quality/reference.h"

namespace quality {

/// The reference from the folder's files, or rendered and written there. Files are named after the
/// scene, all settings, and the fingerprint of the radiance function: a scene whose code or picture
/// changes gets a new reference. A file that cannot be read is made anew.
/// \param folder  made unless it exists; empty: nothing is kept
/// \throws std::runtime_error naming a file that cannot be written.
[[nodiscard]] Reference cached_reference(const std::string& folder, const std::string& scene,
                                         const baselines::Radiance& radiance,
                                         const PixelAverage& exact,
                                         const ReferenceSettings& settings,
                                         freqsynth::ThreadPool& pool,
                                         const std::function<void(double)>& progress);

}  // namespace quality
