// SPDX-License-Identifier: MIT
/// \file
/// What rank 0 does: it owns the engine, and has the other ranks trace its requests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "mail.h"
#include "packet_plan.h"
#include "tracing.h"

namespace farm {

/// What a rank has done.
struct RankFigures {
  std::uint64_t samples = 0, packets = 0, errors = 0;
  std::size_t most_under_way = 0;  ///< packets at the same time
  double seconds = 0;              ///< tracing
};

/// What it took. Seconds are CPU time of rank 0's thread.
struct Figures {
  std::vector<RankFigures> ranks;      ///< [0] is rank 0, which traces when there is no other
  std::vector<std::uint64_t> windows;  ///< samples of each, where there are any
  std::uint64_t bytes_out = 0, bytes_in = 0;
  double choosing = 0;   ///< waves: while the others wait
  double absorbing = 0;  ///< waves: while the others wait
  double finishing = 0;  ///< the picture of one engine
  double mailing = 0;    ///< letters and values: while the others trace
};

/// How far it is; false ends the run.
using ProgressFunction = std::function<bool(const freqsynth::Progress&)>;

/// Leads the other ranks, which serve(). They are sent home at its end.
class Leader {
 public:
  Leader(Mail& mail, std::span<const Work> works, freqsynth::ThreadPool& pool,
         const PacketSettings& settings);
  Leader(const Leader&) = delete;
  Leader& operator=(const Leader&) = delete;
  ~Leader();

  /// Samples until a stop rule holds or `progress` returns false. The result is that of
  /// Synthesizer::run(), whatever the ranks do. Packets whose tracing fails go to others; a rank
  /// that fails three times in a row gets no more, and when none is left rank 0 traces.
  /// \param work  number of what is traced
  /// \throws what the sampler throws on rank 0
  freqsynth::StopReason run(freqsynth::Synthesizer& engine, const freqsynth::StopRule& stop,
                            std::size_t work, const ProgressFunction& progress);

  /// Ranks other than this one that get work.
  [[nodiscard]] std::vector<int> at_work() const;
  /// Notes that a rank failed, and tells why, the first time and the last one.
  void note_failure(int rank, const std::string& why);
  /// Notes that it did not, which ends a row of failures.
  void note_success(int rank) { ranks_[static_cast<std::size_t>(rank)].failures = 0; }

  /// Sends work to a rank, which owes an answer then.
  void send(int rank, int kind, std::vector<std::byte>&& bytes);
  /// The next answer that has come, if any; otherwise rests for a moment.
  [[nodiscard]] std::optional<Letter> look();

  [[nodiscard]] Mail& mail() { return mail_; }
  [[nodiscard]] Figures& figures() { return figures_; }

 private:
  static constexpr unsigned most_failures = 3;  // in a row

  using Packet = std::vector<freqsynth::Request>;
  struct Rank {
    std::deque<Packet> under_way;  // in the order of their answers
    double speed = 0;              // samples in a second; 0: not known yet
    unsigned failures = 0;         // in a row
  };

  void fetch(freqsynth::Synthesizer& engine);
  void hand_out(std::size_t work);
  void take_answer(freqsynth::Synthesizer& engine, Letter letter, std::size_t channels);
  void settle(freqsynth::Synthesizer& engine, std::size_t channels);
  [[nodiscard]] double speed_of_all() const;
  [[nodiscard]] bool retired(const Rank& rank) const { return rank.failures >= most_failures; }
  [[nodiscard]] double speed_of(const Rank& rank) const;
  [[nodiscard]] std::size_t left() const { return wave_.size() - next_; }

  Mail& mail_;
  std::span<const Work> works_;
  freqsynth::ThreadPool& pool_;
  PacketSettings settings_;
  std::vector<Rank> ranks_;   // [0] is unused
  Packet wave_;               // requests that were fetched, the most urgent first
  std::size_t next_ = 0;      // that is to be handed out
  bool all_fetched_ = false;  // of the wave
  std::vector<Packet> spare_;
  std::vector<float> values_;
  std::size_t under_way_ = 0;  // packets
  std::size_t owed_ = 0;       // answers
  double known_speed_ = 1e5;   // of ranks whose speed is not known
  Figures figures_;
};

}  // namespace farm
