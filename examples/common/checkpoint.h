// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "freqsynth/synthesizer.h"
#include "freqsynth/synthesizer_file.h"

/// An engine with these settings, or one that goes on from a file.
/// \param resume  the file; empty: none
/// \throws std::runtime_error naming the file and the reason.
inline freqsynth::Synthesizer make_engine(const std::string& resume,
                                          const freqsynth::SynthesisSettings& settings) {
  return resume.empty() ? freqsynth::Synthesizer(settings)
                        : freqsynth::load_synthesizer(resume, settings);
}

/// Keeps the state of a long run in a file, where that is wanted.
class Checkpoint {
 public:
  /// \param program  that tells what goes wrong
  /// \param file     empty: not wanted
  /// \param seconds  between two states
  Checkpoint(std::string program, std::string file, double seconds)
      : program_(std::move(program)), file_(std::move(file)), seconds_(seconds) {}

  /// Keeps the state. A disk that is full is no end of a long run: it is told.
  void keep(const freqsynth::Synthesizer& engine) {
    keep_by([&](const std::string& file) { freqsynth::save_file(file, engine); });
  }
  /// Keeps a state of another kind, which `write(file)` writes.
  template <class Write>
  void keep_by(Write&& write) {
    if (file_.empty()) return;
    try {
      write(file_);
    } catch (const std::runtime_error& error) {
      std::fprintf(stderr, "%s: --checkpoint: %s\n", program_.c_str(), error.what());
    }
    due_ = next();
  }
  /// Does so when it is time.
  void keep_when_due(const freqsynth::Synthesizer& engine) {
    if (is_due()) keep(engine);
  }
  /// Whether it is time.
  [[nodiscard]] bool is_due() const { return !file_.empty() && Clock::now() >= due_; }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] Clock::time_point next() const {
    // More than a century is never.
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double>(std::min(seconds_, 4e9)));
  }

  std::string program_;
  std::string file_;
  double seconds_;
  Clock::time_point due_ = next();
};
