// SPDX-License-Identifier: MIT
// Loads a saved engine and goes on with it. The first byte chooses the settings.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "fuzz/fuzz_input.h"
#include "fuzz/fuzz_syntheses.h"
#include "support/random_synthesis.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::vector<helpers::RandomSynthesis> all = fuzz::syntheses();
  const helpers::RandomSynthesis& synthesis = all[(data[0] & 0x7fu) % all.size()];
  std::optional<freqsynth::Synthesizer> engine;
  try {
    engine.emplace(synthesis.settings, fuzz::archive_of({data, size}));
  } catch (const std::runtime_error&) {
    return 0;
  }
  // It is an engine like any other, which can be saved in turn.
  const std::vector<std::byte> saved = engine->save();
  const freqsynth::Synthesizer again(synthesis.settings, saved);
  fuzz::require(again.save() == saved);
  engine->set_stop({});
  helpers::RandomHost host(synthesis, 1);
  for (int step = 0; step < 12; ++step) host.step(*engine);
  static_cast<void>(engine->image());
  static_cast<void>(engine->bad_samples());
  // This takes most of the time.
  if (freqsynth::detail::crc32c(0, saved) % 8 != 0) return 0;
  static_cast<void>(engine->finished_image());
  static_cast<void>(engine->error_image());
  static_cast<void>(engine->predicted_rmse());
  return 0;
}
