/// \file
/// The engine (paper, section 4): chooses positions, takes values, refines blocks.
///
/// It has two faces. With request() and deliver() the host owns the loop; run() owns it and calls
/// the host's sampler. In both, requests are chosen a wave at a time from the state after the
/// previous wave, so that the result depends on the settings and the values alone: it is the same
/// to the bit whatever the batch size, the number of threads and the order of delivery.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "freqsynth/basis/config.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/block_queue.h"
#include "freqsynth/engine/edge_cache.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/priority.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_finisher.h"
#include "freqsynth/jpeg/quantization_target.h"
#include "freqsynth/refine/least_squares_refiner.h"
#include "freqsynth/sampler.h"

namespace freqsynth {

struct SynthesisSettings {
  std::size_t width = 0;     ///< pixels; 0 gives an image without blocks
  std::size_t height = 0;    ///< pixels
  std::size_t channels = 3;  ///< values per sample, at least 1

  /// The sampler returns Monte Carlo estimates: another value at each call for the same position.
  /// Such noise is smoothed more, and only more samples make it smaller. Without it the error at
  /// edges falls faster.
  bool noisy = false;

  InverseListSettings list = {};
  PrioritySettings priority = {};
  /// Blocks sampled between two choices; 1 is the paper's strict order, 0 chooses 1/32 of all
  /// blocks.
  std::size_t wave = 0;
  /// Most samples of a block, 1 .. SampleSequence::max_size.
  std::size_t max_samples_per_block = 4096;
  /// Weight of each channel in the priority; empty: equal weights.
  std::vector<float> channel_weights = {};
  /// Factor on the priority of each block, row by row, finite and >= 0; empty: 1. 0 leaves a block
  /// at its first sample.
  std::vector<float> importance = {};
  /// When set, blocks are chosen by what their errors may change after quantisation, and the
  /// synthesis ends by itself when no block is above the target's tolerance.
  std::optional<QuantizationTarget> quantization = std::nullopt;
  /// A list to share with other images; null: one is built from `list`, which is otherwise not
  /// read.
  std::shared_ptr<const InverseList> shared_list = nullptr;
};

/// When to stop; the first rule that holds ends the synthesis. Rules count from the engine's
/// creation, so that raising them goes on.
struct StopRule {
  /// Samples per pixel, fractions included; rounded to whole samples. >= 0.
  double samples_per_pixel = std::numeric_limits<double>::infinity();
  /// Samples in total.
  std::uint64_t samples = std::numeric_limits<std::uint64_t>::max();
  /// The aliasing threshold of section 4.4 in the signal's unit, >= 0: no block changes by more
  /// with its next sample, as root mean square over its pixels and by the estimate of
  /// PrioritySettings::measure. Not an error bound.
  double aliasing_threshold = 0;
};

enum class StopReason {
  samples,    ///< the number of samples is reached
  threshold,  ///< every block is below the aliasing threshold, or meets the quantization target
  exhausted,  ///< every block has its most samples, or there is no block
  cancelled,  ///< the progress callback said so
  waiting     ///< positions handed out by request() elsewhere are still owed
};

/// Counters since the engine's creation.
struct SynthesisStats {
  std::uint64_t samples = 0;   ///< values delivered = sampler calls that succeeded
  std::uint64_t absorbed = 0;  ///< samples taken in by blocks; border samples count for each block
  std::uint64_t bad_samples = 0;  ///< samples with a value that is not is_usable_sample()
  std::uint64_t waves = 0;        ///< waves completed
  std::uint64_t blocks = 0;       ///< blocks of the image
};

/// Where a bad sample was.
struct BadSample {
  double x = 0, y = 0;
  std::uint64_t id = 0;
};

/// What run() did.
struct RunReport {
  StopReason reason = StopReason::samples;
  double sampler_seconds = 0;  ///< wall-clock time with the sampler and its executor at work
  double core_seconds = 0;     ///< the rest: choosing, refining
};

/// A progress callback that never cancels.
struct KeepGoing {
  bool operator()(double) const { return true; }
};

struct BlockNeighbours;  // private

/// Turns a radiance function into a frequency image. request(), deliver(), give_back(), image() and
/// the getters may be called from any thread.
class Synthesizer {
 public:
  /// \throws std::invalid_argument naming the field and the value when a setting is out of range.
  explicit Synthesizer(SynthesisSettings settings);

  /// Sets when request() and run() stop, from the next wave on. At first there is no limit.
  /// \throws std::invalid_argument when a rule is negative or not a number.
  void set_stop(const StopRule& stop);

  /// Hands out up to out.size() positions, most urgent first, into the front of `out`.
  /// \return how many. Fewer, or none, when the rest of the wave is out and owed by the host, or
  ///         when a stop rule holds; stopped() tells which.
  [[nodiscard]] std::size_t request(std::span<Request> out);

  /// Takes the values of requests in any order and split: channels() values each, those of
  /// requests[i] at [i * channels(), (i + 1) * channels()).
  /// \throws std::invalid_argument naming the id of a request that is not owed, or when the
  ///         sizes do not match; none of the values is taken then.
  void deliver(std::span<const Request> requests, std::span<const float> values);

  /// Gives requests back without values; request() hands them out again.
  /// \throws std::invalid_argument like deliver().
  void give_back(std::span<const Request> requests);

  /// Why request() hands out nothing; empty while it does.
  [[nodiscard]] std::optional<StopReason> stopped();

  /// Samples until a stop rule holds or `progress` returns false.
  ///
  /// \param sampler   the radiance function; called from the executor's threads at the same time
  /// \param executor  runs the calls; the result does not depend on it
  /// \param progress  `bool(double)`: called after every batch with the share of allowed samples
  ///                  that is done (0 without such a limit); false stops, and nothing is lost
  /// \param batch     most requests between two calls of `progress`, at least 1
  /// When the sampler throws, what it returned before is delivered, the other requests are given
  /// back, and the exception goes on to the caller; run() can be called again.
  template <Sampler S, Executor E = SerialExecutor, class Progress = KeepGoing>
  RunReport run(S&& sampler, const StopRule& stop, E&& executor = E{},
                Progress&& progress = Progress{}, std::size_t batch = 1024);

  /// The image as the paper has it: the fit of each block to the samples of completed waves, not
  /// filtered (CoefficientMeaning::point_function).
  [[nodiscard]] FrequencyImage image() const;

  /// The best image that the samples of completed waves allow: finished pixels
  /// (CoefficientMeaning::pixel_average), see PixelFinisher.
  /// \param settings  without it FinishSettings{}, or FinishSettings::noisy() for a noisy sampler
  /// \throws std::invalid_argument when a setting is out of range.
  [[nodiscard]] FrequencyImage finished_image(const FinishSettings& settings) const;
  [[nodiscard]] FrequencyImage finished_image() const;

  [[nodiscard]] std::size_t channels() const { return settings_.channels; }
  [[nodiscard]] const SynthesisSettings& settings() const { return settings_; }
  [[nodiscard]] SynthesisStats stats() const;
  /// The first bad samples, at most 1000; stats() counts all.
  [[nodiscard]] std::vector<BadSample> bad_samples() const;

 private:
  enum class SlotState : std::uint8_t { waiting, owed, delivered };
  struct Slot {
    std::uint32_t block;  // the block that asks
    std::uint32_t index;  // its index in the sequence
    SlotState state;
  };
  struct alignas(64) StateLine {
    float values[16];
  };
  struct Place {
    std::uint32_t block;
    std::uint32_t index;
  };

  // All of these run under the lock.
  BlockNeighbours neighbours() const;
  std::optional<StopReason> prepare_wave();
  bool asked_by_neighbour(std::uint32_t block, std::uint32_t index) const;
  Request make_request(std::uint32_t slot) const;
  void settle(std::span<const Request> requests, SlotState state);
  void finish_wave();
  void route(const Slot& slot, const float* values);
  void absorb(std::uint32_t block, const float* values);
  void advance(std::uint32_t block);
  void rescale();
  float priority_of(std::uint32_t block) const;
  float quantized_error_of(std::uint32_t block) const;
  float freedom_of(std::uint32_t block) const;
  float residual_variance(std::uint32_t block, std::size_t channel) const;
  template <class Residual>
  float pooled(std::uint32_t block, Residual&& residual, float image) const;
  void note_residual(std::uint32_t block);
  void revise_neighbours();

  float* state_of(std::size_t block) { return states_.data()->values + block * state_stride_; }
  const float* state_of(std::size_t block) const {
    return states_.data()->values + block * state_stride_;
  }

  SynthesisSettings settings_;
  BlockGrid grid_;
  LeastSquaresRefiner refiner_;
  PriorityMetric metric_;
  EdgeCache cache_;
  BlockQueue queue_;
  std::size_t wave_size_;
  std::size_t state_stride_;

  // Per block.
  std::vector<StateLine> states_;
  std::vector<std::uint32_t> counts_;
  std::vector<float> variations_;
  std::vector<float> residuals_;  // weighted variance of the residuals
  std::vector<float> told_;       // what the blocks beside know of it
  std::vector<float> factors_;    // importance times the visible share of the block
  std::vector<std::uint8_t> in_wave_;

  // The wave.
  std::vector<Slot> slots_;
  std::vector<float> slot_values_;
  std::vector<std::uint32_t> returned_;
  std::vector<std::uint32_t> touched_;
  std::size_t next_slot_ = 0;
  std::size_t delivered_slots_ = 0;

  // The signal's variance, from the corners of all blocks: an even cover, whatever is sampled
  // later.
  std::vector<double> sums_, squares_;
  std::uint64_t corners_ = 0;
  std::size_t untouched_blocks_;
  std::vector<float> channel_variances_;
  float variance_ = 0;       // mean over the channels
  double residual_sum_ = 0;  // of residuals_
  float rounding_ = 0;       // residuals below this are of float, not of the signal

  std::uint64_t sample_limit_ = std::numeric_limits<std::uint64_t>::max();
  float threshold_ = 0;  // squared
  SynthesisStats stats_;
  std::vector<BadSample> bad_;
  mutable std::mutex mutex_;
};

// ------------------------------------------------------------------------------------ definitions

namespace detail {

/// \throws std::invalid_argument when the sampler does not return `channels` values, or batch is 0.
void check_run(std::size_t sampler_channels, std::size_t channels, std::size_t batch);

}  // namespace detail

template <Sampler S, Executor E, class Progress>
RunReport Synthesizer::run(S&& sampler, const StopRule& stop, E&& executor, Progress&& progress,
                           std::size_t batch) {
  using Clock = std::chrono::steady_clock;
  detail::check_run(detail::sampler_channels<S>(channels()), channels(), batch);
  set_stop(stop);

  struct Part {
    std::size_t done = 0;
    std::exception_ptr error;
  };
  std::vector<Request> requests(batch);
  std::vector<float> values(batch * channels());
  std::vector<Part> parts;
  RunReport report;
  const auto begin = Clock::now();
  Clock::duration sampling{};
  const auto finish = [&](StopReason reason) {
    report.reason = reason;
    report.sampler_seconds = std::chrono::duration<double>(sampling).count();
    report.core_seconds = std::chrono::duration<double>(Clock::now() - begin - sampling).count();
    return report;
  };
  while (const std::size_t count = request(requests)) {
    // A few parts per thread even out the cost of samples.
    const std::size_t concurrency = executor.concurrency();
    const std::size_t part_count = concurrency <= 1          ? 1
                                   : count < 4 * concurrency ? count
                                                             : 4 * concurrency;
    parts.assign(part_count, Part{});
    const auto first_of = [&](std::size_t part) { return part * count / part_count; };
    auto task = [&](std::size_t index) {
      const std::size_t first = first_of(index);
      const std::size_t size = first_of(index + 1) - first;
      try {
        detail::call_sampler(
            sampler, std::span<const Request>(requests).subspan(first, size),
            std::span<float>(values).subspan(first * channels(), size * channels()),
            parts[index].done);
      } catch (...) {
        parts[index].error = std::current_exception();
      }
    };
    const auto sampling_begin = Clock::now();
    executor.execute(part_count, TaskRef(task));
    sampling += Clock::now() - sampling_begin;

    std::exception_ptr error;
    for (std::size_t index = 0; index < part_count; ++index) {
      const std::size_t first = first_of(index);
      const std::size_t size = first_of(index + 1) - first;
      const std::size_t done = parts[index].done;
      const auto part = std::span<const Request>(requests).subspan(first, size);
      deliver(part.first(done),
              std::span<const float>(values).subspan(first * channels(), done * channels()));
      if (parts[index].error) {
        give_back(part.subspan(done));
        if (!error) error = parts[index].error;
      }
    }
    if (error) std::rethrow_exception(error);

    const double limit = static_cast<double>(sample_limit_);
    const bool limited = sample_limit_ != std::numeric_limits<std::uint64_t>::max();
    if (!progress(limited && limit > 0 ? static_cast<double>(stats().samples) / limit : 0.0)) {
      return finish(StopReason::cancelled);
    }
  }
  return finish(stopped().value_or(StopReason::waiting));
}

}  // namespace freqsynth
