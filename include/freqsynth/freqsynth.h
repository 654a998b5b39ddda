// SPDX-License-Identifier: MIT
/// \file
/// Adaptive image synthesis in the frequency domain (M. R. Bolin, "Application of Image Compression
/// Algorithms to Realistic Image Synthesis", 1995): all that a host needs. Other parts, each usable
/// alone, have headers of their own in the folders.
#pragma once

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/importance_map.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/finish_settings.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_transform.h"
#include "freqsynth/image/pixel_view.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/dequantization.h"
#include "freqsynth/jpeg/display_encoding.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/jpeg/quantization_tables.h"
#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/jpeg/quantized_image.h"
#include "freqsynth/sampler.h"
#include "freqsynth/synthesizer.h"

#if !defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/engine/thread_pool.h"
#endif
