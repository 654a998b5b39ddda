// SPDX-License-Identifier: MIT
#include "leader.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "bytes.h"
#include "cpu_clock.h"

namespace farm {

Leader::Leader(Mail& mail, std::span<const Work> works, freqsynth::ThreadPool& pool,
               const PacketSettings& settings)
    : mail_(mail),
      works_(works),
      pool_(pool),
      settings_(settings),
      ranks_(static_cast<std::size_t>(mail.ranks())) {
  figures_.ranks.resize(ranks_.size());
}

Leader::~Leader() {
  // An answer that nobody takes might never leave its rank.
  while (owed_ > 0) {
    static_cast<void>(mail_.wait());
    --owed_;
  }
  for (int rank = 1; rank < mail_.ranks(); ++rank) mail_.send(rank, Kind::end_of_work, {});
}

void Leader::send(int rank, int kind, std::vector<std::byte>&& bytes) {
  figures_.bytes_out += bytes.size();
  ++owed_;
  mail_.send(rank, kind, std::move(bytes));
}

std::optional<Letter> Leader::look() {
  std::optional<Letter> letter = mail_.look();
  mail_.rest(!letter);
  if (!letter) return letter;
  figures_.bytes_in += letter->bytes.size();
  --owed_;
  return letter;
}

std::vector<int> Leader::at_work() const {
  std::vector<int> ranks;
  for (std::size_t rank = 1; rank < ranks_.size(); ++rank) {
    if (!retired(ranks_[rank])) ranks.push_back(static_cast<int>(rank));
  }
  return ranks;
}

void Leader::note_failure(int rank, const std::string& why) {
  const auto r = static_cast<std::size_t>(rank);
  const bool first = ++figures_.ranks[r].errors == 1;
  const bool too_often = ++ranks_[r].failures == most_failures;
  if (!first && !too_often) return;
  std::fprintf(stderr, "freqsynth_mpi: rank %d: %s; others do %s\n", rank, why.c_str(),
               too_often ? "all its work from now on" : "this part of its work");
}

freqsynth::StopReason Leader::run(freqsynth::Synthesizer& engine, const freqsynth::StopRule& stop,
                                  std::size_t work, const ProgressFunction& progress) {
  const std::size_t channels = engine.channels();
  engine.set_stop(stop);
  while (under_way_ > 0 || !at_work().empty()) {
    if (!all_fetched_) fetch(engine);
    if (left() == 0 && under_way_ == 0) {
      const auto reason = engine.stopped();
      if (reason && reason != freqsynth::StopReason::waiting) return *reason;
      all_fetched_ = false;
      continue;
    }
    hand_out(work);
    std::optional<Letter> letter = look();
    if (!letter) continue;
    take_answer(engine, std::move(*letter), channels);
    if (!progress(engine.progress())) {
      settle(engine, channels);
      return freqsynth::StopReason::cancelled;
    }
  }
  settle(engine, channels);
  const auto before = engine.stats();
  const auto report = engine.run(works_[work].sample, stop, pool_, progress);
  const auto after = engine.stats();
  figures_.ranks[0].samples += after.samples + after.probes - before.samples - before.probes;
  figures_.ranks[0].seconds += report.sampler_seconds;
  return report.reason;
}

/// Fetches more of the wave. The first portion comes with a choice, for which all wait.
void Leader::fetch(freqsynth::Synthesizer& engine) {
  const CpuClock clock(left() == 0 && under_way_ == 0 ? figures_.choosing : figures_.mailing);
  constexpr std::size_t portion = 4096;
  if (left() == 0) {
    wave_.clear();
    next_ = 0;
  }
  const std::size_t before = wave_.size();
  wave_.resize(before + portion);
  const std::size_t count = engine.request(std::span(wave_).subspan(before));
  wave_.resize(before + count);
  all_fetched_ = count < portion;
}

double Leader::speed_of(const Rank& rank) const {
  return rank.speed > 0 ? rank.speed : known_speed_;
}

double Leader::speed_of_all() const {
  double all = 0;
  for (std::size_t r = 1; r < ranks_.size(); ++r) {
    if (!retired(ranks_[r])) all += speed_of(ranks_[r]);
  }
  return all;
}

/// Fills up what each rank has to do, those first that have least.
void Leader::hand_out(std::size_t work) {
  for (std::size_t level = 0; level < settings_.under_way && left() > 0; ++level) {
    for (std::size_t r = 1; r < ranks_.size() && left() > 0; ++r) {
      Rank& rank = ranks_[r];
      if (rank.under_way.size() != level || retired(rank)) continue;
      const CpuClock clock(figures_.mailing);
      const std::size_t size = packet_size(settings_, left(), speed_of(rank), speed_of_all());
      Packet packet;
      if (!spare_.empty()) {
        packet = std::move(spare_.back());
        spare_.pop_back();
      }
      const auto first = wave_.begin() + static_cast<std::ptrdiff_t>(next_);
      packet.assign(first, first + static_cast<std::ptrdiff_t>(size));
      next_ += size;
      std::vector<std::byte> bytes = mail_.paper();
      works_[work].format.encode(packet, bytes);
      send(static_cast<int>(r), Kind::work + static_cast<int>(work), std::move(bytes));
      rank.under_way.push_back(std::move(packet));
      std::size_t& most = figures_.ranks[r].most_under_way;
      most = std::max(most, rank.under_way.size());
      ++under_way_;
    }
  }
}

void Leader::take_answer(freqsynth::Synthesizer& engine, Letter letter, std::size_t channels) {
  const auto r = static_cast<std::size_t>(letter.from);
  Rank& rank = ranks_[r];
  Packet packet = std::move(rank.under_way.front());
  rank.under_way.pop_front();
  --under_way_;
  std::span<const std::byte> bytes = letter.bytes;
  const auto header = take<AnswerHeader>(bytes);
  if (header.count == AnswerHeader::failure) {
    engine.give_back(packet);
    all_fetched_ = false;
    note_failure(letter.from, text_of(bytes));
  } else {
    // The last packet of a wave has the engine absorb them all.
    const bool last = under_way_ == 0 && left() == 0 && all_fetched_;
    const CpuClock clock(last ? figures_.absorbing : figures_.mailing);
    values_.resize(header.count * channels);
    std::memcpy(values_.data(), bytes.data(), bytes.size());
    engine.deliver(packet, values_);
    rank.failures = 0;
    const double speed = static_cast<double>(header.count) / std::max(header.seconds, 1e-9);
    rank.speed = rank.speed > 0 ? 0.7 * rank.speed + 0.3 * speed : speed;
    known_speed_ = rank.speed;
    RankFigures& figures = figures_.ranks[r];
    figures.samples += header.count;
    figures.seconds += header.seconds;
    ++figures.packets;
  }
  spare_.push_back(std::move(packet));
  mail_.recycle(std::move(letter.bytes));
}

/// Gives back what was not handed out, and waits for the rest.
void Leader::settle(freqsynth::Synthesizer& engine, std::size_t channels) {
  engine.give_back(std::span(wave_).subspan(next_));
  next_ = wave_.size();
  while (under_way_ > 0) {
    if (std::optional<Letter> letter = look()) take_answer(engine, std::move(*letter), channels);
  }
}

}  // namespace farm
