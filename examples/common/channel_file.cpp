// SPDX-License-Identifier: MIT
#include "channel_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <stdexcept>

#include "output_file.h"
#include "picture.h"

void write_channels(const std::string& file, const ChannelPicture& picture) {
  const std::size_t channels = picture.names.size();
  if (OIIO::Strutil::lower(OIIO::Filesystem::extension(file)) == ".exr") {
    write_whole(file, [&](const std::string& name) {
      OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                           static_cast<int>(channels), OIIO::TypeDesc::FLOAT);
      spec.channelnames.assign(picture.names.begin(), picture.names.end());
      const auto output = OIIO::ImageOutput::create(name);
      if (!output) throw std::runtime_error(OIIO::geterror());
      if (!output->open(name, spec) ||
          !output->write_image(OIIO::TypeDesc::FLOAT, picture.pixels.data()) || !output->close()) {
        throw std::runtime_error(output->geterror());
      }
    });
    return;
  }
  Picture colours{picture.width, picture.height, 3, {}};
  colours.pixels.reserve(picture.width * picture.height * 3);
  for (std::size_t i = 0; i < picture.pixels.size(); i += channels) {
    for (std::size_t c = 0; c < 3; ++c) colours.pixels.push_back(picture.pixels[i + c]);
  }
  write_picture(file, colours);
}
