// SPDX-License-Identifier: MIT
/// \file
/// What is rendered: a scene as something to sample, and what an engine's picture of it is.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "options.h"
#include "tracing.h"

namespace farm {

/// The pixels of what an engine shows: row by row, the channels interleaved.
using FinishFunction =
    std::function<std::vector<float>(const freqsynth::Synthesizer&, freqsynth::ThreadPool&)>;

/// A scene, as all ranks know it.
struct Subject {
  freqsynth::SynthesisSettings settings;   ///< of one engine for the whole picture
  std::vector<std::string_view> channels;  ///< what a file calls them; red, green, blue first
  Fields fields;                           ///< what `sample` wants to know of a request
  std::size_t portion = 16;                ///< samples of a call
  SampleFunction sample;                   ///< values of requests; from several threads
  FinishFunction finish;                   ///< the picture
};

/// \throws UsageError when there is no such scene, std::runtime_error when it cannot be read, or
///         when this program was built without what it needs.
[[nodiscard]] Subject make_subject(const Options& options);

/// The scene of the host on Embree; its settings and pixels are those of freqsynth_embree.
/// \throws like make_subject().
[[nodiscard]] Subject make_embree_subject(const Options& options);

}  // namespace farm
