// SPDX-License-Identifier: MIT
// Writes the seeds of the fuzzing targets into a folder: fuzz_seeds FOLDER.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/image/frequency_image.h"
#include "freqsynth/synthesizer.h"
#include "fuzz/fuzz_syntheses.h"
#include "support/random_synthesis.h"
#if defined(FREQSYNTH_HAS_JPEG)
#include "freqsynth/jpeg/jpeg.h"
#endif

namespace {

namespace fs = std::filesystem;

int written = 0;

void write(const fs::path& folder, int first, std::span<const std::byte> bytes) {
  fs::create_directories(folder);
  std::ofstream file(folder / std::to_string(written++), std::ios::binary);
  if (first >= 0) file.put(static_cast<char>(first));
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write into " + folder.string());
}

void write_syntheses(const fs::path& folder) {
  const std::vector<helpers::RandomSynthesis> all = fuzz::syntheses();
  for (std::size_t i = 0; i < all.size(); ++i) {
    freqsynth::Synthesizer engine(all[i].settings);
    helpers::RandomHost host(all[i], 1);
    for (int step = 0; step < 60; ++step) {
      if (step % 20 == 7) write(folder / "synthesis", static_cast<int>(i | 0x80u), engine.save());
      host.step(engine);
    }
    write(folder / "synthesis", static_cast<int>(i), engine.save());
    write(folder / "frequency_image", 0x80, engine.image().save());
  }
  write(folder / "frequency_image", 0, freqsynth::FrequencyImage().save());
}

#if defined(FREQSYNTH_HAS_JPEG)
void write_jpegs(const fs::path& folder) {
  for (int kind = 0; kind < 12; ++kind) {
    freqsynth::QuantizedImage image;
    image.width = static_cast<std::size_t>(5 + 7 * kind);
    image.height = static_cast<std::size_t>(30 - 2 * kind);
    image.tables.resize(1);
    for (auto& step : image.tables[0]) step = static_cast<std::uint16_t>(1 + kind);
    const int components = kind % 2 == 0 ? 1 : 3;
    for (int c = 0; c < components; ++c) {
      freqsynth::QuantizedComponent one;
      const std::size_t unit = 8;
      one.blocks_x = (image.width + unit - 1) / unit;
      one.blocks_y = (image.height + unit - 1) / unit;
      for (std::size_t i = 0; i < one.blocks_x * one.blocks_y * 64; ++i) {
        one.values.push_back(static_cast<std::int16_t>((i * i) % 37 / (1 + i % 64)));
      }
      image.components.push_back(one);
    }
    const std::vector<std::uint8_t> bytes =
        freqsynth::encode_jpeg(image, {.progressive = kind % 3 == 0, .optimize = kind % 4 == 0});
    write(folder / "jpeg", -1, std::as_bytes(std::span(bytes)));
  }
}
#endif

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  try {
    write_syntheses(arguments[1]);
#if defined(FREQSYNTH_HAS_JPEG)
    write_jpegs(arguments[1]);
#endif
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
    return 1;
  }
  return 0;
}
