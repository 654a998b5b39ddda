// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * A host in C99 whose pictures the tests compare with those of the C++ interface. */
#ifndef TESTS_C_HOST_H
#define TESTS_C_HOST_H

#include "freqsynth/c/freqsynth.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the host renders: channel 0 .. 2 an edge and ripples, 3 an id. */
float host_radiance(double x, double y, size_t channel);

/** How it renders. */
enum {
  HOST_RUN_SERIAL,   /* freqsynth_run() on the calling thread */
  HOST_RUN_POOL,     /* on the library's threads */
  HOST_RUN_EXECUTOR, /* on an executor of its own, which runs tasks backwards */
  HOST_RUN_STRIDED,  /* with a sampler that writes vectors of six floats */
  HOST_LOOP,         /* a loop of its own; some requests go back first */
  HOST_LOOP_STRIDED  /* the same with values that lie six floats apart */
};

/** The engine after a number of samples. \return NULL when a call fails, which is printed */
freqsynth_synthesizer* host_render(const freqsynth_settings* settings,
                                   const freqsynth_stop_rule* rule, int way);

/** All calls that answer, with plausible answers. \return 0, or the line where one is not */
int host_looks_around(const char* file);

/** All that can be refused. \return 0, or the line where it is not */
int host_is_refused(void);

#ifdef __cplusplus
}
#endif

#endif
