// SPDX-License-Identifier: MIT
// Reads a JPEG file.
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "freqsynth/jpeg/jpeg.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    freqsynth::QuantizedImage image =
        freqsynth::decode_jpeg({data, size}, {.pixels = 1 << 20, .bytes = 1 << 20, .scans = 20});
    image.validate();
  } catch (const std::runtime_error&) {
  }
  return 0;
}
