// SPDX-License-Identifier: MIT
/// \file
/// A picture from a part of its pixels: OpenCV's frequency selective reconstruction.
#pragma once

#include <cstddef>
#include <vector>

#include "rendering.h"

namespace baselines {

/// Chooses exactly job.samples distinct pixels, spread evenly: a random position in each stratum of
/// for_each_stratum(), rounded to its pixel. Where that pixel is taken already, a free one as near
/// as there is. Ascending numbers of pixels, row by row. There must be fewer samples than pixels,
/// at least one.
[[nodiscard]] std::vector<std::size_t> spread_pixels(const Job& job);

/// Samples the centres of spread_pixels() and has cv::xphoto::inpaint() fill in the others by
/// INPAINT_FSR_FAST (Seiler et al., Resampling Images to a Regular Grid from a Non-Regular Subset
/// of Pixel Positions Using Frequency Selective Reconstruction, 2015; Genser et al., 2018). OpenCV
/// computes with 8 bits, whatever it is given: values are clamped to 0..1, encoded by sRGB, rounded
/// to 8 bits, and decoded afterwards. The sampled pixels keep their clamped values. OpenCV turns
/// colours into luma and two colour differences, each rounded to 8 bits too.
///
/// From one sample per pixel on nothing is missing: that is supersampling() with a jittered box.
/// Far below one sample in 100 pixels, OpenCV may find none around some block, and fails: then the
/// samples are averaged by the box of supersampling(). Takes exactly the samples allowed. Sets the
/// number of OpenCV's threads to 1.
[[nodiscard]] Rendering opencv_fsr(const Radiance& radiance, const Job& job);

}  // namespace baselines
