// SPDX-License-Identifier: MIT
/// \file
/// What all ranks know, from the same command line.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "options.h"
#include "subject.h"
#include "tracing.h"

namespace farm {

/// A scene, and how it is sampled.
class Job {
 public:
  /// Numbers of works.
  enum : std::size_t { picture, coarse_picture };

  /// \throws like make_subject().
  Job(const Options& options, int rank);

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] const Subject& subject() const { return subject_; }
  /// The picture, and a coarse one where there are windows.
  [[nodiscard]] std::span<const Work> works() const { return works_; }
  /// Of an engine of all of a work.
  [[nodiscard]] freqsynth::SynthesisSettings settings(std::size_t work) const;
  /// Pixels of the picture that are one of the coarse picture, in width and in height.
  [[nodiscard]] std::size_t step() const { return step_; }
  [[nodiscard]] freqsynth::ThreadPool& pool() { return pool_; }

 private:
  [[nodiscard]] SampleFunction coarse_sampler() const;

  Options options_;
  Subject subject_;
  freqsynth::ThreadPool pool_;
  std::vector<Work> works_;
  std::size_t step_ = 1;
};

}  // namespace farm
