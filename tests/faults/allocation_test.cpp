// SPDX-License-Identifier: MIT
// What happens when memory runs out: for every k of a small piece of work the k-th allocation fails
// once, the same call is made again, and the result must be that of work without a fault.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <new>
#include <span>
#include <vector>

#include "faults/failing_new.h"
#include "faults/survive.h"
#include "freqsynth/basis/inverse_list.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using faults::loop;
using faults::survive;
using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;

template <class Span>
bool same(const Span& a, const Span& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void expect_same_entry(const InverseList& list, const InverseList& expected, std::size_t index) {
  const detail::SampleRow& a = list.row(index);
  const detail::SampleRow& b = expected.row(index);
  ASSERT_EQ(list.position(index).s, expected.position(index).s) << index;
  ASSERT_EQ(list.position(index).t, expected.position(index).t) << index;
  ASSERT_EQ(list.terms(index), expected.terms(index)) << index;
  ASSERT_TRUE(std::equal(a.fit, a.fit + max_terms, b.fit)) << index;
  ASSERT_TRUE(std::equal(a.gain, a.gain + max_terms, b.gain)) << index;
  ASSERT_EQ(a.border == nullptr, b.border == nullptr) << index;
  ASSERT_EQ(a.pixel_count, b.pixel_count) << index;
  ASSERT_TRUE(same(list.variances(index), expected.variances(index))) << index;
  ASSERT_TRUE(same(list.inverse(index), expected.inverse(index))) << index;
  ASSERT_TRUE(same(list.gain(index), expected.gain(index))) << index;
  ASSERT_TRUE(same(list.border(index), expected.border(index))) << index;
}

TEST(Allocation, AListGoesOnAfterAFailedOne) {
  constexpr std::size_t entries = 150;
  const InverseList expected;
  std::size_t faults = 0;
  for (std::size_t k = 0;; ++k) {
    const InverseList list;
    if (!survive(k, [&] { list.reserve(entries); })) break;
    ++faults;
    for (std::size_t index = 0; index < entries; ++index) {
      expect_same_entry(list, expected, index);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(faults, 60u) << "two or three samples per term make about 60 terms";
}

TEST(Allocation, AListThatIsAskedForItsInversesGoesOn) {
  const InverseList expected;
  for (std::size_t k = 0;; ++k) {
    const InverseList list;
    list.reserve(200);
    const bool failed = survive(k, [&] {
      for (const std::size_t index : {130u, 131u, 10u, 199u}) {
        static_cast<void>(list.inverse(index));
      }
    });
    for (const std::size_t index : {199u, 131u, 130u, 64u, 63u, 10u, 0u}) {
      expect_same_entry(list, expected, index);
      if (HasFatalFailure()) return;
    }
    if (!failed) break;
  }
}

TEST(Allocation, WhateverHappensToARequestNeedsNoMemory) {
  Synthesizer engine(settings_of(48, 40, 2, 10));
  engine.set_stop(at_samples(700));
  std::vector<Request> requests(5);
  const std::vector<float> values(4 * 5, 0.5f);
  std::size_t turn = 0, calls = 0;
  while (const std::size_t count = engine.request(requests)) {
    const std::span<const Request> some(requests.data(), count);
    const faults::FailAllocation next(0);
    if (++turn % 3 == 0) {
      engine.give_back(some);
      continue;
    }
    calls += count;
    if (turn % 3 == 1) {
      engine.abandon(some);
    } else {
      engine.deliver(some, std::span(values).first(4 * count), 4);
    }
    if (turn == 40) engine.cancel();
    static_cast<void>(engine.progress());
    ASSERT_FALSE(next.failed());
  }
  EXPECT_EQ(engine.stopped(), StopReason::cancelled);
  EXPECT_EQ(helpers::calls_of(engine), calls);
  engine.set_stop(at_samples(700));
  EXPECT_FALSE(engine.stopped());
}

TEST(Allocation, AnEngineInALoopOfTheHostsOwnGoesOn) {
  constexpr std::uint64_t budget = 700;
  Synthesizer straight(settings_of(48, 40));
  straight.run(picture, at_samples(budget));
  std::size_t faults = 0;
  for (std::size_t k = 0;; ++k) {
    Synthesizer engine(settings_of(48, 40));
    engine.set_stop(at_samples(budget));
    std::vector<Request> requests;
    requests.reserve(7);
    std::vector<float> values(1);
    std::uint64_t answered = 0;
    const bool failed = survive(k, [&] { loop(engine, answered, requests, values); });
    ASSERT_EQ(answered, helpers::calls_of(straight)) << k;
    ASSERT_EQ(engine.stats().samples, budget) << k;
    ASSERT_EQ(engine.stats().absorbed, straight.stats().absorbed) << k;
    ASSERT_TRUE(helpers::same_image(engine.image(), straight.image())) << k;
    ASSERT_TRUE(helpers::same_image(engine.finished_image(), straight.finished_image())) << k;
    if (!failed) break;
    ++faults;
  }
  EXPECT_GT(faults, 30u);
}

TEST(Allocation, ARunGoesOn) {
  constexpr std::uint64_t budget = 500;
  Synthesizer straight(settings_of(48, 40));
  straight.run(picture, at_samples(budget));
  ThreadPool pool(2);
  for (const bool parallel : {false, true}) {
    for (std::size_t k = 0;; ++k) {
      Synthesizer engine(settings_of(48, 40));
      std::atomic<std::size_t> calls = 0;
      const auto sampler = [&](double x, double y) {
        ++calls;
        return picture(x, y);
      };
      const bool failed = survive(k, [&] {
        const RunReport report =
            parallel ? engine.run(sampler, at_samples(budget), pool, KeepGoing{}, 10)
                     : engine.run(sampler, at_samples(budget), SerialExecutor{}, KeepGoing{}, 10);
        ASSERT_EQ(report.reason, StopReason::samples);
      });
      ASSERT_EQ(calls, helpers::calls_of(straight)) << "no request is answered twice, at " << k;
      ASSERT_TRUE(helpers::same_image(engine.image(), straight.image())) << k;
      if (!failed) break;
    }
  }
}

TEST(Allocation, BadSamplesAreReportedAllTheSame) {
  const auto sampler = [](double x, double y) { return x < 20 ? picture(x, y) : 1e30f; };
  Synthesizer straight(settings_of(40, 32));
  straight.run(sampler, at_samples(400));
  for (std::size_t k = 0;; ++k) {
    Synthesizer engine(settings_of(40, 32));
    const bool failed = survive(k, [&] { engine.run(sampler, at_samples(400)); });
    ASSERT_EQ(engine.stats().bad_samples, straight.stats().bad_samples);
    ASSERT_EQ(engine.bad_samples().size(), straight.bad_samples().size());
    if (!failed) break;
  }
}

TEST(Allocation, ImagesAreMadeOrNot) {
  Synthesizer engine(settings_of(40, 32));
  engine.run(picture, at_samples(400));
  const FrequencyImage image = engine.image(), finished = engine.finished_image();
  const std::vector<float> pixels = reconstruct(finished, {}, 1.5);
  for (std::size_t k = 0;; ++k) {
    FrequencyImage again, again_finished;
    std::vector<float> again_pixels;
    const bool failed = survive(k, [&] {
      again = engine.image();
      again_finished = engine.finished_image();
      again_pixels = reconstruct(again_finished, {}, 1.5);
    });
    ASSERT_TRUE(helpers::same_image(again, image)) << k;
    ASSERT_TRUE(helpers::same_image(again_finished, finished)) << k;
    ASSERT_EQ(again_pixels, pixels) << k;
    if (!failed) break;
  }
}

TEST(Allocation, AnEngineIsMadeOrNot) {
  for (std::size_t k = 0;; ++k) {
    const std::size_t before = faults::bytes_in_use();
    const bool failed = survive(k, [&] { const Synthesizer engine(settings_of(40, 32, 3)); });
    EXPECT_EQ(faults::bytes_in_use(), before) << "nothing is left behind, at " << k;
    if (!failed) break;
  }
}

TEST(Allocation, AnswersNeedNoMemory) {
  Synthesizer engine(settings_of(48, 40));
  engine.set_stop(at_samples(600));
  std::vector<Request> requests(64);
  std::vector<float> values(64);
  while (const std::size_t count = engine.request(requests)) {
    for (std::size_t i = 0; i < count; ++i) values[i] = picture(requests[i].x, requests[i].y);
    const std::size_t before = faults::allocations();
    engine.give_back(std::span(requests).subspan(count / 2, count - count / 2));
    engine.deliver(std::span(requests).first(count / 2), std::span(values).first(count / 2));
    EXPECT_EQ(faults::allocations(), before);
    if (count > 1) continue;
    // The last one of a wave was given back: it comes again, and ends the wave.
    ASSERT_EQ(engine.request(requests), 1u);
    const std::size_t again = faults::allocations();
    engine.deliver(std::span(requests).first(1), std::span(values).first(1));
    EXPECT_EQ(faults::allocations(), again);
  }
  EXPECT_EQ(engine.stats().samples, 600u);
}

TEST(Allocation, AListKeepsInversesOnlyWhereTheyAreAskedFor) {
  constexpr std::size_t entries = 4096;
  const std::size_t before = faults::bytes_in_use();
  const InverseList list;
  list.reserve(entries);
  const std::size_t plain = faults::bytes_in_use() - before;
  // A row of 2 x 64 floats and a few more words, a position, 64 variances, a pointer: 0.9 kB; with
  // it the builder, the positions of whole levels and the table of chunks.
  EXPECT_LT(plain, entries * 900 + 1'000'000);
  static_cast<void>(list.inverse(entries - 1));
  const std::size_t one = faults::bytes_in_use() - before - plain;
  // A triangle of 64 x 65 / 2 doubles, and a state of two matrices for every 64 entries passed.
  EXPECT_GT(one, 2080 * sizeof(double));
  EXPECT_LT(one, entries / 64 * 2 * 4096 * sizeof(double) + 20'000);
}

}  // namespace
}  // namespace freqsynth
