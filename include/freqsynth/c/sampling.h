// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * Engines of the C interface: positions, values, and what is known. */
#ifndef FREQSYNTH_C_SAMPLING_H
#define FREQSYNTH_C_SAMPLING_H

#include <stddef.h>
#include <stdint.h>

#include "freqsynth/c/settings.h"
#include "freqsynth/c/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** An engine with these settings. */
FREQSYNTH_C_API freqsynth_status freqsynth_synthesizer_create(const freqsynth_settings* settings,
                                                              freqsynth_synthesizer** synthesizer);
/** Saves all that is known into a file, also within a wave, so that a later run goes on as if
 * nothing had happened. The file is replaced when all is written. See Synthesizer::save(). */
FREQSYNTH_C_API freqsynth_status
freqsynth_synthesizer_save(const freqsynth_synthesizer* synthesizer, const char* file);
/** An engine that goes on where one was saved, to the bit.
 * \param settings  those that it was made with; others are refused by name */
FREQSYNTH_C_API freqsynth_status freqsynth_synthesizer_load(const char* file,
                                                            const freqsynth_settings* settings,
                                                            freqsynth_synthesizer** synthesizer);
/** Its end. No call for it may be under way. */
FREQSYNTH_C_API void freqsynth_synthesizer_destroy(freqsynth_synthesizer* synthesizer);

/** One position the engine wants a value for, see Request. It does not grow. */
typedef struct freqsynth_request {
  double x;            /**< pixels to the right, in [0, width]; pixel i is centred at i + 0.5 */
  double y;            /**< pixels downwards */
  uint64_t id;         /**< names the request */
  float spacing;       /**< pixels to the nearest earlier samples of the block */
  uint32_t slot;       /**< the engine's own note; hand it back unchanged */
  uint64_t seed;       /**< for random numbers: well mixed, another one for each request */
  uint64_t pixel;      /**< row * width + column */
  uint32_t ordinal;    /**< this is sample 0, 1, 2, .. of its pixel */
  uint32_t thread;     /**< in freqsynth_run(): below the concurrency, no two at the same time */
  uint8_t again;       /**< 1 when the point is asked for a second time, to notice noise */
  uint8_t reserved[7]; /**< nothing */
} freqsynth_request;

/** Sets when freqsynth_request_samples() and freqsynth_run() stop. At first there is no limit. */
FREQSYNTH_C_API freqsynth_status freqsynth_set_stop(freqsynth_synthesizer* synthesizer,
                                                    const freqsynth_stop_rule* rule);

/** What freqsynth_request_samples() does while all positions of a wave are out and owed. */
enum {
  FREQSYNTH_WAIT_NO = 0,             /**< it hands out none */
  FREQSYNTH_WAIT_UNTIL_AVAILABLE = 1 /**< it waits, and hands out none at the end only */
};

/** Hands out up to `capacity` positions.
 * \param wait        FREQSYNTH_WAIT_...; a thread that waits for what it owes itself waits for ever
 * \param[out] count  how many; 0 when a rule holds, or all are owed and it does not wait, see
 *                    freqsynth_stopped() */
FREQSYNTH_C_API freqsynth_status freqsynth_request_samples(freqsynth_synthesizer* synthesizer,
                                                           freqsynth_request* requests,
                                                           size_t capacity, int32_t wait,
                                                           size_t* count);

/** Most positions that can be out at the same time, those of a wave. \param[out] size  how many */
FREQSYNTH_C_API freqsynth_status freqsynth_wave_size(const freqsynth_synthesizer* synthesizer,
                                                     size_t* size);

/** Takes the values of requests, in any order and split. All are taken, or none when it fails.
 * Needs no memory.
 * \param values  `channels` for each request, those of the next one `stride` further
 * \param stride  in floats, at least `channels`; 0: `channels` */
FREQSYNTH_C_API freqsynth_status freqsynth_deliver(freqsynth_synthesizer* synthesizer,
                                                   const freqsynth_request* requests, size_t count,
                                                   const float* values, size_t stride);

/** Gives requests back without values; they are handed out again. Needs no memory. */
FREQSYNTH_C_API freqsynth_status freqsynth_give_back(freqsynth_synthesizer* synthesizer,
                                                     const freqsynth_request* requests,
                                                     size_t count);

/** Gives up requests that nobody will answer: the picture is made without them. Needs no memory. */
FREQSYNTH_C_API freqsynth_status freqsynth_abandon(freqsynth_synthesizer* synthesizer,
                                                   const freqsynth_request* requests, size_t count);

/** Ends freqsynth_run(), after the batch that is under way, and freqsynth_request_samples(), until
 * the next run or freqsynth_set_stop(). Waits for nothing. */
FREQSYNTH_C_API freqsynth_status freqsynth_cancel(freqsynth_synthesizer* synthesizer);

/** Why nothing is handed out. \param[out] reason  FREQSYNTH_STOP_... */
FREQSYNTH_C_API freqsynth_status freqsynth_stopped(freqsynth_synthesizer* synthesizer,
                                                   int32_t* reason);

/** Other factors on the priorities of blocks from the next wave on.
 * \param importance  per block of the whole picture, row by row */
FREQSYNTH_C_API freqsynth_status freqsynth_set_importance(freqsynth_synthesizer* synthesizer,
                                                          const float* importance, size_t count);

/** A radiance function: writes `channels` values for each request. Until it does they are NaN. It
 * is called from several threads at the same time if the run has several.
 * \return 0; any other number ends the run, and nothing of this call is taken */
typedef int (*freqsynth_sampler)(void* user, const freqsynth_request* requests, size_t count,
                                 float* values);

/** One task of a host's executor. */
typedef void (*freqsynth_task)(const void* context, size_t index);

/** A host's pool of threads, see Executor. */
typedef struct freqsynth_executor {
  void* user;         /**< the first argument of `execute` */
  size_t concurrency; /**< how many tasks run at the same time, at least 1 */
  /** Calls task(context, 0) .. task(context, count - 1), once each, on any threads, and returns
   * when all are done: 0, or another number when it could not, which ends the run. Then no task may
   * be running any more. */
  int (*execute)(void* user, size_t count, freqsynth_task task, const void* context);
} freqsynth_executor;

/** How far a synthesis is, see Progress. */
typedef struct freqsynth_progress {
  size_t struct_size;    /**< sizeof(freqsynth_progress), set by the caller, or by the library for a
                          * callback */
  double fraction;       /**< share of the way to the end, 0..1, never falling */
  double seconds;        /**< since the rules were set */
  double seconds_left;   /**< until the end; infinity while unknown */
  uint64_t samples;      /**< as of freqsynth_stats */
  uint64_t revision;     /**< of the picture: another one when this is */
  double predicted_rmse; /**< when target_rmse was looked at last; infinity before */
} freqsynth_progress;

/** How far it is by the rules that are set. */
FREQSYNTH_C_API freqsynth_status freqsynth_get_progress(const freqsynth_synthesizer* synthesizer,
                                                        freqsynth_progress* progress);

/** Called after every batch. \return 0 to go on; any other number ends the run */
typedef int (*freqsynth_progress_callback)(void* user, const freqsynth_progress* progress);

/** What freqsynth_run() works with. */
typedef struct freqsynth_run_options {
  size_t struct_size;        /**< set by freqsynth_run_options_init() */
  freqsynth_sampler sampler; /**< not NULL */
  void* sampler_user;        /**< its first argument */
  /** Floats from one request's values to those of the next, as the sampler writes them, such as 4
   * for a host with vectors of four; 0: `channels`. */
  size_t value_stride;
  const freqsynth_executor* executor;   /**< NULL: `thread_pool` */
  freqsynth_thread_pool* thread_pool;   /**< NULL: the calling thread */
  freqsynth_progress_callback progress; /**< NULL: none */
  void* progress_user;                  /**< its first argument */
  /** Most requests between two calls of `progress` for each thread; 1024. */
  size_t batch;
} freqsynth_run_options;

/** The defaults; all pointers are NULL. \param size  sizeof(freqsynth_run_options) */
FREQSYNTH_C_API void freqsynth_run_options_init(freqsynth_run_options* options, size_t size);

/** What a run did, see RunReport. */
typedef struct freqsynth_run_report {
  size_t struct_size;     /**< sizeof(freqsynth_run_report), set by the caller */
  int32_t reason;         /**< FREQSYNTH_STOP_... */
  int32_t noise_seen;     /**< 1 when samples have been seen to be noisy */
  double sampler_seconds; /**< wall-clock time with the sampler at work */
  double core_seconds;    /**< the rest */
} freqsynth_run_report;

/** Samples until a rule holds or the progress callback says so. When it fails, what the sampler
 * returned before is kept, and it can be called again.
 * \param rule         NULL: no limit
 * \param[out] report  may be NULL
 * \return FREQSYNTH_CALLBACK_FAILED when the sampler or the executor returned a number other than
 *         0, which the text has */
FREQSYNTH_C_API freqsynth_status freqsynth_run(freqsynth_synthesizer* synthesizer,
                                               const freqsynth_stop_rule* rule,
                                               const freqsynth_run_options* options,
                                               freqsynth_run_report* report);

/** Threads that work together.
 * \param threads  the caller of freqsynth_run() included; 0: one per hardware thread */
FREQSYNTH_C_API freqsynth_status freqsynth_thread_pool_create(size_t threads,
                                                              freqsynth_thread_pool** pool);
/** Their end. No run may use them. */
FREQSYNTH_C_API void freqsynth_thread_pool_destroy(freqsynth_thread_pool* pool);

/** Counters since the engine's creation, see SynthesisStats. */
typedef struct freqsynth_stats {
  size_t struct_size;           /**< sizeof(freqsynth_stats), set by the caller */
  uint64_t samples;             /**< samples that were delivered, without `probes` */
  uint64_t probes;              /**< points that were asked for a second time */
  uint64_t differing_probes;    /**< of these, with another value than the first */
  uint64_t absorbed;            /**< samples taken in by blocks */
  uint64_t bad_samples;         /**< samples without a usable value */
  uint64_t ignored_bad_samples; /**< the same in passive channels only */
  uint64_t abandoned;           /**< requests that were abandoned */
  uint64_t waves;               /**< waves completed */
  uint64_t blocks;              /**< blocks of the image */
} freqsynth_stats;

/** The counters. */
FREQSYNTH_C_API freqsynth_status freqsynth_get_stats(const freqsynth_synthesizer* synthesizer,
                                                     freqsynth_stats* stats);

/** Where a bad sample was, see BadSample. It does not grow. */
typedef struct freqsynth_bad_sample {
  double x;    /**< pixels to the right */
  double y;    /**< pixels downwards */
  uint64_t id; /**< that of its request */
} freqsynth_bad_sample;

/** The first bad samples, at most 1000 and at most `capacity`. \param[out] count  how many */
FREQSYNTH_C_API freqsynth_status freqsynth_get_bad_samples(const freqsynth_synthesizer* synthesizer,
                                                           freqsynth_bad_sample* samples,
                                                           size_t capacity, size_t* count);

/** Whether samples are taken for Monte Carlo estimates. \param[out] noisy  0 or 1 */
FREQSYNTH_C_API freqsynth_status freqsynth_is_noisy(const freqsynth_synthesizer* synthesizer,
                                                    int32_t* noisy);

#ifdef __cplusplus
}
#endif

#endif
