// SPDX-License-Identifier: MIT
#include "output.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <stdexcept>

#include "common/output_file.h"
#include "common/picture.h"

namespace path_tracer {
namespace {

bool is_exr(const std::string& file) {
  return OIIO::Strutil::lower(OIIO::Filesystem::extension(file)) == ".exr";
}

}  // namespace

void check_output(const std::string& file, std::size_t width, std::size_t height) {
  check_picture(file, width, height, 3);
}

void write_channels(const std::string& file, std::size_t width, std::size_t height,
                    const Pixels& pixels) {
  if (is_exr(file)) {
    write_whole(file, [&](const std::string& name) {
      OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height),
                           static_cast<int>(channels), OIIO::TypeDesc::FLOAT);
      spec.channelnames.assign(channel_names.begin(), channel_names.end());
      const auto output = OIIO::ImageOutput::create(name);
      if (!output) throw std::runtime_error(OIIO::geterror());
      if (!output->open(name, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) ||
          !output->close()) {
        throw std::runtime_error(output->geterror());
      }
    });
    return;
  }
  Picture picture{width, height, 3, {}};
  picture.pixels.reserve(width * height * 3);
  for (std::size_t i = 0; i < pixels.size(); i += channels) {
    picture.pixels.insert(picture.pixels.end(), pixels.begin() + static_cast<std::ptrdiff_t>(i),
                          pixels.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  write_picture(file, picture);
}

}  // namespace path_tracer
