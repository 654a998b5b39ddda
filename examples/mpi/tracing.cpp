// SPDX-License-Identifier: MIT
#include "tracing.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "bytes.h"
namespace farm {
namespace {

using Clock = std::chrono::steady_clock;

/// Traces packets with all threads, a slice at a time, so that the next packet comes meanwhile.
class Tracer {
 public:
  Tracer(Mail& mail, freqsynth::ThreadPool& pool) : mail_(mail), pool_(pool) {}

  /// The answer to the requests in `packet`.
  std::vector<std::byte> answer(const Work& work, std::span<const std::byte> packet) {
    work.format.decode(packet, requests_);
    values_.resize(requests_.size() * work.format.channels);
    std::vector<std::byte> bytes = mail_.paper();
    const auto begin = Clock::now();
    try {
      trace(work);
    } catch (const std::exception& error) {
      put_error(bytes, error.what());
      return bytes;
    }
    const std::chrono::duration<double> seconds = Clock::now() - begin;
    put(bytes, AnswerHeader{requests_.size(), seconds.count()});
    const auto values = std::as_bytes(std::span(values_));
    bytes.insert(bytes.end(), values.begin(), values.end());
    return bytes;
  }

 private:
  void trace(const Work& work) {
    const std::size_t portion = work.portion;
    const std::size_t slice = 4 * portion * pool_.concurrency();
    for (std::size_t first = 0; first < requests_.size(); first += slice) {
      const std::size_t end = std::min(first + slice, requests_.size());
      const auto task = [&](std::size_t index) {
        const std::size_t from = first + index * portion;
        const std::size_t count = std::min(portion, end - from);
        work.sample(
            std::span(requests_).subspan(from, count),
            std::span(values_).subspan(from * work.format.channels, count * work.format.channels));
      };
      pool_.execute((end - first + portion - 1) / portion, freqsynth::TaskRef(task));
      mail_.keep_going();
    }
  }

  Mail& mail_;
  freqsynth::ThreadPool& pool_;
  std::vector<freqsynth::Request> requests_;
  std::vector<float> values_;
};

}  // namespace

void serve(Mail& mail, std::span<const Work> works, freqsynth::ThreadPool& pool,
           const OtherLetters& others) {
  Tracer tracer(mail, pool);
  for (;;) {
    Letter letter = mail.wait();
    if (letter.kind == Kind::end_of_work) return;
    if (letter.kind >= Kind::work) {
      const Work& work = works[static_cast<std::size_t>(letter.kind - Kind::work)];
      mail.send(letter.from, Kind::answer, tracer.answer(work, letter.bytes));
    } else {
      others(letter);
    }
    mail.recycle(std::move(letter.bytes));
  }
}

}  // namespace farm
