// SPDX-License-Identifier: MIT
#include "sampling.h"

#include <utility>

#include "freqsynth/engine/thread_pool.h"
#include "glue.h"

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
  freqsynth::ThreadPool pool(threads);
  engine.run(Sampler{subject}, {.samples_per_pixel = samples_per_pixel}, pool,
             [this](const freqsynth::Progress&) { return !stopping_; });
}

}  // namespace live
