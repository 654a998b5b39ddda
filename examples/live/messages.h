// SPDX-License-Identifier: MIT
/// \file
/// What is said between page and server, as JSON.
#pragma once

#include <string>

#include "attention.h"
#include "revision.h"
#include "session.h"

namespace live {

/// What the page shows as text. \param revision  none before the first picture
[[nodiscard]] std::string state_message(const Session& session, const Revision* revision);

/// `{"frame": [left, top, right, bottom] or null, "pointer": [x, y] or null}`, in pixels.
/// \throws std::invalid_argument saying what is wrong.
[[nodiscard]] Attention read_attention(const std::string& message);

/// `{"stops": -8..8, "quality": 1..100}`. \throws std::invalid_argument saying what is wrong.
[[nodiscard]] View read_view(const std::string& message);

}  // namespace live
