// SPDX-License-Identifier: MIT
// Loads a saved frequency image.
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "freqsynth/image/frequency_image.h"
#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::vector<std::byte> bytes = fuzz::archive_of({data, size});
  freqsynth::FrequencyImage image;
  try {
    image = freqsynth::FrequencyImage::load(bytes);
  } catch (const std::runtime_error&) {
    return 0;
  }
  // There is one way to say it.
  fuzz::require(image.save() == bytes);
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      static_cast<void>(image.samples(x, y));
      fuzz::require(image.coefficients(x, y, image.channels() - 1).size() == freqsynth::max_terms);
    }
  }
  return 0;
}
