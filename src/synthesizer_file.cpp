// SPDX-License-Identifier: MIT
#include "freqsynth/synthesizer_file.h"

#include <string>

#include "basis/file_access.h"
#include "freqsynth/basis/byte_stream.h"

namespace freqsynth {

void save_file(const std::string& file, const Synthesizer& synthesizer) {
  detail::write_file(
      file, [&](ByteSink sink) { synthesizer.save(sink); }, true);
}

Synthesizer load_synthesizer(const std::string& file, const SynthesisSettings& settings) {
  return detail::read_file(file, [&](ByteSource source) { return Synthesizer(settings, source); });
}

}  // namespace freqsynth
