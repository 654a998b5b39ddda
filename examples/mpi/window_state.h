// SPDX-License-Identifier: MIT
/// \file
/// How far a picture in windows is, and files of it. All ranks are machines of one kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/picture.h"
#include "window_plan.h"

namespace farm {

/// A picture in windows, some of which are done.
struct WindowState {
  std::vector<WindowTask> tasks;
  std::vector<std::uint64_t> taken;  ///< samples of each window; 0: it is not done
  std::uint64_t coarse = 0;          ///< samples that the plan took
  Picture picture;                   ///< pixels of windows that are done, others 0

  /// With no window done.
  WindowState(std::vector<WindowTask> plan, std::uint64_t coarse_samples, Picture empty);
  WindowState() = default;
};

/// Writes a state, as a whole or not at all.
/// \param what  is rendered, and how: in words
/// \throws std::runtime_error naming the file and the reason.
void save_windows(const std::string& file, const std::string& what, const WindowState& state);

/// A state that was saved.
/// \param what   as it was saved
/// \param empty  the picture's size and channels
/// \throws std::runtime_error naming the file and the reason: that it cannot be read, is no such
///         file, is cut short, or of something else.
[[nodiscard]] WindowState load_windows(const std::string& file, const std::string& what,
                                       Picture empty);

}  // namespace farm
