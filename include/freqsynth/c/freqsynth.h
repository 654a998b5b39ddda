// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * The engine for C, and for every language that can call C: what synthesizer.h, frequency_image.h,
 * reconstructor.h and thread_pool.h have, with opaque handles. C99; part of the compiled library
 * only, in which these functions have C linkage.
 *
 * - Every function that can fail returns a status; freqsynth_last_error() has its text. No C++
 *   exception leaves a function, whatever a callback does. What a function that fails says of its
 *   outputs holds: nothing has been written, unless it is said otherwise.
 * - Structs whose first member is struct_size may grow. Settings are filled in by their
 *   freqsynth_..._init(), which sets that member and puts the default into all others; a program
 *   that was built with fewer members gets the defaults of the others. Results are filled in up to
 *   the struct_size that the caller has set. Pointers to settings may be NULL: the defaults.
 * - Numbers of enumerations never change. Members that hold one are int32_t.
 * - Calls for one handle may come from any thread at the same time, but for those that destroy it.
 *   Destroying NULL does nothing.
 */
#ifndef FREQSYNTH_C_FREQSYNTH_H
#define FREQSYNTH_C_FREQSYNTH_H

#include "freqsynth/c/images.h"
#include "freqsynth/c/quantization.h"
#include "freqsynth/c/sampling.h"
#include "freqsynth/c/settings.h"
#include "freqsynth/c/status.h"

#endif
