// SPDX-License-Identifier: MIT
#include "freqsynth/sampler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::picture;
using helpers::settings_of;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Which form a function is, and that no other is seen in it.
template <class F>
constexpr int form_of() {
  return (ScalarSampler<F> ? 1 : 0) + (RequestSampler<F> ? 10 : 0) + (BatchSampler<F> ? 100 : 0);
}

constexpr auto generic = [](auto x, auto y) { return 0.25 * x + 0.125 * y; };
constexpr auto of_floats = [](float x, float y) { return x + y; };
constexpr auto of_integers = [](int x, int y) { return x + y; };
constexpr auto half_integer = [](double x, std::size_t y) { return x + static_cast<double>(y); };
constexpr auto of_request = [](const Request& r) { return r.x + r.y; };
constexpr auto of_batch = [](std::span<const Request>, std::span<float>) {};
constexpr auto of_structs = [](double, double) {
  struct Rgb {
    float r, g, b;
  };
  return Rgb{};
};
constexpr auto of_strings = [](double, double) { return std::string(); };
double plain_function(double x, double y) { return x + y; }

static_assert(form_of<decltype(generic)>() == 1);
static_assert(form_of<decltype(of_floats)>() == 1);
static_assert(form_of<decltype(plain_function)>() == 1);
static_assert(form_of<decltype(&plain_function)>() == 1);
static_assert(form_of<decltype(of_request)>() == 10);
static_assert(form_of<decltype(of_batch)>() == 100);
static_assert(form_of<decltype(of_integers)>() == 0);
static_assert(form_of<decltype(half_integer)>() == 0);
static_assert(form_of<decltype(of_structs)>() == 1);
static_assert(form_of<decltype(of_strings)>() == 0);
static_assert(form_of<decltype(strided(4, of_batch))>() == 100);
static_assert(form_of<const decltype(strided(4, of_batch))>() == 100);

template <class F>
FrequencyImage image_of(F&& sampler, std::size_t channels = 1) {
  Synthesizer engine(settings_of(40, 32, channels));
  engine.run(sampler, at_samples(300));
  EXPECT_EQ(engine.stats().samples, 300u);
  return engine.image();
}

TEST(SamplerForms, AllFormsOfAFunctionGiveTheSameImage) {
  const FrequencyImage expected = image_of([](double x, double y) { return 0.25 * x + 0.125 * y; });
  EXPECT_TRUE(helpers::same_image(image_of(generic), expected));
  EXPECT_TRUE(helpers::same_image(
      image_of([](const Request& r) { return std::array{0.25 * r.x + 0.125 * r.y}; }), expected));
  EXPECT_TRUE(helpers::same_image(
      image_of([](std::span<const Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          values[i] = static_cast<float>(0.25 * requests[i].x + 0.125 * requests[i].y);
        }
      }),
      expected));
  const FrequencyImage sum = image_of([](double x, double y) { return x + y; });
  EXPECT_TRUE(helpers::same_image(image_of(plain_function), sum));
  EXPECT_TRUE(helpers::same_image(image_of(&plain_function), sum));
}

TEST(SamplerForms, ByRequestSeesWhatABatchSees) {
  std::set<std::uint64_t> one_by_one, in_batches;
  std::size_t asked = 0;
  image_of([&](const Request& r) {
    EXPECT_GT(r.spacing, 0);
    one_by_one.insert(r.id);
    asked += r.again ? 0 : 1;
    return picture(r.x, r.y);
  });
  image_of([&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      in_batches.insert(requests[i].id);
      values[i] = picture(requests[i].x, requests[i].y);
    }
  });
  EXPECT_EQ(asked, 300u);
  EXPECT_EQ(one_by_one, in_batches);
}

TEST(SamplerForms, NumberOfChannelsIsCheckedForAllThatSayIt) {
  Synthesizer engine(settings_of(16, 16, 2));
  const auto refused = [&](auto&& sampler) {
    EXPECT_THAT([&] { engine.run(sampler, at_samples(10)); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr("the sampler returns 3 values for 2 channels")));
  };
  refused([](double, double) { return std::array<float, 3>{}; });
  refused([](const Request&) { return std::array<double, 3>{}; });
  EXPECT_EQ(engine.stats().samples, 0u);
}

TEST(BatchSampler, ThatDoesNotWriteIsNoticed) {
  // Each batch leaves out every third request: as a renderer that has lost a packet. Where a point
  // was asked for twice, one value will do.
  Synthesizer engine(settings_of(40, 32, 3, 20));
  std::set<helpers::Point> all, written;
  const auto sampler = [&](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      all.insert({requests[i].x, requests[i].y});
      if (i % 3 == 2) continue;
      written.insert({requests[i].x, requests[i].y});
      for (std::size_t c = 0; c < 3; ++c) {
        values[3 * i + c] = picture(requests[i].x, requests[i].y);
      }
    }
  };
  engine.run(sampler, at_samples(600), SerialExecutor{}, KeepGoing{}, 50);
  EXPECT_EQ(all.size(), 600u);
  EXPECT_LT(written.size(), 550u);
  EXPECT_EQ(engine.stats().bad_samples, all.size() - written.size());
}

TEST(BatchSampler, ThatNeverWritesIsUnusable) {
  Synthesizer engine(settings_of(40, 32, 3));
  EXPECT_EQ(engine.run(of_batch, at_samples(600)).reason, StopReason::unusable);
}

TEST(UsableSample, IsToldFromTheBits) {
  EXPECT_TRUE(is_usable_sample(0));
  EXPECT_TRUE(is_usable_sample(-0.0f));
  EXPECT_TRUE(is_usable_sample(max_sample_magnitude));
  EXPECT_TRUE(is_usable_sample(-max_sample_magnitude));
  EXPECT_TRUE(is_usable_sample(1e-45f));
  EXPECT_FALSE(is_usable_sample(std::nextafter(max_sample_magnitude, 2e36f)));
  EXPECT_FALSE(is_usable_sample(-std::nextafter(max_sample_magnitude, 2e36f)));
  EXPECT_FALSE(is_usable_sample(std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(is_usable_sample(-std::numeric_limits<float>::infinity()));
  EXPECT_FALSE(is_usable_sample(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(is_usable_sample(-std::numeric_limits<float>::signaling_NaN()));
}

}  // namespace
}  // namespace freqsynth
