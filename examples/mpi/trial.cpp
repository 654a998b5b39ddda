// SPDX-License-Identifier: MIT
#include "trial.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "cpu_clock.h"
#include "freqsynth/basis/mix_bits.h"

namespace farm {
namespace {

/// Computes for a while.
void spin(std::uint64_t rounds) {
  std::uint64_t bits = rounds;
  for (std::uint64_t i = 0; i < rounds; ++i) bits = freqsynth::detail::mix_bits(bits + i);
  volatile std::uint64_t keep = bits;
  static_cast<void>(keep);
}

/// Rounds of spin() in a microsecond of CPU time.
double rounds_per_microsecond() {
  constexpr std::uint64_t rounds = 2000000;
  double best = 0;
  for (int i = 0; i < 5; ++i) {
    const double begin = cpu_seconds();
    spin(rounds);
    const double rate = static_cast<double>(rounds) / (1e6 * (cpu_seconds() - begin));
    if (rate > best) best = rate;
  }
  return best;
}

/// Sleeps on average as long as it is told, though the system wakes up late.
void sleep(double microseconds) {
  using Clock = std::chrono::steady_clock;
  thread_local Clock::time_point until = Clock::now();
  const auto now = Clock::now();
  const auto duration = std::chrono::nanoseconds(static_cast<long long>(1e3 * microseconds));
  // What was overslept counts, but not the time in which there was nothing to do.
  if (now - until > std::chrono::microseconds(300)) until = now;
  until += duration;
  std::this_thread::sleep_until(until);
}

}  // namespace

SampleFunction on_trial(SampleFunction sample, const TrialSettings& settings, int rank) {
  const double rounds =
      settings.busy_microseconds > 0 ? settings.busy_microseconds * rounds_per_microsecond() : 0;
  const bool plain = rounds == 0 && settings.sleep_microseconds == 0 && !settings.delays &&
                     (settings.failures == 0 || rank == 0);
  if (plain) return sample;
  return [=, sample = std::move(sample)](std::span<const freqsynth::Request> requests,
                                         std::span<float> values) {
    static std::atomic<std::uint64_t> calls = 0;
    const auto seed = static_cast<std::uint64_t>(rank) << 40;
    const std::uint64_t bits = freqsynth::detail::mix_bits(
        freqsynth::detail::mix_bits(settings.delays.value_or(0)) + seed + calls++);
    if (settings.delays && bits % 4 == 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(bits / 4 % 1000));
    }
    if (rank != 0 && static_cast<double>(bits >> 11) * 0x1p-53 < settings.failures) {
      throw std::runtime_error("fails on trial");
    }
    const auto count = static_cast<double>(requests.size());
    const double times = settings.uneven ? rank : 1;
    if (rounds > 0) spin(static_cast<std::uint64_t>(rounds * count));
    if (settings.sleep_microseconds > 0) sleep(times * settings.sleep_microseconds * count);
    sample(requests, values);
  };
}

}  // namespace farm
