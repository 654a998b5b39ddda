/// \file
/// All of freqsynth: adaptive image synthesis in the frequency domain (M. R. Bolin, "Application of
/// Image Compression Algorithms to Realistic Image Synthesis", 1995).
#pragma once

#include "freqsynth/block_queue.h"
#include "freqsynth/butterworth.h"
#include "freqsynth/config.h"
#include "freqsynth/dct.h"
#include "freqsynth/display_encoding.h"
#include "freqsynth/edge_cache.h"
#include "freqsynth/executor.h"
#include "freqsynth/frequency_image.h"
#include "freqsynth/inverse_list.h"
#include "freqsynth/least_squares_refiner.h"
#include "freqsynth/normal_inverse.h"
#include "freqsynth/pixel_finisher.h"
#include "freqsynth/priority.h"
#include "freqsynth/quantization.h"
#include "freqsynth/quantization_target.h"
#include "freqsynth/reconstructor.h"
#include "freqsynth/sample_sequence.h"
#include "freqsynth/sampler.h"
#include "freqsynth/synthesizer.h"
