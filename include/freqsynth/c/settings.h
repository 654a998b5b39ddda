// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * Settings of the C interface. */
#ifndef FREQSYNTH_C_SETTINGS_H
#define FREQSYNTH_C_SETTINGS_H

#include <stddef.h>
#include <stdint.h>

#include "freqsynth/c/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Whether the sampler returns Monte Carlo estimates, see Noise. */
enum {
  FREQSYNTH_NOISE_AUTOMATIC = 0, /**< present once it has been seen */
  FREQSYNTH_NOISE_NONE = 1,      /**< every value is taken for what is there */
  FREQSYNTH_NOISE_PRESENT = 2    /**< every value is taken for an estimate */
};

/** What a channel of a sample is for, see ChannelRole. */
enum {
  FREQSYNTH_ROLE_STEER = 0,   /**< its errors decide where samples go */
  FREQSYNTH_ROLE_PASSIVE = 1, /**< it rides along */
  FREQSYNTH_ROLE_FEATURE = 2, /**< as passive, and guides the smoothing of noise */
  FREQSYNTH_ROLE_NEAREST = 3, /**< never averaged, as ids and depth; after all with coefficients */
  FREQSYNTH_ROLE_MEAN = 4,    /**< means of pixels, at little cost; after all with coefficients */
  FREQSYNTH_ROLE_MEAN_FEATURE = 5 /**< the same, and guides the smoothing of noise */
};

/** How the worth of a block's next sample is estimated, see PriorityMeasure. */
enum {
  FREQSYNTH_MEASURE_RESIDUAL = 0, /**< from the residuals of all samples */
  FREQSYNTH_MEASURE_CHANGE = 1    /**< from what the last samples have changed */
};

/** In what unit the errors of blocks are compared, see Steer. */
enum {
  FREQSYNTH_STEER_LINEAR = 0,   /**< that of the signal */
  FREQSYNTH_STEER_RELATIVE = 1, /**< relative to the brightness */
  FREQSYNTH_STEER_DISPLAY = 2   /**< as a display in sRGB shows them */
};

/** Where the samples of a block lie, see SamplePositions. */
enum {
  FREQSYNTH_POSITIONS_BENT = 0,   /**< a lattice, gently bent */
  FREQSYNTH_POSITIONS_LATTICE = 1 /**< the plain lattice of the paper */
};

/** How samples become an image, see RefinerKind. */
enum {
  FREQSYNTH_REFINER_LEAST_SQUARES = 0, /**< a least-squares fit, block by block */
  FREQSYNTH_REFINER_KRIGING = 1        /**< a tree of nodes and a bank of priors */
};

/** A channel, see ChannelSettings. */
typedef struct freqsynth_channel {
  int32_t role; /**< FREQSYNTH_ROLE_... */
  float weight; /**< of its squared errors, for FREQSYNTH_ROLE_STEER; 1e-30..1e6 */
} freqsynth_channel;

/** What is to be synthesised, see SynthesisSettings, whose members have the same names;
 * those of `list` and `priority` begin with that word. Memory that is pointed to is read by
 * freqsynth_synthesizer_create() only. */
typedef struct freqsynth_settings {
  size_t struct_size;                        /**< set by freqsynth_settings_init() */
  size_t width;                              /**< pixels; 0 */
  size_t height;                             /**< pixels; 0 */
  size_t channels;                           /**< values per sample; 3 */
  int32_t noise;                             /**< FREQSYNTH_NOISE_... */
  int32_t list_positions;                    /**< FREQSYNTH_POSITIONS_... */
  uint64_t seed;                             /**< of freqsynth_request::seed */
  uint64_t list_seed;                        /**< of the positions */
  double list_samples_per_term;              /**< 2.5 */
  size_t list_max_terms;                     /**< 64 */
  int32_t priority_measure;                  /**< FREQSYNTH_MEASURE_... */
  int32_t priority_steer;                    /**< FREQSYNTH_STEER_... */
  double priority_weight;                    /**< 0.3 */
  double priority_uncertainty;               /**< 1 */
  double priority_decay;                     /**< 0.7165 */
  double priority_neighbours;                /**< 16 */
  double priority_image;                     /**< 1 */
  double priority_exploration;               /**< 0.82 */
  double priority_exposure;                  /**< 1 */
  size_t wave;                               /**< blocks between two choices; 0: 1/32 of all */
  size_t max_samples_per_block;              /**< 66049 */
  size_t least_samples_per_block;            /**< before errors decide; 0 */
  const freqsynth_channel* channel_settings; /**< `channels` of them; NULL: all steer */
  const float* importance;                   /**< factor per block, row by row; NULL: 1 */
  size_t importance_count;                   /**< how many there are */
  size_t window_x;                           /**< pixels to the left of the part that is made */
  size_t window_y;                           /**< pixels above it */
  size_t window_width;                       /**< pixels; 0: the whole picture */
  size_t window_height;                      /**< pixels; 0: the whole picture */
  /** Quantiser steps of each channel that has coefficients, 64 in zig-zag order for each: blocks
   * are chosen, and done, by what a quantiser keeps, see QuantizationTarget. NULL: none. */
  const float* quantization_steps;
  double quantization_tolerance;     /**< 0.25 */
  size_t quantization_most_samples;  /**< per block of 8 x 8 pixels; 4096 */
  const freqsynth_list* shared_list; /**< NULL: one of its own */
  int32_t refiner;                   /**< FREQSYNTH_REFINER_... */
  uint32_t packet;                   /**< requests that are traced together; 1 */
} freqsynth_settings;

/** The defaults. \param size  sizeof(freqsynth_settings) */
FREQSYNTH_C_API void freqsynth_settings_init(freqsynth_settings* settings, size_t size);

/** When to stop, see StopRule; the first rule that holds ends the synthesis. */
typedef struct freqsynth_stop_rule {
  size_t struct_size;        /**< set by freqsynth_stop_rule_init() */
  double samples_per_pixel;  /**< infinity: no limit */
  uint64_t samples;          /**< in total; UINT64_MAX: no limit */
  double seconds;            /**< of wall-clock time from when the rule is set; infinity */
  double aliasing_threshold; /**< 0 */
  size_t least_samples;      /**< per block, before the threshold counts; 25 */
  double target_rmse;        /**< the error that finished pixels are expected to have; 0: any */
} freqsynth_stop_rule;

/** The defaults: no limit. \param size  sizeof(freqsynth_stop_rule) */
FREQSYNTH_C_API void freqsynth_stop_rule_init(freqsynth_stop_rule* rule, size_t size);

/** Why no more positions are handed out, see StopReason. */
enum {
  FREQSYNTH_STOP_NONE = 0,       /**< they are */
  FREQSYNTH_STOP_SAMPLES = 1,    /**< the number of samples is reached */
  FREQSYNTH_STOP_THRESHOLD = 2,  /**< every block is below the threshold, or meets the quantiser */
  FREQSYNTH_STOP_EXHAUSTED = 3,  /**< every block has its most samples, or there is no block */
  FREQSYNTH_STOP_CANCELLED = 4,  /**< the progress callback said so, or freqsynth_cancel() */
  FREQSYNTH_STOP_WAITING = 5,    /**< positions handed out elsewhere are still owed */
  FREQSYNTH_STOP_UNUSABLE = 6,   /**< not one sample had a usable value */
  FREQSYNTH_STOP_SECONDS = 7,    /**< the time is over */
  FREQSYNTH_STOP_TARGET_RMSE = 8 /**< the expected error is small enough */
};

/** A list that engines share by freqsynth_settings::shared_list. Engines keep what they need of it:
 * it may be destroyed before them.
 * \param settings  whose list_... members are read; NULL: the defaults */
FREQSYNTH_C_API freqsynth_status freqsynth_list_create(const freqsynth_settings* settings,
                                                       freqsynth_list** list);
/** Its end. */
FREQSYNTH_C_API void freqsynth_list_destroy(freqsynth_list* list);

#ifdef __cplusplus
}
#endif

#endif
