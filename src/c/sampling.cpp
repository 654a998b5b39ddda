// SPDX-License-Identifier: MIT
#include <cstddef>

#include "c/bridge.h"

namespace freqsynth::detail {
namespace {

// Requests of either language are the same memory.
static_assert(sizeof(freqsynth_request) == sizeof(Request));
static_assert(alignof(freqsynth_request) == alignof(Request));
static_assert(offsetof(freqsynth_request, x) == offsetof(Request, x));
static_assert(offsetof(freqsynth_request, y) == offsetof(Request, y));
static_assert(offsetof(freqsynth_request, id) == offsetof(Request, id));
static_assert(offsetof(freqsynth_request, spacing) == offsetof(Request, spacing));
static_assert(offsetof(freqsynth_request, slot) == offsetof(Request, slot));
static_assert(offsetof(freqsynth_request, seed) == offsetof(Request, seed));
static_assert(offsetof(freqsynth_request, pixel) == offsetof(Request, pixel));
static_assert(offsetof(freqsynth_request, ordinal) == offsetof(Request, ordinal));
static_assert(offsetof(freqsynth_request, thread) == offsetof(Request, thread));
static_assert(offsetof(freqsynth_request, again) == offsetof(Request, again));

std::span<const Request> requests_of(const freqsynth_request* requests, std::size_t count) {
  array(requests, count, "requests");
  return {reinterpret_cast<const Request*>(requests), count};
}

static_assert(FREQSYNTH_WAIT_NO == static_cast<int>(Wait::no));
static_assert(FREQSYNTH_WAIT_UNTIL_AVAILABLE == static_cast<int>(Wait::until_available));

}  // namespace

freqsynth_progress progress_of(const Progress& now) {
  freqsynth_progress progress = {};
  progress.struct_size = sizeof progress;
  progress.fraction = now.fraction;
  progress.seconds = now.seconds;
  progress.seconds_left = now.seconds_left;
  progress.samples = now.samples;
  progress.revision = now.revision;
  progress.predicted_rmse = now.predicted_rmse;
  return progress;
}

}  // namespace freqsynth::detail

using namespace freqsynth::detail;

freqsynth_status freqsynth_list_create(const freqsynth_settings* settings, freqsynth_list** list) {
  return guarded([&] {
    freqsynth_list*& out = object(list, "list");
    const freqsynth::SynthesisSettings all = settings_of(settings);
    out = new freqsynth_list{freqsynth::SharedInverseList(all.list)};
  });
}

void freqsynth_list_destroy(freqsynth_list* list) { delete list; }

freqsynth_status freqsynth_synthesizer_create(const freqsynth_settings* settings,
                                              freqsynth_synthesizer** synthesizer) {
  return guarded([&] {
    freqsynth_synthesizer*& out = object(synthesizer, "synthesizer");
    out = new freqsynth_synthesizer(settings_of(settings));
  });
}

freqsynth_status freqsynth_synthesizer_save(const freqsynth_synthesizer* synthesizer,
                                            const char* file) {
  return guarded(
      [&] { freqsynth::save_file(file_name(file), object(synthesizer, "synthesizer").engine); });
}

freqsynth_status freqsynth_synthesizer_load(const char* file, const freqsynth_settings* settings,
                                            freqsynth_synthesizer** synthesizer) {
  return guarded([&] {
    freqsynth_synthesizer*& out = object(synthesizer, "synthesizer");
    out = new freqsynth_synthesizer(file_name(file), settings_of(settings));
  });
}

void freqsynth_synthesizer_destroy(freqsynth_synthesizer* synthesizer) { delete synthesizer; }

freqsynth_status freqsynth_set_stop(freqsynth_synthesizer* synthesizer,
                                    const freqsynth_stop_rule* rule) {
  return guarded([&] { object(synthesizer, "synthesizer").engine.set_stop(stop_rule_of(rule)); });
}

freqsynth_status freqsynth_request_samples(freqsynth_synthesizer* synthesizer,
                                           freqsynth_request* requests, size_t capacity,
                                           int32_t wait, size_t* count) {
  return guarded([&] {
    auto& engine = object(synthesizer, "synthesizer").engine;
    std::size_t& out = object(count, "count");
    const auto waits = enumerator(wait, freqsynth::Wait::until_available, "wait");
    array(requests, capacity, "requests");
    out = engine.request({reinterpret_cast<freqsynth::Request*>(requests), capacity}, waits);
    for (std::size_t i = 0; i < out; ++i) {
      std::memset(requests[i].reserved, 0, sizeof requests[i].reserved);
    }
  });
}

freqsynth_status freqsynth_deliver(freqsynth_synthesizer* synthesizer,
                                   const freqsynth_request* requests, size_t count,
                                   const float* values, size_t stride) {
  return guarded([&] {
    auto& engine = object(synthesizer, "synthesizer").engine;
    const auto answered = requests_of(requests, count);
    array(values, count, "values");
    const std::size_t step = stride == 0 ? engine.channels() : stride;
    engine.deliver(answered, {values, count * step}, step);
  });
}

freqsynth_status freqsynth_give_back(freqsynth_synthesizer* synthesizer,
                                     const freqsynth_request* requests, size_t count) {
  return guarded(
      [&] { object(synthesizer, "synthesizer").engine.give_back(requests_of(requests, count)); });
}

freqsynth_status freqsynth_abandon(freqsynth_synthesizer* synthesizer,
                                   const freqsynth_request* requests, size_t count) {
  return guarded(
      [&] { object(synthesizer, "synthesizer").engine.abandon(requests_of(requests, count)); });
}

freqsynth_status freqsynth_cancel(freqsynth_synthesizer* synthesizer) {
  return guarded([&] { object(synthesizer, "synthesizer").engine.cancel(); });
}

freqsynth_status freqsynth_wave_size(const freqsynth_synthesizer* synthesizer, size_t* size) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    std::size_t& out = object(size, "size");
    out = engine.wave_size();
  });
}

freqsynth_status freqsynth_get_progress(const freqsynth_synthesizer* synthesizer,
                                        freqsynth_progress* progress) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    write_result(progress_of(engine.progress()), progress, "progress");
  });
}

freqsynth_status freqsynth_stopped(freqsynth_synthesizer* synthesizer, int32_t* reason) {
  return guarded([&] {
    auto& engine = object(synthesizer, "synthesizer").engine;
    std::int32_t& out = object(reason, "reason");
    const auto stopped = engine.stopped();
    out = stopped ? reason_of(*stopped) : std::int32_t{FREQSYNTH_STOP_NONE};
  });
}

freqsynth_status freqsynth_set_importance(freqsynth_synthesizer* synthesizer,
                                          const float* importance, size_t count) {
  return guarded([&] {
    auto& engine = object(synthesizer, "synthesizer").engine;
    engine.set_importance(array(importance, count, "importance"));
  });
}

freqsynth_status freqsynth_get_stats(const freqsynth_synthesizer* synthesizer,
                                     freqsynth_stats* stats) {
  return guarded([&] {
    const freqsynth::SynthesisStats now = object(synthesizer, "synthesizer").engine.stats();
    freqsynth_stats out = {};
    out.samples = now.samples;
    out.probes = now.probes;
    out.differing_probes = now.differing_probes;
    out.absorbed = now.absorbed;
    out.bad_samples = now.bad_samples;
    out.ignored_bad_samples = now.ignored_bad_samples;
    out.abandoned = now.abandoned;
    out.waves = now.waves;
    out.blocks = now.blocks;
    write_result(out, stats, "stats");
  });
}

freqsynth_status freqsynth_get_bad_samples(const freqsynth_synthesizer* synthesizer,
                                           freqsynth_bad_sample* samples, size_t capacity,
                                           size_t* count) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    std::size_t& out = object(count, "count");
    const auto room = array(samples, capacity, "samples");
    const auto bad = engine.bad_samples();
    out = std::min(capacity, bad.size());
    for (std::size_t i = 0; i < out; ++i) room[i] = {bad[i].x, bad[i].y, bad[i].id};
  });
}

freqsynth_status freqsynth_is_noisy(const freqsynth_synthesizer* synthesizer, int32_t* noisy) {
  return guarded([&] {
    const auto& engine = object(synthesizer, "synthesizer").engine;
    std::int32_t& out = object(noisy, "noisy");
    out = engine.noisy();
  });
}
