// SPDX-License-Identifier: MIT
#include "c/bridge.h"

namespace freqsynth::detail {
namespace {

/// The host's function, as a batch sampler.
struct HostSampler {
  const freqsynth_run_options& options;

  void operator()(std::span<const Request> requests, std::span<float> values) const {
    const auto* const first = reinterpret_cast<const freqsynth_request*>(requests.data());
    const int code = options.sampler(options.sampler_user, first, requests.size(), values.data());
    if (code != 0) throw CallbackFailure("sampler", code);
  }
};

extern "C" {
static void freqsynth_run_task(const void* context, std::size_t index) {
  (*static_cast<const TaskRef*>(context))(index);
}
}

/// The host's pool, as an executor.
struct HostExecutor {
  const freqsynth_executor& host;

  [[nodiscard]] std::size_t concurrency() const {
    return std::max<std::size_t>(host.concurrency, 1);
  }
  void execute(std::size_t count, TaskRef task) const {
    const int code = host.execute(host.user, count, &freqsynth_run_task, &task);
    if (code != 0) throw CallbackFailure("executor", code);
  }
};

void check_options(const freqsynth_run_options& options, std::size_t channels) {
  if (options.sampler == nullptr) refuse("sampler is NULL");
  if (options.value_stride != 0 && options.value_stride < channels) {
    refuse("value_stride is " + std::to_string(options.value_stride) + ", not 0 or at least " +
           std::to_string(channels));
  }
  if (options.executor != nullptr && options.thread_pool != nullptr) {
    refuse("there are both an executor and a thread_pool");
  }
  if (options.executor != nullptr && options.executor->execute == nullptr) {
    refuse("executor.execute is NULL");
  }
}

RunReport run_with(Synthesizer& engine, const StopRule& rule,
                   const freqsynth_run_options& options) {
  check_options(options, engine.channels());
  const auto sampler = strided(options.value_stride, HostSampler{options});
  const auto progress = [&](const Progress& now) {
    if (options.progress == nullptr) return true;
    const freqsynth_progress seen = progress_of(now);
    return options.progress(options.progress_user, &seen) == 0;
  };
  if (options.executor != nullptr) {
    return engine.run(sampler, rule, HostExecutor{*options.executor}, progress, options.batch);
  }
  if (options.thread_pool != nullptr) {
    return engine.run(sampler, rule, options.thread_pool->pool, progress, options.batch);
  }
  return engine.run(sampler, rule, SerialExecutor{}, progress, options.batch);
}

}  // namespace
}  // namespace freqsynth::detail

using namespace freqsynth::detail;

void freqsynth_run_options_init(freqsynth_run_options* options, size_t size) {
  freqsynth_run_options usual = {};
  usual.batch = 1024;
  write_defaults(usual, options, size);
}

freqsynth_status freqsynth_run(freqsynth_synthesizer* synthesizer, const freqsynth_stop_rule* rule,
                               const freqsynth_run_options* options, freqsynth_run_report* report) {
  return guarded([&] {
    auto& engine = object(synthesizer, "synthesizer").engine;
    const auto all = read_settings(options, freqsynth_run_options_init, "options");
    const freqsynth::StopRule stop = stop_rule_of(rule);
    if (report != nullptr) {
      known_size(report->struct_size, "report", "the size of the struct");
    }
    const freqsynth::RunReport done = run_with(engine, stop, all);
    if (report == nullptr) return;
    freqsynth_run_report out = {};
    out.reason = reason_of(done.reason);
    out.noise_seen = done.noise_seen;
    out.sampler_seconds = done.sampler_seconds;
    out.core_seconds = done.core_seconds;
    write_result(out, report, "report");
  });
}

freqsynth_status freqsynth_thread_pool_create(size_t threads, freqsynth_thread_pool** pool) {
  return guarded([&] {
    freqsynth_thread_pool*& out = object(pool, "pool");
    out = new freqsynth_thread_pool(threads);
  });
}

void freqsynth_thread_pool_destroy(freqsynth_thread_pool* pool) { delete pool; }
