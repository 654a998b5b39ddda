// SPDX-License-Identifier: MIT
#include "methods.h"

#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/freqsynth.h"
#include "quality/scene_radiance.h"

namespace quality {
namespace {

/// Processor time of the calling thread, in seconds: other threads and other programs do not count.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

enum class Estimate { finished, means, plain, paper };

/// Samples of the library for so many calls of the sampler, or one less: some are asked for twice.
std::uint64_t samples_for(std::uint64_t calls) {
  return calls + 1 - static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(calls))));
}

baselines::Rendering synthesize(const baselines::Radiance& radiance, const baselines::Job& job,
                                Estimate estimate) {
  // Features ride along where they may be of use.
  const bool means = estimate == Estimate::means;
  const std::size_t features = means || estimate == Estimate::finished ? job.features : 0;
  const std::size_t channels = 3 + features;
  freqsynth::SynthesisSettings settings;
  settings.width = job.width;
  settings.height = job.height;
  settings.channels = channels;
  settings.channel_settings.assign(
      channels, {means ? freqsynth::ChannelRole::mean_feature : freqsynth::ChannelRole::feature});
  std::fill_n(settings.channel_settings.begin(), 3, freqsynth::ChannelSettings{});
  settings.list.seed = job.seed;
  if (estimate == Estimate::paper) {
    settings.priority.measure = freqsynth::PriorityMeasure::change;
    settings.priority.exploration = 0;
    settings.list.positions = freqsynth::SamplePositions::lattice;
  }
  freqsynth::Synthesizer engine(settings);

  baselines::Rendering result{job.width, job.height, {}, {}};
  result.samples.resize(job.width * job.height);
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const freqsynth::Request& request = requests[i];
      const std::uint64_t id = id_of(request, job.seed);
      const std::span<float> out = values.subspan(channels * i, channels);
      if (features == 0) {
        radiance(request.x, request.y, id, out.first<3>());
      } else {
        job.radiance_and_features(request.x, request.y, id, out);
      }
      ++result.samples[request.pixel];
    }
  };
  engine.run(sampler, {.samples = samples_for(job.samples)});
  // The place for a finish that uses features: Estimate::finished of a noisy job.
  const std::vector<float> pixels =
      freqsynth::reconstruct(estimate == Estimate::paper ? engine.image() : engine.finished_image(),
                             {.clamp_negative = !job.noisy});
  const std::size_t kept = means ? 3 : channels;
  for (std::size_t i = 0; i < pixels.size(); i += kept) {
    result.pixels.insert(result.pixels.end(), &pixels[i], &pixels[i] + 3);
  }
  return result;
}

std::vector<Method> all_methods() {
  // One sample in each block is the least that shows the whole picture.
  constexpr double one_per_block = 1.0 / 64;
  std::vector<Method> all;
  const auto add = [&](const char* name, const char* description, Estimate estimate) {
    all.push_back({name, description, "Bolin 1995",
                   [=](const baselines::Radiance& radiance, const baselines::Job& job) {
                     return synthesize(radiance, job, estimate);
                   },
                   one_per_block, estimate == Estimate::plain});
  };
  add("freqsynth", "this library: the fit and its residuals, finished pixels", Estimate::finished);
  add("freqsynth-means", "the same, of features the means of pixels only; for noise",
      Estimate::means);
  add("freqsynth-plain", "the same, finished without features; for noise", Estimate::plain);
  add("freqsynth-paper", "the paper's estimate: the fit alone, Butterworth, pixel means",
      Estimate::paper);
  all.insert(all.end(), baselines::methods().begin(), baselines::methods().end());
  return all;
}

/// Stands between a method and the scene: counts calls and keeps some positions.
class Meter {
 public:
  Meter(const baselines::Radiance& radiance, const baselines::Job& job)
      : radiance_(radiance),
        job_(job),
        stride_(std::max<std::uint64_t>(1, job.samples / enough_calls)),
        samples_(job.width * job.height) {
    kept_.reserve(static_cast<std::size_t>(job.samples / stride_ + 1));
  }

  void operator()(double x, double y, std::uint64_t id, std::span<float> values) {
    call({x, y, id, values.size() != 3}, values);
    const bool inside = x >= 0 && y >= 0 && x <= static_cast<double>(job_.width) &&
                        y <= static_cast<double>(job_.height);
    if (calls_++ % stride_ == 0) kept_.push_back({x, y, id, values.size() != 3});
    if (!inside) {
      ++outside_;
      return;
    }
    const std::size_t column = std::min(static_cast<std::size_t>(x), job_.width - 1);
    const std::size_t row = std::min(static_cast<std::size_t>(y), job_.height - 1);
    ++samples_[row * job_.width + column];
  }

  [[nodiscard]] std::uint64_t calls() const { return calls_; }
  [[nodiscard]] std::uint64_t outside() const { return outside_; }
  [[nodiscard]] std::vector<std::uint32_t> take_samples() { return std::move(samples_); }

  /// See Run::sampler_seconds.
  [[nodiscard]] double sampler_seconds() const {
    if (kept_.empty()) return 0;
    std::vector<float> values(3 + job_.features);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2; ++i) {
      const double begin = thread_seconds();
      for (const Call& each : kept_) call(each, values);
      least = std::min(least, thread_seconds() - begin);
    }
    return least * static_cast<double>(calls_) / static_cast<double>(kept_.size());
  }

 private:
  static constexpr std::uint64_t enough_calls = 65536;
  struct Call {
    double x, y;
    std::uint64_t id;
    bool featured;
  };

  void call(const Call& call, std::span<float> values) const {
    if (call.featured) {
      job_.radiance_and_features(call.x, call.y, call.id, values);
    } else {
      radiance_(call.x, call.y, call.id, values.first<3>());
    }
  }

  const baselines::Radiance& radiance_;
  const baselines::Job& job_;
  std::uint64_t stride_;
  std::uint64_t calls_ = 0;
  std::uint64_t outside_ = 0;
  std::vector<std::uint32_t> samples_;
  std::vector<Call> kept_;
};

}  // namespace

std::span<const Method> methods() {
  static const std::vector<Method> all = all_methods();
  return all;
}

const Method& find_method(std::string_view name) { return baselines::find_method(methods(), name); }

Run run_method(const Method& method, const baselines::Radiance& radiance,
               const baselines::Job& job) {
  Meter meter(radiance, job);
  baselines::Job metered = job;
  if (job.features != 0) metered.radiance_and_features = std::ref(meter);
  const double begin = thread_seconds();
  baselines::Rendering rendering = method.render(std::ref(meter), metered);
  const double seconds = thread_seconds() - begin;

  const auto refuse = [&](const std::string& what) {
    std::string said = method.name;
    throw std::runtime_error(said.append(": ").append(what));
  };
  if (meter.calls() > job.samples) {
    refuse(std::to_string(meter.calls()) + " samples taken, " + std::to_string(job.samples) +
           " allowed");
  }
  if (meter.outside() != 0) refuse(std::to_string(meter.outside()) + " samples taken outside");
  if (rendering.width != job.width || rendering.height != job.height ||
      rendering.pixels.size() != 3 * job.width * job.height) {
    refuse("a picture of " + std::to_string(rendering.width) + " x " +
           std::to_string(rendering.height) + " pixels and " +
           std::to_string(rendering.pixels.size()) + " values, not of " +
           std::to_string(job.width) + " x " + std::to_string(job.height));
  }
  Run run;
  run.calls = meter.calls();
  run.seconds = seconds;
  run.sampler_seconds = meter.sampler_seconds();
  run.pixels = std::move(rendering.pixels);
  run.samples = meter.take_samples();
  return run;
}

std::uint64_t samples_of(double rate, std::size_t width, std::size_t height) {
  const double samples =
      std::round(rate * static_cast<double>(width) * static_cast<double>(height));
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(samples));
}

}  // namespace quality
