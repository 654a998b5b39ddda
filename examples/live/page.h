// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace live {

/// page.html with page.css and page.js in it, as they were when this was built. TOKEN stands for a
/// Guard's token.
extern const std::string_view page;

}  // namespace live
