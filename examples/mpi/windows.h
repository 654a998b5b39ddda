// SPDX-License-Identifier: MIT
/// \file
/// A picture in windows, each of which is an engine of its own on its own rank.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "leader.h"
#include "mail.h"
#include "packet.h"
#include "subject.h"
#include "tracing.h"
#include "window_plan.h"
#include "window_state.h"

namespace farm {

/// What all windows have in common.
struct WindowJob {
  freqsynth::SynthesisSettings settings;  ///< of the whole picture
  const SampleFunction& sample;
  const FinishFunction& finish;
};

/// Tells the share that is done; false ends the work.
using ShareFunction = std::function<bool(double)>;

/// Answers a letter of Kind::window_task with the window's pixels.
/// \param progress  false ends it early; the pixels are what there is by then
void answer_window(Mail& mail, Letter& letter, const WindowJob& job, freqsynth::ThreadPool& pool,
                   const ShareFunction& progress);

/// Has the ranks make all windows, the most expensive first, and puts them together.
class WindowLeader {
 public:
  /// \param state  what is to be done and what has been; receives what is done. Outlives this.
  WindowLeader(Leader& leader, WindowState& state);

  /// A window whose rank fails goes to another one; when none is left, rank 0 makes it.
  /// \param progress  false: no more windows are begun
  /// \return whether all are there
  bool run(const WindowJob& job, freqsynth::ThreadPool& pool, const ShareFunction& progress);

 private:
  void hand_out();
  void take_answer(Letter& letter);
  void finish(int rank, std::size_t window, std::span<const float> pixels,
              const AnswerHeader& header);

  Leader& leader_;
  WindowState& state_;
  std::vector<std::size_t> waiting_;      // the most expensive last
  std::map<int, std::size_t> under_way_;  // the window of each rank that is at work
  std::size_t done_ = 0;
};

}  // namespace farm
