// SPDX-License-Identifier: MIT
/// \file
/// What a program writes is there whole or not at all, and nothing else is touched.
#pragma once

#include <functional>
#include <string>
#include <string_view>

/// Lets `write(name)` write a file of another name and then gives it its own. Until then, and when
/// anything fails, a file of that name stays as it is. The other name is fresh, hidden, in the same
/// folder and of the same ending. Permissions are kept, and links: what they name is replaced.
/// Devices and pipes are written directly. What is written has reached the disk before.
/// \throws std::runtime_error naming the file and the reason.
void write_whole(const std::string& file, const std::function<void(const std::string&)>& write);

/// Says before the work what write_whole() would say after it: that there is no such folder, that
/// it is the name of a folder, that it may not be written. `trial` gets the other name, to begin a
/// file that is removed again; not for devices and pipes.
/// \throws std::runtime_error naming the file and the reason.
void check_writable(const std::string& file,
                    const std::function<void(const std::string&)>& trial = {});

/// Writes bytes to a file of that name, whatever it is. \throws std::runtime_error with the reason.
void write_bytes(const std::string& name, std::string_view bytes);

/// Makes a folder unless it exists. \throws std::runtime_error naming it.
void make_folder(const std::string& folder);
