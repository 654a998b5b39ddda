// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * The interface for C of the component `freqsynth::jpeg`: images to JPEG files, straight from their
 * coefficients. Not part of c/freqsynth.h. */
#ifndef FREQSYNTH_C_JPEG_H
#define FREQSYNTH_C_JPEG_H

#include <stddef.h>
#include <stdint.h>

#include "freqsynth/c/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a file is to be. Those that say yes or no are 0 or 1. */
typedef struct freqsynth_jpeg_settings {
  size_t struct_size;  /**< set by freqsynth_jpeg_settings_init() */
  int32_t quality;     /**< as of libjpeg, 1..100; 75 */
  int32_t half_chroma; /**< 4:2:0; 0 */
  int32_t progressive; /**< coarse to fine; 0 */
  int32_t optimize;    /**< codes made for this image; 1 */
  int32_t encoded;     /**< 0: values are linear; 1: they are the signal of JPEG, see
                        * freqsynth_encode_display() */
  float exposure;      /**< factor on linear values; 1 */
} freqsynth_jpeg_settings;

/** The defaults. \param size  sizeof(freqsynth_jpeg_settings) */
FREQSYNTH_C_API void freqsynth_jpeg_settings_init(freqsynth_jpeg_settings* settings, size_t size);

/** Takes bytes of a file, some at a time. \return 0; any other number ends the writing */
typedef int (*freqsynth_write_callback)(void* user, const void* bytes, size_t count);

/** The bytes of a JPEG file.
 * \param image  1 channel, or 3 */
FREQSYNTH_C_API freqsynth_status freqsynth_encode_jpeg(const freqsynth_image* image,
                                                       const freqsynth_jpeg_settings* settings,
                                                       freqsynth_write_callback write, void* user);

/** The same into a file, which is replaced when all is written. */
FREQSYNTH_C_API freqsynth_status freqsynth_write_jpeg(const freqsynth_image* image,
                                                      const freqsynth_jpeg_settings* settings,
                                                      const char* file);

#ifdef __cplusplus
}
#endif

#endif
