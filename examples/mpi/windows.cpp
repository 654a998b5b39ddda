// SPDX-License-Identifier: MIT
#include "windows.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bytes.h"

namespace farm {
namespace {

/// Copies the pixels of a window into the picture.
void paste(std::span<const float> pixels, const freqsynth::PixelWindow& window, Picture& picture) {
  const std::size_t row = window.width * picture.channels;
  if (pixels.size() != row * window.height) throw std::runtime_error("a window of another size");
  for (std::size_t y = 0; y < window.height; ++y) {
    std::copy_n(
        pixels.data() + y * row, row,
        picture.pixels.data() + ((window.y + y) * picture.width + window.x) * picture.channels);
  }
}

/// An engine's window, and how many samples it took.
struct Rendered {
  std::vector<float> pixels;
  std::uint64_t samples;
};

/// What lies around a window is sampled for its borders' sake only: as little as does not show.
std::vector<float> importance_of(const freqsynth::PixelWindow& window, std::size_t width,
                                 std::size_t height) {
  constexpr std::size_t block = 8;  // pixels
  constexpr float around = 1.0f / 16;
  const std::size_t columns = (width + block - 1) / block;
  std::vector<float> importance(columns * ((height + block - 1) / block), around);
  for (std::size_t y = window.y / block; y * block < window.y + window.height; ++y) {
    for (std::size_t x = window.x / block; x * block < window.x + window.width; ++x) {
      importance[y * columns + x] = 1;
    }
  }
  return importance;
}

/// By an engine that lives as long as this takes.
Rendered render(const WindowJob& job, const WindowTask& task, freqsynth::ThreadPool& pool,
                const ShareFunction& progress) {
  freqsynth::SynthesisSettings settings = job.settings;
  settings.window = task.window;
  settings.importance = importance_of(task.window, settings.width, settings.height);
  freqsynth::Synthesizer engine(std::move(settings));
  const auto report = engine.run(job.sample, {.samples = task.samples}, pool, progress);
  if (report.reason == freqsynth::StopReason::unusable) {
    throw std::runtime_error("not one sample of the window is a finite number");
  }
  return {job.finish(engine, pool), engine.stats().samples};
}

}  // namespace

void answer_window(Mail& mail, Letter& letter, const WindowJob& job, freqsynth::ThreadPool& pool,
                   const ShareFunction& progress) {
  std::span<const std::byte> bytes = letter.bytes;
  const auto task = take<WindowTask>(bytes);
  std::vector<std::byte> answer = mail.paper();
  const auto begin = std::chrono::steady_clock::now();
  try {
    const auto [pixels, samples] = render(job, task, pool, [&](double share) {
      mail.keep_going();
      return progress(share);
    });
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    put(answer, AnswerHeader{samples, seconds.count()});
    const auto values = std::as_bytes(std::span(pixels));
    answer.insert(answer.end(), values.begin(), values.end());
  } catch (const std::exception& error) {
    answer.clear();
    put_error(answer, error.what());
  }
  mail.send(letter.from, Kind::window_picture, std::move(answer));
}

WindowLeader::WindowLeader(Leader& leader, WindowState& state) : leader_(leader), state_(state) {
  for (std::size_t i = 0; i < state.tasks.size(); ++i) {
    if (state.taken[i] == 0) waiting_.push_back(i);
  }
  done_ = state.tasks.size() - waiting_.size();
  std::stable_sort(waiting_.begin(), waiting_.end(), [&](std::size_t a, std::size_t b) {
    return state_.tasks[a].samples < state_.tasks[b].samples;
  });
}

bool WindowLeader::run(const WindowJob& job, freqsynth::ThreadPool& pool,
                       const ShareFunction& progress) {
  bool goes_on = true;
  const auto show = [&](double share) {
    goes_on =
        progress((static_cast<double>(done_) + share) / static_cast<double>(state_.tasks.size()));
    return goes_on;
  };
  while (!under_way_.empty() || (goes_on && done_ < state_.tasks.size())) {
    if (goes_on) hand_out();
    if (under_way_.empty()) {
      // There is none but this rank.
      const std::size_t window = waiting_.back();
      const auto begin = std::chrono::steady_clock::now();
      const auto [pixels, samples] = render(job, state_.tasks[window], pool, show);
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
      waiting_.pop_back();
      finish(0, window, pixels, {samples, seconds.count()});
      continue;
    }
    std::optional<Letter> letter = leader_.look();
    show(0);
    if (letter) take_answer(*letter);
  }
  return done_ == state_.tasks.size();
}

/// Gives a window to each rank that has none.
void WindowLeader::hand_out() {
  for (const int rank : leader_.at_work()) {
    if (waiting_.empty() || under_way_.contains(rank)) continue;
    under_way_[rank] = waiting_.back();
    std::vector<std::byte> bytes = leader_.mail().paper();
    put(bytes, state_.tasks[waiting_.back()]);
    waiting_.pop_back();
    leader_.send(rank, Kind::window_task, std::move(bytes));
  }
}

void WindowLeader::take_answer(Letter& letter) {
  const std::size_t window = under_way_[letter.from];
  under_way_.erase(letter.from);
  std::span<const std::byte> bytes = letter.bytes;
  const auto header = take<AnswerHeader>(bytes);
  if (header.count == AnswerHeader::failure) {
    leader_.note_failure(letter.from, text_of(bytes));
    waiting_.push_back(window);
  } else {
    leader_.note_success(letter.from);
    std::vector<float> pixels(bytes.size() / sizeof(float));
    std::memcpy(pixels.data(), bytes.data(), bytes.size());
    finish(letter.from, window, pixels, header);
  }
  leader_.mail().recycle(std::move(letter.bytes));
}

void WindowLeader::finish(int rank, std::size_t window, std::span<const float> pixels,
                          const AnswerHeader& header) {
  paste(pixels, state_.tasks[window].window, state_.picture);
  state_.taken[window] = header.count;
  RankFigures& figures = leader_.figures().ranks[static_cast<std::size_t>(rank)];
  figures.samples += header.count;
  figures.seconds += header.seconds;
  ++figures.packets;
  leader_.figures().windows.push_back(header.count);
  ++done_;
}

}  // namespace farm
