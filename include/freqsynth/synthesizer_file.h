// SPDX-License-Identifier: MIT
/// \file
/// Engines in files, to go on after an interruption. Part of the compiled library only, and not of
/// freqsynth.h.
#pragma once

#if defined(FREQSYNTH_HEADER_ONLY)
#error \
    "freqsynth/synthesizer_file.h: files need the compiled library, freqsynth::freqsynth; \
header-only, write the bytes of Synthesizer::save() yourself"
#endif

#include <string>

#include "freqsynth/basis/config.h"
#include "freqsynth/synthesizer.h"

namespace freqsynth {

/// Synthesizer::save() into a file. A file of that name is replaced when all is written and is on
/// the disk, and keeps its content until then and on any failure, a crash of the system included;
/// devices and pipes are written directly. Other members of the engine wait meanwhile.
/// \throws std::runtime_error naming the file and the system's reason when it cannot be written.
FREQSYNTH_API void save_file(const std::string& file, const Synthesizer& synthesizer);

/// Goes on where one was saved: a Synthesizer from the file's bytes and the settings that it was
/// made with.
/// \throws std::runtime_error naming the file and the reason; what the constructor throws else.
[[nodiscard]] FREQSYNTH_API Synthesizer load_synthesizer(const std::string& file,
                                                         const SynthesisSettings& settings);

}  // namespace freqsynth
