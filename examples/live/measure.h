// SPDX-License-Identifier: MIT
#pragma once

#include "options.h"

namespace live {

/// Serves a client that fetches every picture of every revision, and prints how soon the first one
/// came, how many came in a second, and how much CPU time a sample takes with and without all that,
/// in so many runs of each kind by turns. \return the exit code
int measure(const Options& options);

}  // namespace live
