// SPDX-License-Identifier: MIT
/// \file
/// A picture that grows, and those who look at it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "attention.h"
#include "board.h"
#include "freqsynth/freqsynth.h"
#include "maps.h"
#include "options.h"
#include "pace.h"
#include "revision.h"
#include "sampling.h"
#include "subject.h"

namespace live {

/// Samples a subject, and hangs up revisions of the picture. All but run() may be called from any
/// thread.
class Session {
 public:
  /// \throws std::runtime_error naming the file when it cannot go on from Options::resume.
  Session(const Options& options, const Subject& subject);

  /// Samples and publishes until `going_on` returns false, which is asked at least twenty times a
  /// second.
  /// \throws what the subject throws.
  void run(const std::function<bool()>& going_on);

  /// The revisions.
  [[nodiscard]] Board& board() { return board_; }
  /// Where samples go from the next wave on.
  void attend(const Attention& attention);
  [[nodiscard]] Attention attention() const;
  /// How the next revision is shown, which comes at once.
  void look(const View& view);
  [[nodiscard]] View view() const;

  /// Stores the finished picture: JPEG as it is shown, EXR with linear light, and a checkpoint.
  /// \return the names of the files
  /// \throws std::runtime_error naming the file and the reason, or that there is no picture yet.
  std::vector<std::string> store();

  [[nodiscard]] const Options& options() const { return options_; }
  /// Samples so far.
  [[nodiscard]] std::uint64_t samples() const { return engine_.stats().samples; }

 private:
  using Clock = std::chrono::steady_clock;

  /// Publishes what is due.
  void update(const Sampling& sampling);
  void publish(const Sampling& sampling, bool ended);
  void make_picture(const Sampling& sampling, bool ended);
  [[nodiscard]] bool picture_due(const Sampling& sampling);

  const Options& options_;
  const Subject& subject_;
  freqsynth::Synthesizer engine_;
  Board board_;
  std::mutex storing_;

  // What others have asked for.
  mutable std::mutex mutex_;
  std::condition_variable asked_;
  Attention attention_;
  View view_;
  bool view_asked_ = false;

  // Of run()'s thread.
  Pace picture_pace_, error_pace_;
  Revision last_;
  freqsynth::FrequencyImage image_;
  std::uint64_t waves_ = 0;  // of image_
  BlockMap errors_;          // no values: not yet known
  double predicted_error_ = 0;
  Clock::time_point picture_time_;
  double picture_cost_ = 0, error_cost_ = 0;  // CPU seconds
};

}  // namespace live
