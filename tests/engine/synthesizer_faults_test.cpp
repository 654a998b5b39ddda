// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"
#include "support/oracles.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::Point;
using helpers::settings_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

class BadValue : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Values, BadValue,
                         testing::Values(nan, infinity, -infinity, 1e38f, -3e38f));

TEST_P(BadValue, RegionInsideABlockLeavesAllOtherBlocksAlone) {
  // With the same number of samples everywhere the choice of blocks plays no part.
  SynthesisSettings settings = settings_of(40, 32);
  settings.max_samples_per_block = 81;
  Synthesizer clean(settings), engine(settings);
  clean.run(picture, StopRule{});
  std::set<Point> bad;
  engine.run(
      [&](double x, double y) {
        const bool inside = std::hypot(x - 20, y - 12) < 3.9;  // in block (2, 1)
        if (inside) bad.insert({x, y});
        return inside ? GetParam() : picture(x, y);
      },
      StopRule{});
  EXPECT_EQ(engine.stats().bad_samples, bad.size());
  EXPECT_GT(bad.size(), 36u) << "45 were measured";
  const FrequencyImage image = engine.image(), expected = clean.image();
  EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(image)));
  for (std::size_t y = 0; y < 4; ++y) {
    for (std::size_t x = 0; x < 5; ++x) {
      EXPECT_EQ(image.samples(x, y), 81u);
      if (x == 2 && y == 1) continue;
      const auto block = image.coefficients(x, y, 0), same = expected.coefficients(x, y, 0);
      EXPECT_TRUE(std::equal(block.begin(), block.end(), same.begin())) << x << ", " << y;
    }
  }
}

TEST_P(BadValue, PointsAreCountedOnceAndReported) {
  for (const std::size_t wave : {1u, 0u, 500u}) {
    Synthesizer engine(settings_of(48, 48, 2, wave));
    std::set<Point> expected;
    engine.run(
        [&](double x, double y) {
          const bool is_bad = x >= 16 && x <= 32 && y >= 8 && y <= 32;  // borders and corners
          if (is_bad) expected.insert({x, y});
          return std::array{picture(x, y), is_bad ? GetParam() : picture(y, x)};
        },
        at_samples(2500));
    std::set<Point> reported;
    std::set<std::uint64_t> ids;
    for (const BadSample& sample : engine.bad_samples()) {
      reported.insert({sample.x, sample.y});
      ids.insert(sample.id);
    }
    EXPECT_EQ(reported, expected);
    EXPECT_EQ(engine.stats().bad_samples, expected.size());
    EXPECT_EQ(ids.size(), expected.size());
    EXPECT_EQ(engine.stats().samples, 2500u);
    EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine.image())));
  }
}

TEST_P(BadValue, NearlyEverywhereIsABlackImage) {
  Synthesizer engine(settings_of(40, 24));
  const auto sampler = [](double x, double y) { return x == 0 && y == 0 ? 0 : GetParam(); };
  EXPECT_EQ(engine.run(sampler, at_samples(3000)).reason, StopReason::samples);
  EXPECT_EQ(engine.stats().bad_samples, 2999u);
  EXPECT_EQ(engine.bad_samples().size(), 1000u) << "the list is limited, the count is not";
  for (const float value : helpers::coefficients_of(engine.image())) ASSERT_EQ(value, 0);
}

TEST(Faults, HugeValuesDoNotStopTheSynthesis) {
  for (const float scale : {1e12f, 1e30f, 1e36f, 1e37f}) {
    Synthesizer engine(settings_of(48, 40));
    // At the last scale only what is near 0 is usable, and there is some of it.
    const auto function = [&](double x, double y) {
      return (x < 8 ? 1e-3f : scale) * (picture(x, y) - 1);
    };
    const auto reason = engine.run(function, at_samples(4000)).reason;
    EXPECT_EQ(reason, StopReason::samples) << "scale " << scale;
    EXPECT_EQ(engine.stats().samples, 4000u);
    EXPECT_TRUE(helpers::all_finite(helpers::coefficients_of(engine.image())));
  }
}

struct SamplerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST(Faults, SamplerThatThrowsLeavesAnEngineThatGoesOn) {
  Synthesizer straight(settings_of(44, 40));
  straight.run(picture, at_samples(900));
  for (const std::size_t batch : {1u, 10u, 1024u}) {
    for (const std::size_t fatal : {1u, 2u, 50u, 333u, 900u}) {
      Synthesizer engine(settings_of(44, 40));
      std::size_t calls = 0;
      const auto sampler = [&](double x, double y) {
        if (++calls == fatal) throw SamplerError("lamp is broken");
        return picture(x, y);
      };
      const auto run = [&] {
        engine.run(sampler, at_samples(900), SerialExecutor{}, KeepGoing{}, batch);
      };
      EXPECT_THAT(run, ThrowsMessage<SamplerError>(HasSubstr("lamp")));
      EXPECT_EQ(helpers::calls_of(engine), fatal - 1) << "what was returned before is delivered";
      run();
      EXPECT_EQ(calls, helpers::calls_of(engine) + 1) << "only the failed call is repeated";
      EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
    }
  }
}

TEST(Faults, BatchSamplerThatThrowsLosesItsBatchOnly) {
  Synthesizer straight(settings_of(44, 40)), engine(settings_of(44, 40));
  straight.run(picture, at_samples(900));
  std::size_t delivered = 0, calls = 0;
  const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      values[i] = picture(requests[i].x, requests[i].y);
    }
    if (++calls % 10 == 0) throw SamplerError("no connection");
    delivered += requests.size();
  };
  int failures = 0;
  while (engine.stopped() != StopReason::samples) {
    try {
      engine.run(sampler, at_samples(900));
    } catch (const SamplerError&) {
      ++failures;
    }
    ASSERT_EQ(helpers::calls_of(engine), delivered);
  }
  EXPECT_GT(failures, 50) << "62 were measured";
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

TEST(Faults, SamplerMayThrowOnAnyThread) {
  Synthesizer straight(settings_of(64, 64, 1, 40));
  straight.run(picture, at_samples(1500));
  Synthesizer engine(settings_of(64, 64, 1, 40));
  ThreadPool pool(4);
  std::atomic<int> calls = 0, returned = 0;
  const auto sampler = [&](double x, double y) {
    if (++calls % 97 == 0) throw SamplerError("out of memory");
    ++returned;
    return picture(x, y);
  };
  int failures = 0;
  while (engine.stopped() != StopReason::samples) {
    try {
      engine.run(sampler, at_samples(1500), pool);
    } catch (const SamplerError&) {
      ++failures;
    }
    ASSERT_EQ(helpers::calls_of(engine), static_cast<std::uint64_t>(returned.load()));
  }
  EXPECT_GE(failures, 12) << "15 throws, of which two may fall into one run";
  EXPECT_TRUE(helpers::same_image(engine.image(), straight.image()));
}

/// An engine of which one wave of 20 samples is in the host's hands: some are asked for twice.
class Misuse : public testing::Test {
 protected:
  Misuse() : engine_(settings_of(40, 32, 1, 20)), requests_(100) {
    engine_.set_stop(at_samples(500));
    requests_.resize(engine_.request(requests_));
    EXPECT_GE(requests_.size(), 23u);
    for (const Request& request : requests_) values_.push_back(picture(request.x, request.y));
  }

  /// Everything goes on as if the mistake had not been made.
  void expect_unharmed() {
    engine_.deliver(requests_, values_);
    engine_.run(picture, at_samples(500));
    Synthesizer straight(settings_of(40, 32, 1, 20));
    straight.run(picture, at_samples(500));
    EXPECT_EQ(engine_.stats().samples, 500u);
    EXPECT_TRUE(helpers::same_image(engine_.image(), straight.image()));
  }

  void expect_refused(const std::vector<Request>& requests, const std::string& reason) {
    const std::vector<float> values(requests.size(), 7.0f);
    EXPECT_THAT([&] { engine_.deliver(requests, values); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(reason)));
    EXPECT_THAT([&] { engine_.give_back(requests); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(reason)));
    EXPECT_EQ(engine_.stats().samples, 0u);
  }

  Synthesizer engine_;
  std::vector<Request> requests_;
  std::vector<float> values_;
};

TEST_F(Misuse, UnknownIdIsRefused) {
  Request wrong = requests_[3];
  wrong.id += 1234567;
  expect_refused({requests_[0], requests_[1], wrong}, std::to_string(wrong.id));
  expect_unharmed();
}

TEST_F(Misuse, UnknownSlotIsRefused) {
  Request wrong = requests_[3];
  const auto beyond = static_cast<std::uint32_t>(requests_.size());
  for (const std::uint32_t slot : {4u, beyond, 0xffffffffu}) {
    wrong.slot = slot;
    expect_refused({requests_[0], wrong}, std::to_string(wrong.id));
  }
  expect_unharmed();
}

TEST_F(Misuse, SameRequestTwiceInOneCallIsRefused) {
  expect_refused({requests_[0], requests_[5], requests_[0]}, std::to_string(requests_[0].id));
  expect_unharmed();
}

TEST_F(Misuse, SecondDeliveryIsRefused) {
  engine_.deliver(std::span(requests_).first(2), std::span(values_).first(2));
  for (const Request& request : {requests_[0], requests_[1]}) {
    EXPECT_THAT([&] { engine_.deliver(std::span(&request, 1), std::array{5.0f}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(std::to_string(request.id))));
  }
  EXPECT_EQ(engine_.stats().samples, 2u);
  requests_.erase(requests_.begin(), requests_.begin() + 2);
  values_.erase(values_.begin(), values_.begin() + 2);
  expect_unharmed();
}

TEST_F(Misuse, DeliveryAfterGivingBackIsRefused) {
  engine_.give_back(std::span(requests_).last(1));
  expect_refused({requests_.back()}, std::to_string(requests_.back().id));
  std::vector<Request> again(5);
  ASSERT_EQ(engine_.request(again), 1u) << "it is handed out again";
  EXPECT_EQ(again[0].id, requests_.back().id);
  EXPECT_EQ(again[0].x, requests_.back().x);
  expect_unharmed();
}

TEST_F(Misuse, RequestOfAnEarlierWaveIsRefused) {
  const std::vector<Request> old = requests_;
  engine_.deliver(requests_, values_);
  requests_.resize(100);
  requests_.resize(engine_.request(requests_));
  ASSERT_GE(requests_.size(), 20u);
  EXPECT_THROW(engine_.deliver(old, values_), std::invalid_argument);
  values_.clear();
  for (const Request& request : requests_) values_.push_back(picture(request.x, request.y));
  expect_unharmed();
}

TEST_F(Misuse, WrongNumberOfValuesIsRefused) {
  const std::string all = std::to_string(values_.size());
  EXPECT_THAT([&] { engine_.deliver(requests_, std::span(values_).first(19)); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("19"), HasSubstr(all))));
  EXPECT_THROW(engine_.deliver(std::span(requests_).first(3), values_), std::invalid_argument);
  EXPECT_EQ(engine_.stats().samples, 0u);
  expect_unharmed();
}

TEST_F(Misuse, RunWaitsForRequestsInOtherHands) {
  int calls = 0;
  const auto sampler = [&](double x, double y) {
    ++calls;
    return picture(x, y);
  };
  EXPECT_EQ(engine_.run(sampler, at_samples(500)).reason, StopReason::waiting);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(engine_.stopped(), StopReason::waiting);
  expect_unharmed();
}

TEST_F(Misuse, EmptyCallsDoNothing) {
  engine_.deliver({}, {});
  engine_.give_back({});
  EXPECT_EQ(engine_.request({}), 0u);
  EXPECT_EQ(engine_.stats().samples, 0u);
  expect_unharmed();
}

}  // namespace
}  // namespace freqsynth
