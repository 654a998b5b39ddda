// SPDX-License-Identifier: MIT
/// \file
/// The picture that the others are measured against.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "baselines/rendering.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"

namespace quality {

/// The average of the radiance over the area of each pixel, as the mean of two independent
/// pictures, whose difference tells how far off it still is.
struct Reference {
  std::size_t width = 0;                   ///< pixels
  std::size_t height = 0;                  ///< pixels
  std::array<std::vector<float>, 2> half;  ///< linear RGB, interleaved, row by row

  [[nodiscard]] std::vector<float> pixels() const;
  /// Root mean square of the error of pixels() that is to be expected: half of that of the
  /// difference between the two halves.
  [[nodiscard]] double standard_error() const;
};

/// Stores the exact average of the radiance over pixel (x, y) and returns true where it is known;
/// else returns false. May be empty: nowhere.
using PixelAverage = std::function<bool(std::size_t x, std::size_t y, std::span<float, 3> rgb)>;

/// What a reference is made of.
struct ReferenceSettings {
  std::size_t width = 0;    ///< pixels
  std::size_t height = 0;   ///< pixels
  std::size_t samples = 0;  ///< jittered samples per pixel in total; even and >= 2
  std::uint64_t seed = 0;
};

/// Pixels whose average is known are the same in both halves. In the others each half has
/// settings.samples / 2 jittered samples in each pixel, in a grid whose sides are the
/// two factors of that number nearest to each other. The same for the same settings, whatever the
/// number of threads. Sample ids have their highest bit set, so that the random numbers of a scene
/// are not those of the methods.
/// \param progress  called with the share that is done
/// \throws std::invalid_argument naming the number of samples when it is odd or 0.
[[nodiscard]] Reference render_reference(
    const baselines::Radiance& radiance, const PixelAverage& exact,
    const ReferenceSettings& settings, freqsynth::ThreadPool& pool,
    const std::function<void(double)>& progress = [](double) {});

/// A number that changes when the functions do: a hash of values at 4096 positions and of the exact
/// averages of the pixels there.
[[nodiscard]] std::uint64_t fingerprint(const baselines::Radiance& radiance,
                                        const PixelAverage& exact, std::size_t width,
                                        std::size_t height);

}  // namespace quality
