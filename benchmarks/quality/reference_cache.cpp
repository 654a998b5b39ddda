// SPDX-License-Identifier: MIT
#include "reference_cache.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "common/picture.h"
#include "quality/results.h"

namespace quality {
namespace {

/// False when there is no such file, or it is not a usable picture of that size.
bool read(const std::string& file, const ReferenceSettings& settings, std::vector<float>& pixels) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return false;
  const auto input = OIIO::ImageInput::open(file);
  if (!input) {
    (void)OIIO::geterror();  // else it would be told at the end of the program
    return false;
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width != static_cast<int>(settings.width) ||
      spec.height != static_cast<int>(settings.height) || spec.nchannels != 3) {
    return false;
  }
  pixels.resize(3 * settings.width * settings.height);
  return input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data()) &&
         std::all_of(pixels.begin(), pixels.end(),
                     [](float value) { return std::isfinite(value); });
}

}  // namespace

Reference cached_reference(const std::string& folder, const std::string& scene,
                           const baselines::Radiance& radiance, const PixelAverage& exact,
                           const ReferenceSettings& settings, freqsynth::ThreadPool& pool,
                           const std::function<void(double)>& progress) {
  if (folder.empty()) return render_reference(radiance, exact, settings, pool, progress);
  std::array<char, 128> key{};
  std::snprintf(key.data(), key.size(), "_%zux%zu_%zu_%llu_%016llx", settings.width,
                settings.height, settings.samples, static_cast<unsigned long long>(settings.seed),
                static_cast<unsigned long long>(
                    fingerprint(radiance, exact, settings.width, settings.height)));
  const std::string stem = folder + "/" + file_name(scene) + key.data();
  const std::array files{stem + "_a.exr", stem + "_b.exr"};

  Reference kept{settings.width, settings.height, {}};
  if (read(files[0], settings, kept.half[0]) && read(files[1], settings, kept.half[1])) return kept;
  make_folder(folder);
  Reference fresh = render_reference(radiance, exact, settings, pool, progress);
  for (std::size_t i = 0; i < files.size(); ++i) {
    write_picture(files[i], {settings.width, settings.height, 3, fresh.half[i]});
  }
  return fresh;
}

}  // namespace quality
