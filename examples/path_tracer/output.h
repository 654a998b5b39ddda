// SPDX-License-Identifier: MIT
/// \file
/// Pictures as files.
#pragma once

#include <string>

#include "rendering.h"

namespace path_tracer {

/// Says before the work what write_channels() would say after it of a picture of that size.
/// \throws std::runtime_error naming the file and the reason.
void check_output(const std::string& file, std::size_t width, std::size_t height);

/// Writes a picture: EXR with all channels, by their names; other formats have red, green and blue,
/// see write_picture(). \throws std::runtime_error naming the file and the reason.
void write_channels(const std::string& file, std::size_t width, std::size_t height,
                    const Pixels& pixels);

}  // namespace path_tracer
