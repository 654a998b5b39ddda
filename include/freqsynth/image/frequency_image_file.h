// SPDX-License-Identifier: MIT
/// \file
/// Frequency images in files. Part of the compiled library only, and not of freqsynth.h.
#pragma once

#if defined(FREQSYNTH_HEADER_ONLY)
#error \
    "freqsynth/image/frequency_image_file.h: files need the compiled library, \
freqsynth::freqsynth; header-only, write the bytes of FrequencyImage::save() yourself"
#endif

#include <string>

#include "freqsynth/basis/config.h"
#include "freqsynth/image/frequency_image.h"

namespace freqsynth {

/// FrequencyImage::save() into a file. A file of that name is replaced when all is written and is
/// on the disk, and keeps its content until then and on any failure; devices and pipes are written
/// directly.
/// \throws std::runtime_error naming the file and the system's reason when it cannot be written.
FREQSYNTH_API void save_file(const std::string& file, const FrequencyImage& image);

/// FrequencyImage::load() of a file.
/// \throws std::runtime_error naming the file and the reason, std::bad_alloc.
[[nodiscard]] FREQSYNTH_API FrequencyImage load_frequency_image(const std::string& file);

}  // namespace freqsynth
