// SPDX-License-Identifier: MIT
/// \file
/// The engine as hosts use it (paper, section 4): chooses positions, takes values, refines blocks.
///
/// It has two faces. With request() and deliver() the host owns the loop; run() owns it and calls
/// the host's sampler. In both, requests are chosen a wave at a time from the state after the
/// previous wave, so that the result depends on the settings and the values alone: it is the same
/// to the bit whatever the batch size, the number of threads and the order of delivery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "freqsynth/basis/byte_stream.h"
#include "freqsynth/basis/config.h"
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/engine/executor.h"
#include "freqsynth/engine/sampling_loop.h"
#include "freqsynth/engine/stop_rule.h"
#include "freqsynth/image/finish_settings.h"
#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/pixel_view.h"
#include "freqsynth/sampler.h"
#include "freqsynth/synthesis_settings.h"

namespace freqsynth {

/// Turns a radiance function into a frequency image. All members but the constructor and the
/// destructor may be called from any thread at any time; run() and request() may share an image.
///
/// Each member does all that it says or, when it throws, nothing, and the engine can go on. Beside
/// what its comment names, each that returns a container or hands out requests may throw
/// std::bad_alloc; deliver() and give_back() need no memory. Values that were delivered are never
/// lost.
class FREQSYNTH_API Synthesizer {
 public:
  /// \throws std::invalid_argument naming the field and the value when a setting is out of range.
  explicit Synthesizer(SynthesisSettings settings);
  /// Goes on where another one was saved, see save(), to the bit: as if that one had been given
  /// back what it was owed. Requests that were owed are handed out again, as they were. The stop
  /// rule holds as if it were set now: StopRule::seconds count anew, and what was cancelled is not.
  /// \param settings  those that it was made with
  /// \throws std::runtime_error naming the reason: when these are other bytes, damaged, too few, of
  ///         another format or of other settings; what the other constructor and `saved` throw.
  Synthesizer(SynthesisSettings settings, ByteSource saved);
  ~Synthesizer();
  Synthesizer(const Synthesizer&) = delete;
  Synthesizer& operator=(const Synthesizer&) = delete;

  /// Sets when request() and run() stop, from the next wave on. At first there is no limit. What
  /// cancel() has done is undone, and the clock of StopRule::seconds starts.
  /// \throws std::invalid_argument when a rule is negative or not a number.
  void set_stop(const StopRule& stop);

  /// Hands out up to out.size() positions of the wave, block by block, into the front of `out`.
  /// \param wait  what to do while the rest of the wave is out and owed by the host. A thread that
  ///              waits for what it owes itself waits for ever, or for the end of the time.
  /// \return how many. Fewer, when no more of the wave is left; none, when a stop rule holds, or
  ///         with Wait::no also while all is owed; stopped() tells which.
  [[nodiscard]] std::size_t request(std::span<Request> out, Wait wait = Wait::no);
  /// Most positions that can be out at the same time: those of a wave, of the largest one where
  /// waves grow (RefinerKind::kriging). No larger `out` is of use.
  [[nodiscard]] std::size_t wave_size() const;

  /// Other factors on the priorities of blocks from the next wave on, as
  /// SynthesisSettings::importance, so that sampling follows a mouse. What is known stays known.
  /// \throws std::invalid_argument naming the value, and nothing changes.
  void set_importance(std::span<const float> importance);

  /// Takes the values of requests in any order and split: channels() values each, those of
  /// requests[i] at [i * stride, i * stride + channels()).
  /// \param stride  from values to the next ones, at least channels(); 0: packed, channels()
  /// \throws std::invalid_argument naming the id of a request that is not owed, or when the
  ///         sizes do not match; none of the values is taken then.
  void deliver(std::span<const Request> requests, std::span<const float> values,
               std::size_t stride = 0);

  /// Gives requests back without values; request() hands them out again.
  /// \throws std::invalid_argument like deliver().
  void give_back(std::span<const Request> requests);

  /// Gives up requests that nobody will answer: they are not handed out again, and a value that
  /// comes later is refused. The image is made without them, as of samples without a usable value,
  /// but they are counted apart, in SynthesisStats::abandoned. Like deliver() it needs no memory.
  /// \throws std::invalid_argument like deliver().
  void abandon(std::span<const Request> requests);

  /// Ends request() and run(), with StopReason::cancelled: threads that wait in request() come back
  /// at once with nothing, run() does after the batch that is under way. It holds until set_stop()
  /// or the next run(). What is owed can still be delivered or given back. Waits for nothing.
  void cancel();

  /// Why request() hands out nothing; empty while it does. Chooses the next wave, if none is under
  /// way.
  [[nodiscard]] std::optional<StopReason> stopped();

  /// How far it is by the rules that are set.
  [[nodiscard]] Progress progress() const;

  /// Samples until a stop rule holds, `progress` returns false or cancel() is called.
  ///
  /// \param sampler   the radiance function; called from the executor's threads at the same time
  /// \param executor  runs the calls; the result does not depend on it
  /// \param progress  `bool(const Progress&)`, or `bool(double)` for Progress::fraction alone:
  ///                  called after every batch, and at an end that it has not been told of by then;
  ///                  false stops, and nothing is lost
  /// \param batch     most requests between two calls of `progress` for each of the executor's
  ///                  threads, at least 1
  /// \throws what the sampler, the executor or the callback throws, and std::runtime_error when the
  ///         executor left out tasks. What the sampler returned before is delivered, the other
  ///         requests are given back; run() can be called again.
  template <class S, class E = SerialExecutor, class P = KeepGoing>
  RunReport run(S&& sampler, const StopRule& stop, E&& executor = E{}, P&& progress = P{},
                std::size_t batch = 1024);

  /// The image as the paper has it: the fit of each block to the samples of completed waves, not
  /// filtered (CoefficientMeaning::point_function). With RefinerKind::kriging a preview: pixels of
  /// the one prior that steers, made soon (CoefficientMeaning::pixel_average).
  [[nodiscard]] FrequencyImage image() const { return image_on({}); }

  /// The best image that the samples of completed waves allow: finished pixels
  /// (CoefficientMeaning::pixel_average), see PixelFinisher. With RefinerKind::kriging those of the
  /// bank of priors, see TreePictures; of the settings `noise` and `keep_positive` count.
  /// \throws std::invalid_argument when a setting is out of range.
  [[nodiscard]] FrequencyImage finished_image(const FinishSettings& settings = {}) const {
    return finished_image_on(settings, {});
  }

  /// Both on an executor's threads; the result does not depend on it.
  /// \throws what the executor throws, too.
  template <class E>
  requires Executor<std::remove_reference_t<E>>
  [[nodiscard]] FrequencyImage image(E&& executor) const {
    return image_on(detail::ExecutorRef(executor));
  }
  /// The same of finished pixels.
  template <class E>
  requires Executor<std::remove_reference_t<E>>
  [[nodiscard]] FrequencyImage finished_image(const FinishSettings& settings, E&& executor) const {
    return finished_image_on(settings, detail::ExecutorRef(executor));
  }

  /// Writes the finished picture into `out`: to the bit what reconstruct() makes of
  /// finished_image(), in one pass and without the memory of a frequency image, where no pixel of
  /// the output lies in two blocks: at the image's own size, at half of it, at whole multiples.
  /// \throws like finished_image() and reconstruct(); what has been written stays.
  void finish(const PixelView& out, const FinishSettings& settings = {}) const {
    finish_on(out, settings, {});
  }
  /// The same on an executor's threads. \throws what the executor throws, too.
  template <class E>
  requires Executor<std::remove_reference_t<E>>
  void finish(const PixelView& out, const FinishSettings& settings, E&& executor) const {
    finish_on(out, settings, detail::ExecutorRef(executor));
  }

  /// How far each pixel of finished_image(settings) is expected to be from the true mean over its
  /// area: the root of the expected squared error, in the values' unit; row by row, the channels of
  /// images interleaved. An estimate for whole pictures and, roughly, for blocks: what no sample
  /// has hit it knows by what happened elsewhere. Infinite in blocks without a sample.
  /// \throws std::invalid_argument when a setting is out of range.
  [[nodiscard]] std::vector<float> error_image(const FinishSettings& settings = {}) const;

  /// The same of the whole: root of the mean over all pixels, and over channels by their weights.
  /// It finishes no pixels, but with RefinerKind::kriging, and may be asked for now and then while
  /// sampling goes on.
  /// \throws std::invalid_argument when a setting is out of range.
  [[nodiscard]] double predicted_rmse(const FinishSettings& settings = {}) const;

  /// Whether the samples of completed waves are taken for Monte Carlo estimates: as
  /// SynthesisSettings::noise says, or as has been seen.
  [[nodiscard]] bool noisy() const;

  /// The pixels of a channel that images do not have, row by row, from the samples of completed
  /// waves. Of ChannelRole::nearest: each the value of a sample in it, the nearest to its centre,
  /// or that of the nearest pixel of its block that has one. Of the others: each the mean of
  /// the samples in it, or in the smallest square around it that has one, of 3 x 3 to 17 x 17
  /// pixels. 0 where there is none. Of requests for a point that is asked for twice the first
  /// counts.
  /// \param channel  of the samples
  /// \throws std::invalid_argument when the channel has another role.
  [[nodiscard]] std::vector<float> channel_pixels(std::size_t channel) const;

  /// Values per sample. Images have those channels that has_coefficients() is true of.
  [[nodiscard]] std::size_t channels() const { return settings().channels; }
  /// What the images show, in pixels of the whole picture: the blocks that
  /// SynthesisSettings::window has pixels of.
  [[nodiscard]] PixelWindow window() const;
  /// The settings, with the list that is used as `shared_list`.
  [[nodiscard]] const SynthesisSettings& settings() const;
  /// Counters since the engine's creation.
  [[nodiscard]] SynthesisStats stats() const;
  /// The first bad samples, at most 1000; stats() counts all.
  [[nodiscard]] std::vector<BadSample> bad_samples() const;

  /// Saves all that is known, also within a wave: values that were delivered, requests that are
  /// owed, the stop rule. The same bytes on all machines, with check values; of the settings what
  /// tells them from others, of the shared list nothing. A file of them is written by save_file(),
  /// see synthesizer_file.h.
  ///
  /// Other members wait meanwhile. A sink that is slow should get its bytes from memory.
  /// \param sink  takes the bytes, some at a time; must not call the engine
  /// \throws what `sink` throws.
  void save(ByteSink sink) const;
  /// Saves it into memory.
  [[nodiscard]] std::vector<std::byte> save() const;

 private:
  RunReport run_erased(const detail::SamplerRef& sampler, const StopRule& stop,
                       const detail::ExecutorRef& executor, const detail::ProgressRef& progress,
                       std::size_t batch);
  [[nodiscard]] FrequencyImage image_on(const detail::ExecutorRef& executor) const;
  [[nodiscard]] FrequencyImage finished_image_on(const FinishSettings& settings,
                                                 const detail::ExecutorRef& executor) const;
  void finish_on(const PixelView& out, const FinishSettings& settings,
                 const detail::ExecutorRef& executor) const;

  struct Implementation;
  Implementation* implementation_;
};

// ------------------------------------------------------------------------------------ definitions

template <class S, class E, class P>
RunReport Synthesizer::run(S&& sampler, const StopRule& stop, E&& executor, P&& progress,
                           std::size_t batch) {
  detail::check_sampler<std::remove_reference_t<S>>();
  static_assert(Executor<std::remove_reference_t<E>>,
                "freqsynth: an executor has execute(std::size_t, TaskRef) and concurrency()");
  static_assert(ProgressCallback<std::remove_reference_t<P>>,
                "freqsynth: a progress callback is bool(double) or bool(const Progress&)");
  if constexpr (Sampler<std::remove_reference_t<S>> &&
                ProgressCallback<std::remove_reference_t<P>>) {
    auto&& call = detail::as_object(sampler);
    auto&& report = detail::as_object(progress);
    return run_erased({call, channels()}, stop, detail::ExecutorRef(executor),
                      detail::ProgressRef(report), batch);
  }
}

}  // namespace freqsynth

#if defined(FREQSYNTH_HEADER_ONLY)
#include "freqsynth/synthesizer.inl"
#endif
