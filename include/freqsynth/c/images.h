// SPDX-License-Identifier: MIT
/* SPDX-License-Identifier: MIT */
/** \file
 * Images of the C interface. */
#ifndef FREQSYNTH_C_IMAGES_H
#define FREQSYNTH_C_IMAGES_H

#include <stddef.h>
#include <stdint.h>

#include "freqsynth/c/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/** How finished pixels are made, see FinishSettings. Those that say yes or no are 0 or 1. */
typedef struct freqsynth_finish_settings {
  size_t struct_size;        /**< set by freqsynth_finish_settings_init() */
  int32_t butterworth;       /**< whether the fit is filtered; 1 */
  int32_t residuals;         /**< 0: the paper's estimate; 1 */
  double butterworth_cutoff; /**< 0.8 */
  double butterworth_order;  /**< 2 */
  int32_t noise;             /**< FREQSYNTH_NOISE_... */
  int32_t measure_doubt;     /**< 1 */
  double doubt;              /**< 0.5 */
  double noisy_doubt;        /**< 1 */
  double shrinkage;          /**< 2 */
  double slack;              /**< 0.4 */
  double ringing;            /**< 0.025 */
  int32_t smooth_noise;      /**< 1 */
  int32_t keep_positive;     /**< 1 */
} freqsynth_finish_settings;

/** The defaults. \param size  sizeof(freqsynth_finish_settings) */
FREQSYNTH_C_API void freqsynth_finish_settings_init(freqsynth_finish_settings* settings,
                                                    size_t size);

/** What a pixel's value is, see PixelFilter. */
enum {
  FREQSYNTH_FILTER_NONE = 0,            /**< the function at the pixel's centre */
  FREQSYNTH_FILTER_BOX = 1,             /**< its average over the pixel's area */
  FREQSYNTH_FILTER_TENT = 2,            /**< radius 1 */
  FREQSYNTH_FILTER_GAUSSIAN = 3,        /**< radius 1.5, sigma 0.5 */
  FREQSYNTH_FILTER_BLACKMAN_HARRIS = 4, /**< radius 1.5 */
  FREQSYNTH_FILTER_MITCHELL = 5         /**< radius 2, B = C = 1/3 */
};

/** How pixels are made of coefficients, see ReconstructionSettings. */
typedef struct freqsynth_reconstruction_settings {
  size_t struct_size;        /**< set by freqsynth_reconstruction_settings_init() */
  int32_t butterworth;       /**< whether images that are not finished are filtered; 1 */
  int32_t pixel_filter;      /**< FREQSYNTH_FILTER_BOX */
  double butterworth_cutoff; /**< 0.8 */
  double butterworth_order;  /**< 2 */
  double filter_radius;      /**< pixels of the output; 0: the filter's own */
  double filter_sigma;       /**< of the Gaussian; 0.5 */
  double filter_b;           /**< of Mitchell's; 1/3 */
  double filter_c;           /**< of Mitchell's; 1/3 */
  int32_t clamp_negative;    /**< whether values below zero are replaced by zero; 0 */
  int32_t reserved;          /**< 0 */
} freqsynth_reconstruction_settings;

/** The defaults. \param size  sizeof(freqsynth_reconstruction_settings) */
FREQSYNTH_C_API void freqsynth_reconstruction_settings_init(
    freqsynth_reconstruction_settings* settings, size_t size);

/** Memory of the caller for pixels, see PixelView. Strides count floats. It does not grow. */
typedef struct freqsynth_pixels {
  float* data;              /**< channel 0 of the pixel in the top left corner */
  size_t width;             /**< pixels in a row */
  size_t height;            /**< pixels in a column */
  ptrdiff_t pixel_stride;   /**< to the pixel on the right; 0: no gaps */
  ptrdiff_t row_stride;     /**< to the pixel below; 0: no gaps */
  ptrdiff_t channel_stride; /**< to the next channel; 0: 1 */
} freqsynth_pixels;

/** The finished picture of completed waves, in one go: freqsynth_finished_image() and
 * freqsynth_reconstruct(). While sampling goes on as well.
 * \param pixels  of any size; all channels that have coefficients are written */
FREQSYNTH_C_API freqsynth_status freqsynth_finish(
    const freqsynth_synthesizer* synthesizer, const freqsynth_finish_settings* finish,
    const freqsynth_reconstruction_settings* reconstruction, const freqsynth_pixels* pixels);

/** How far pixels of the finished picture are expected to be off, see Synthesizer::error_image().
 * \param finish  as the picture is finished
 * \param pixels  of the size of the picture (of its window) */
FREQSYNTH_C_API freqsynth_status freqsynth_error_image(const freqsynth_synthesizer* synthesizer,
                                                       const freqsynth_finish_settings* finish,
                                                       const freqsynth_pixels* pixels);

/** The same for the whole picture, see Synthesizer::predicted_rmse(). \param[out] rmse  it */
FREQSYNTH_C_API freqsynth_status freqsynth_predicted_rmse(const freqsynth_synthesizer* synthesizer,
                                                          const freqsynth_finish_settings* finish,
                                                          double* rmse);

/** The pixels of a channel of FREQSYNTH_ROLE_NEAREST or FREQSYNTH_ROLE_MEAN, see
 * Synthesizer::channel_pixels().
 * \param pixels  of the size of the picture (of its window); one channel */
FREQSYNTH_C_API freqsynth_status freqsynth_channel_pixels(const freqsynth_synthesizer* synthesizer,
                                                          size_t channel,
                                                          const freqsynth_pixels* pixels);

/** The fit of completed waves, as the paper has it, not filtered. */
FREQSYNTH_C_API freqsynth_status freqsynth_fitted_image(const freqsynth_synthesizer* synthesizer,
                                                        freqsynth_image** image);
/** The best image that the samples of completed waves allow: finished pixels. */
FREQSYNTH_C_API freqsynth_status freqsynth_finished_image(const freqsynth_synthesizer* synthesizer,
                                                          const freqsynth_finish_settings* settings,
                                                          freqsynth_image** image);
/** Its end. */
FREQSYNTH_C_API void freqsynth_image_destroy(freqsynth_image* image);

/** Of an image. */
typedef struct freqsynth_image_info {
  size_t struct_size; /**< sizeof(freqsynth_image_info), set by the caller */
  size_t width;       /**< pixels */
  size_t height;      /**< pixels */
  size_t channels;    /**< values per pixel */
  size_t blocks_x;    /**< blocks in a row */
  size_t blocks_y;    /**< blocks in a column */
  int32_t finished;   /**< 1: coefficients are of finished pixels; 0: of a function */
  int32_t reserved;   /**< nothing */
} freqsynth_image_info;

/** Its numbers. */
FREQSYNTH_C_API freqsynth_status freqsynth_image_get_info(const freqsynth_image* image,
                                                          freqsynth_image_info* info);

/** The 64 coefficients of a channel of a block, in zig-zag order, and its number of samples.
 * \param[out] coefficients  room for 64, or NULL
 * \param[out] samples       or NULL */
FREQSYNTH_C_API freqsynth_status freqsynth_image_get_block(const freqsynth_image* image,
                                                           size_t block_x, size_t block_y,
                                                           size_t channel, float* coefficients,
                                                           uint32_t* samples);

/** Pixels of an image at any size. Memory may be half written when it runs out of memory. */
FREQSYNTH_C_API freqsynth_status freqsynth_reconstruct(
    const freqsynth_image* image, const freqsynth_reconstruction_settings* settings,
    const freqsynth_pixels* pixels);

/** The value of each channel at (x, y), in pixels within the image.
 * \param settings  whose butterworth... members are read
 * \param count     of `values`: the number of channels */
FREQSYNTH_C_API freqsynth_status
freqsynth_evaluate(const freqsynth_image* image, const freqsynth_reconstruction_settings* settings,
                   double x, double y, float* values, size_t count);

/** Saves an image into a file, which is replaced when all is written. */
FREQSYNTH_C_API freqsynth_status freqsynth_image_save(const freqsynth_image* image,
                                                      const char* file);
/** An image that was saved, to the bit. */
FREQSYNTH_C_API freqsynth_status freqsynth_image_load(const char* file, freqsynth_image** image);

#ifdef __cplusplus
}
#endif

#endif
