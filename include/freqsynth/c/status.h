// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * How calls of the C interface end, and what handles there are. */
#ifndef FREQSYNTH_C_STATUS_H
#define FREQSYNTH_C_STATUS_H

#include <stddef.h>
#include <stdint.h>

/** \def FREQSYNTH_C_API
 * Stands before functions of the library. Programs that link the shared library on Windows define
 * FREQSYNTH_SHARED. */
#if !defined(FREQSYNTH_SHARED)
#define FREQSYNTH_C_API
#elif !defined(_WIN32)
#define FREQSYNTH_C_API __attribute__((visibility("default")))
#elif defined(FREQSYNTH_BUILDING)
#define FREQSYNTH_C_API __declspec(dllexport)
#else
#define FREQSYNTH_C_API __declspec(dllimport)
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** How a call ended. */
typedef int32_t freqsynth_status;
/** \{
 * Values of freqsynth_status. */
enum {
  FREQSYNTH_OK = 0,               /**< it did what it says */
  FREQSYNTH_INVALID_ARGUMENT = 1, /**< an argument is out of range; the text names it */
  FREQSYNTH_OUT_OF_MEMORY = 2,    /**< there is not enough memory */
  FREQSYNTH_CALLBACK_FAILED = 3,  /**< a callback of the caller returned a failure */
  FREQSYNTH_SYSTEM_ERROR = 4,     /**< the system refused: a file, a thread; or a file is damaged */
  FREQSYNTH_INTERNAL_ERROR = 5    /**< anything else: a fault of the library */
};
/** \} */

/** What was wrong with the last call of this thread that failed: a sentence, never NULL, empty when
 * none has. It stays as it is until another one fails. */
FREQSYNTH_C_API const char* freqsynth_last_error(void);

/** The library's version, as "1.2.3". */
FREQSYNTH_C_API const char* freqsynth_version(void);

/** An engine that makes one picture, see Synthesizer. */
typedef struct freqsynth_synthesizer freqsynth_synthesizer;
/** An image as coefficients, see FrequencyImage. Only read, so that threads may share it. */
typedef struct freqsynth_image freqsynth_image;
/** Tables that engines may share, see SharedInverseList. */
typedef struct freqsynth_list freqsynth_list;
/** Threads, see ThreadPool. */
typedef struct freqsynth_thread_pool freqsynth_thread_pool;

#ifdef __cplusplus
}
#endif

#endif
