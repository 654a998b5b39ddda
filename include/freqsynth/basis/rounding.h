// SPDX-License-Identifier: MIT
/// \file
/// How functions are marked whose results must be the same to the bit, whatever a host's flags say.
///
/// No multiplication is fused with an addition, and no sum reordered, even where the host's flags
/// allow it: gcc by default fuses wherever the instruction set can, and obeys an attribute; clang
/// fuses within one expression only, and obeys a pragma. Only what -ffast-math and
/// -ffp-contract=fast let clang do is beyond reach; without the instruction, which AVX-512 always
/// has, it at least cannot fuse.
#pragma once

#include "freqsynth/basis/config.h"

/// \def FREQSYNTH_ROUNDING
/// Stands before the definition of such a function, and of all that it calls and that is inline.
/// \def FREQSYNTH_ROUNDING_BEGIN
/// Is the first line of its body.
#if defined(__clang__)
#define FREQSYNTH_ROUNDING
#define FREQSYNTH_ROUNDING_BEGIN _Pragma("clang fp contract(off)")
#else
#define FREQSYNTH_ROUNDING __attribute__((optimize("no-fast-math", "fp-contract=off")))
#define FREQSYNTH_ROUNDING_BEGIN
#endif
