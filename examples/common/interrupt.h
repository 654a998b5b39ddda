// SPDX-License-Identifier: MIT
/// \file
/// Ctrl-C ends the work, not the program: what there is by then is written.
#pragma once

/// From now on SIGINT and SIGTERM are only noted, once: the next one ends the program at once. Also
/// where they were ignored, as in the background of a shell script.
void note_interrupts();

/// The signal that was noted; 0: none.
int noted_interrupt();
