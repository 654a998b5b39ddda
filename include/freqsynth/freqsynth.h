/// \file
/// All of freqsynth: adaptive image synthesis in the frequency domain (M. R. Bolin, "Application of
/// Image Compression Algorithms to Realistic Image Synthesis", 1995).
#pragma once

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/dct.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/basis/normal_inverse.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/engine/block_queue.h"
#include "freqsynth/engine/edge_cache.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/image/butterworth.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/image/reconstructor.h"
#include "freqsynth/jpeg/display_encoding.h"
#include "freqsynth/jpeg/quantization.h"
#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/sampler.h"
#include "freqsynth/synthesizer.h"
