// SPDX-License-Identifier: MIT
#include "freqsynth/image/frequency_image_file.h"

#include <string>

#include "basis/file_access.h"
#include "freqsynth/basis/byte_stream.h"

namespace freqsynth {

void save_file(const std::string& file, const FrequencyImage& image) {
  detail::write_file(
      file, [&](ByteSink sink) { image.save(sink); }, true);
}

FrequencyImage load_frequency_image(const std::string& file) {
  return detail::read_file(file, [](ByteSource source) { return FrequencyImage::load(source); });
}

}  // namespace freqsynth
