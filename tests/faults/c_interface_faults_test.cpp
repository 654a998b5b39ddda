// SPDX-License-Identifier: MIT
// Memory that runs out below the interface for C: each call says so, and goes through afterwards.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "faults/failing_new.h"
#include "freqsynth/c/freqsynth.h"

namespace {

using faults::FailAllocation;

int sample(void*, const freqsynth_request* requests, std::size_t count, float* values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[4 * i] = values[4 * i + 1] = requests[i].x > 9.5 ? 1.0f : 0.25f;
  }
  return 0;
}

/// Calls work(), in which allocation `k` fails, for k = 0, 1, .. until none does, and undo() where
/// it went through. \return how often it did not
template <class Work, class Undo>
std::size_t faults_of(const Work& work, const Undo& undo) {
  std::size_t faults = 0;
  for (std::size_t k = 0;; ++k) {
    freqsynth_status status;
    bool failed;
    {
      const FailAllocation fault(k);
      status = work();
      failed = fault.failed();
    }
    if (!failed) {
      EXPECT_EQ(status, FREQSYNTH_OK) << freqsynth_last_error();
      return faults;
    }
    // A buffer that only makes sorting faster may be missing.
    if (status == FREQSYNTH_OK) {
      undo();
      continue;
    }
    ++faults;
    EXPECT_EQ(status, FREQSYNTH_OUT_OF_MEMORY) << "allocation " << k;
    EXPECT_STREQ(freqsynth_last_error(), "freqsynth: not enough memory");
  }
}

void run_out_of_memory() {
  freqsynth_settings settings;
  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = 20;
  settings.height = 13;
  settings.channels = 2;
  settings.wave = 4;
  freqsynth_synthesizer* engine = nullptr;
  const auto create = [&] { return freqsynth_synthesizer_create(&settings, &engine); };
  EXPECT_GT(faults_of(create, [&] { freqsynth_synthesizer_destroy(engine); }), 5u);
  freqsynth_run_options options;
  freqsynth_run_options_init(&options, sizeof options);
  options.sampler = sample;
  options.value_stride = 4;
  freqsynth_stop_rule rule;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples = 500;
  const auto run = [&] { return freqsynth_run(engine, &rule, &options, nullptr); };
  EXPECT_GT(faults_of(run, [&] { rule.samples += 100; }), 5u);
  freqsynth_image* image = nullptr;
  const auto finish = [&] { return freqsynth_finished_image(engine, nullptr, &image); };
  EXPECT_GT(faults_of(finish, [&] { freqsynth_image_destroy(image); }), 5u);
  std::vector<float> pixels(20 * 13 * 2);
  const freqsynth_pixels view = {pixels.data(), 20, 13, 0, 0, 0};
  freqsynth_reconstruction_settings how;
  freqsynth_reconstruction_settings_init(&how, sizeof how);
  how.pixel_filter = FREQSYNTH_FILTER_GAUSSIAN;
  const auto nothing = [] {};
  EXPECT_GT(faults_of([&] { return freqsynth_reconstruct(image, &how, &view); }, nothing), 5u);
  freqsynth_stats stats;
  stats.struct_size = sizeof stats;
  ASSERT_EQ(freqsynth_get_stats(engine, &stats), FREQSYNTH_OK);
  EXPECT_EQ(stats.bad_samples, 0u);

  // Values are taken, and requests given back, without memory.
  rule.samples += 1000;
  ASSERT_EQ(freqsynth_set_stop(engine, &rule), FREQSYNTH_OK);
  freqsynth_request requests[2];
  std::size_t count = 0;
  ASSERT_EQ(freqsynth_request_samples(engine, requests, 2, FREQSYNTH_WAIT_NO, &count),
            FREQSYNTH_OK);
  ASSERT_EQ(count, 2u);
  const float values[] = {1, 2, 0, 0, 3, 4, 0, 0};
  EXPECT_EQ(faults_of([&] { return freqsynth_deliver(engine, requests, 1, values, 4); }, nothing),
            0u);
  EXPECT_EQ(faults_of([&] { return freqsynth_give_back(engine, requests + 1, 1); }, nothing), 0u);

  freqsynth_image_destroy(image);
  freqsynth_synthesizer_destroy(engine);
}

TEST(CInterfaceFaults, MemoryThatRunsOutIsAStatus) {
  run_out_of_memory();
  const std::size_t before = faults::bytes_in_use();  // with tables that are made once
  run_out_of_memory();
  EXPECT_EQ(faults::bytes_in_use(), before) << "nothing is left behind";
}

}  // namespace
