// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * The interface for C of what ends in a quantiser: the signal of JPEG, and the steps of its
 * coefficients. Files are made by c/jpeg.h. */
#ifndef FREQSYNTH_C_QUANTIZATION_H
#define FREQSYNTH_C_QUANTIZATION_H

#include <stddef.h>
#include <stdint.h>

#include "freqsynth/c/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Steps for freqsynth_settings::quantization_steps, those of a JPEG file of that quality.
 * \param quality      1..100
 * \param half_chroma  1 when chroma has half the resolution, otherwise 0
 * \param channels     1: Y; 3: Y, Cb, Cr
 * \param[out] steps   64 for each channel */
FREQSYNTH_C_API freqsynth_status freqsynth_quantization_steps(int32_t quality, int32_t half_chroma,
                                                              size_t channels, float* steps);

/** Linear values to the signal of a JPEG file in sRGB, in place: 1 channel to 0..255, or RGB to Y
 * in 0..255 and Cb, Cr around 0. For samplers, whose pictures are then averages of encoded values.
 * What is not finite makes all of its sample not a number.
 * \param count     of samples, one after the other
 * \param channels  1 or 3
 * \param exposure  factor on linear values; finite and > 0 */
FREQSYNTH_C_API freqsynth_status freqsynth_encode_display(float* values, size_t count,
                                                          size_t channels, float exposure);

#ifdef __cplusplus
}
#endif

#endif
