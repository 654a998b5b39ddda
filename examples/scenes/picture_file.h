// SPDX-License-Identifier: MIT
/// \file
/// Pictures from files of any format that OpenImageIO reads, which may be damaged.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace scenes {

/// A picture as a file holds it, upright.
struct PictureFile {
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t channels = 0;  ///< 3: red, green, blue; 1: gray. Alpha is left out.
  /// Values are sRGB encoded, not linear. What is of integer type is, unless the file says that it
  /// is linear; what is of floating point type is only if the file says so.
  bool encoded = false;
  std::unique_ptr<float[]> values;  ///< row by row from the top, channels interleaved

  [[nodiscard]] std::size_t size() const { return width * height * channels; }
};

/// Reads the first picture of a file. Nothing is allocated for a size that no picture has.
/// \throws std::runtime_error naming the file and the reason, also when the file is cut short.
PictureFile read_picture_file(const std::string& file);

}  // namespace scenes
