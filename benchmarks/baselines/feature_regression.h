// SPDX-License-Identifier: MIT
/// \file
/// Regression on features, weighted by non-local means.
#pragma once

#include "non_local_means.h"
#include "pixel_buffers.h"

namespace baselines {

struct FeatureRegressionSettings {
  NonLocalMeansSettings colours = {.search = 8, .patch = 3, .k = 0.5};
  NonLocalMeansSettings features = {.search = 5, .patch = 3, .k = 1};
};

/// The colours of `source` as affine functions of `features` about each pixel, by least squares
/// with the weights of non-local means of `guide`. Every function tells its estimate of all pixels
/// that it was fitted to; a pixel is their weighted mean. Colours that are such a function come out
/// as they are.
/// \param features  at most 7 channels
[[nodiscard]] Buffer regressed(const Buffer& source, const Buffer& guide, const Buffer& variance,
                               const Buffer& features, const NonLocalMeansSettings& settings);

/// The pixels of Owen-scrambled Sobol points, by first-order regression on the features of the job
/// (Bitterli, Rousselle, Moon, Iglesias-Guitian, Adler, Mitchell, Jarosz and Novak, Nonlinearly
/// Weighted First-order Regression for Denoising Monte Carlo Renderings, 2016): features are
/// filtered by non-local means, each half of the samples is fitted with the weights of the other.
/// Without the paper's choice between two bandwidths and its second pass. Where no features are
/// known it is non-local means whose estimates are collaborative. Below one sample per pixel it is
/// sobol_box(). Takes exactly the samples allowed.
[[nodiscard]] Rendering feature_regression(const Radiance& radiance, const Job& job,
                                           const FeatureRegressionSettings& settings = {});

}  // namespace baselines
