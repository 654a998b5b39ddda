// SPDX-License-Identifier: MIT
#include "sampling.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "shown_light.h"

namespace live {

Sampling::Sampling(freqsynth::Synthesizer& engine, const Subject& subject, double samples_per_pixel,
                   std::size_t threads) {
  thread_ = std::thread([this, &engine, &subject, samples_per_pixel, threads] {
    try {
      work(engine, subject, samples_per_pixel, threads);
    } catch (...) {
      error_ = std::current_exception();
    }
    end_ = Clock::now();
    ended_ = true;
  });
}

Sampling::~Sampling() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

double Sampling::seconds() const {
  return std::chrono::duration<double>((ended_ ? end_ : Clock::now()) - begin_).count();
}

void Sampling::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Sampling::work(freqsynth::Synthesizer& engine, const Subject& subject,
                    double samples_per_pixel, std::size_t threads) {
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    std::vector<float> rgb(3 * requests.size());
    subject.radiance(requests, rgb);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const auto sample = sample_of(std::span<const float, 3>(rgb.data() + 3 * i, 3));
      std::copy(sample.begin(), sample.end(), values.data() + i * channels);
    }
  };
  freqsynth::ThreadPool pool(threads);
  engine.run(sampler, {.samples_per_pixel = samples_per_pixel}, pool,
             [this](const freqsynth::Progress&) { return !stopping_; });
}

}  // namespace live
