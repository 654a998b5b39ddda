// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "common/picture.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/thread_pool.h"
#include "options.h"
#include "scenes/scene.h"

/// The yardstick: `samples` jittered samples in each pixel, averaged. They are stratified in a grid
/// whose sides are the two factors of `samples` nearest to each other, so squares are best and
/// primes worst. The same for the same seed, whatever the number of threads.
/// \param progress  called with the share that is done; false stops, and the rows that are missing
///                  stay black
/// \return the picture, and how many of its rows are done
std::pair<Picture, std::size_t> render_reference(const scenes::Scene& scene, std::size_t width,
                                                 std::size_t height, std::size_t channels,
                                                 std::size_t samples, std::uint64_t seed,
                                                 Averaging averaging, freqsynth::ThreadPool& pool,
                                                 const std::function<bool(double)>& progress);
