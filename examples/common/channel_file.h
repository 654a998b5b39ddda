// SPDX-License-Identifier: MIT
/// \file
/// Pictures with more channels than colours, as files.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// A picture whose first three channels are red, green and blue, and what it calls the others.
struct ChannelPicture {
  std::size_t width = 0;
  std::size_t height = 0;
  std::span<const std::string_view> names;  ///< of the channels
  std::span<const float> pixels;            ///< linear, row by row, channels interleaved
};

/// Writes a picture: EXR with all channels, by their names; other formats have red, green and blue,
/// see write_picture(). check_picture() says before the work what this would say after it.
/// \throws std::runtime_error naming the file and the reason.
void write_channels(const std::string& file, const ChannelPicture& picture);
