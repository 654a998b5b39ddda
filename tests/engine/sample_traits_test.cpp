// SPDX-License-Identifier: MIT
#include "freqsynth/sample_traits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "freqsynth/synthesizer.h"
#include "support/engine_helpers.h"

namespace {

using helpers::picture;

// What hosts have.
struct Rgb {
  float r, g, b;
};
struct Doubles {
  double e[3];
};
struct Nested {
  Rgb colours[2];
  float alpha[2];
};
struct alignas(16) Float4 {
  float x, y, z, w;
};
struct Luminance {
  double value;
};
/// With constructors and an index, but no size.
class Vec3 {
 public:
  Vec3(double x, double y, double z) : e_{x, y, z} {}
  double operator[](int i) const { return e_[i]; }

 private:
  double e_[3];
};
/// With a size of its own, as std::array has it.
class Sized {
 public:
  Sized(float a, float b) : values_{a, b} {}
  float operator[](std::size_t i) const { return values_[i]; }

 private:
  float values_[2];
};
/// Three floats, of which a sample has two: what is described goes first.
struct Padded {
  float a, b, unused;
};

// What is no sample, though some looks like it.
struct Mixed {
  float a;
  double b;
};
struct WithInteger {
  float a;
  int b;
};
struct WithPointer {
  float a, b;
  float* c;
};
struct alignas(16) Float3 {
  float x, y, z;
};
struct Gap {
  float a;
  alignas(8) float b;
  float c;
};
struct WithBytes {
  float a;
  char b[4];
};
struct Empty {};
struct NoSize {
  NoSize() = default;
  explicit NoSize(float a) : e{a} {}
  float operator[](std::size_t) const { return e; }
  float e = 0;
};
struct NoChannels {};

}  // namespace

template <>
struct freqsynth::SampleTraits<Vec3> {
  static constexpr std::size_t channels = 3;
  static double value(const Vec3& sample, std::size_t channel) {
    return sample[static_cast<int>(channel)];
  }
};
template <>
struct freqsynth::SampleTraits<Padded> {
  static constexpr int channels = 2;
  static float value(const Padded& sample, std::size_t channel) {
    return channel == 0 ? sample.a : sample.b;
  }
};
template <>
struct freqsynth::SampleTraits<NoChannels> {
  static constexpr int channels = 0;
  static float value(const NoChannels&, std::size_t) { return 0; }
};
template <>
struct std::tuple_size<Sized> : std::integral_constant<std::size_t, 2> {};

namespace freqsynth {
namespace {

using helpers::at_samples;
using helpers::settings_of;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Channels of a type, 0 for one that is no sample.
template <class T>
constexpr std::size_t channels_of() {
  if constexpr (detail::SampleAccess<T>::valid) {
    return detail::SampleAccess<T>::channels;
  } else {
    return 0;
  }
}

static_assert(channels_of<float>() == 1 && channels_of<int>() == 1 && channels_of<double>() == 1);
static_assert(channels_of<std::array<float, 5>>() == 5 && channels_of<std::array<int, 2>>() == 2);
static_assert(channels_of<Rgb>() == 3 && channels_of<Doubles>() == 3);
static_assert(channels_of<Nested>() == 8 && channels_of<Float4>() == 4);
static_assert(channels_of<Luminance>() == 1);
static_assert(channels_of<Vec3>() == 3 && channels_of<Sized>() == 2 && channels_of<Padded>() == 2);

static_assert(channels_of<Mixed>() == 0 && channels_of<WithInteger>() == 0);
static_assert(channels_of<WithPointer>() == 0 && channels_of<WithBytes>() == 0);
static_assert(channels_of<Float3>() == 0 && channels_of<Gap>() == 0, "padding is no channel");
static_assert(channels_of<Empty>() == 0 && channels_of<NoSize>() == 0);
static_assert(channels_of<NoChannels>() == 0 && channels_of<void>() == 0);
static_assert(channels_of<std::array<float, 0>>() == 0 && channels_of<std::string>() == 0);
static_assert(channels_of<std::array<Rgb, 2>>() == 0 || channels_of<std::array<Rgb, 2>>() == 6);
static_assert(channels_of<std::pair<float, float>>() == 0 && channels_of<float*>() == 0);
static_assert(channels_of<std::complex<float>>() == 0);

template <class F>
FrequencyImage image_of(F&& sampler, std::size_t channels) {
  Synthesizer engine(settings_of(40, 32, channels));
  engine.run(sampler, at_samples(300));
  EXPECT_EQ(engine.stats().samples, 300u);
  return engine.image();
}

/// Channel c of all samples of these tests.
float channel(std::size_t c, double x, double y) { return picture(x + static_cast<double>(c), y); }

template <std::size_t N>
std::array<float, N> numbers(double x, double y) {
  std::array<float, N> all{};
  for (std::size_t c = 0; c < N; ++c) all[c] = channel(c, x, y);
  return all;
}

TEST(SampleTraits, AllTypesGiveTheSameImage) {
  const auto same = [](auto&& sampler, auto&& expected, std::size_t channels) {
    EXPECT_TRUE(helpers::same_image(image_of(sampler, channels), image_of(expected, channels)));
  };
  const auto at = [](std::size_t c, double x, double y) { return double{channel(c, x, y)}; };
  same(
      [](double x, double y) {
        return Rgb{channel(0, x, y), channel(1, x, y), channel(2, x, y)};
      },
      numbers<3>, 3);
  same(
      [](const Request& r) {
        return Rgb{channel(0, r.x, r.y), channel(1, r.x, r.y), channel(2, r.x, r.y)};
      },
      numbers<3>, 3);
  same(
      [&](double x, double y) {
        return Doubles{{at(0, x, y), at(1, x, y), at(2, x, y)}};
      },
      numbers<3>, 3);
  same([&](double x, double y) { return Vec3(at(0, x, y), at(1, x, y), at(2, x, y)); }, numbers<3>,
       3);
  same(
      [](double x, double y) {
        const auto v = numbers<8>(x, y);
        return Nested{{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, {v[6], v[7]}};
      },
      numbers<8>, 8);
  same(
      [](double x, double y) {
        const auto v = numbers<4>(x, y);
        return Float4{v[0], v[1], v[2], v[3]};
      },
      numbers<4>, 4);
  same([](double x, double y) { return Sized(channel(0, x, y), channel(1, x, y)); }, numbers<2>, 2);
  same(
      [](double x, double y) {
        return Padded{channel(0, x, y), channel(1, x, y), 1e9f};
      },
      numbers<2>, 2);
  same([&](double x, double y) { return Luminance{at(0, x, y)}; }, numbers<1>, 1);
  // As a constant and as a reference.
  const Rgb grey{0.5f, 0.25f, 1};
  same([&](double, double) -> const Rgb& { return grey; },
       [](double, double) {
         return std::array{0.5f, 0.25f, 1.0f};
       },
       3);
}

TEST(SampleTraits, NumberOfChannelsIsChecked) {
  Synthesizer engine(settings_of(16, 16, 4));
  EXPECT_THAT([&] { engine.run([](double, double) { return Rgb{}; }, at_samples(10)); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("the sampler returns 3 values for 4 channels")));
}

/// Writes three channels, each sample `stride` floats after the one before, and rubbish between.
struct StridedHost {
  std::size_t stride;

  void operator()(std::span<const Request> requests, std::span<float> values) const {
    EXPECT_EQ(values.size(), requests.size() * stride);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(values.data()) % 16, 0u) << "for vectors of four";
    for (std::size_t i = 0; i < requests.size(); ++i) {
      for (std::size_t c = 0; c < stride; ++c) {
        values[i * stride + c] = c < 3 ? channel(c, requests[i].x, requests[i].y) : 1e30f;
      }
    }
  }
};

TEST(Strided, BatchSamplersGiveTheSameImage) {
  const FrequencyImage expected = image_of(numbers<3>, 3);
  for (const std::size_t stride : {4u, 8u, 16u}) {
    EXPECT_TRUE(helpers::same_image(image_of(strided(stride, StridedHost{stride}), 3), expected));
    const auto constant = strided(stride, StridedHost{stride});
    EXPECT_TRUE(helpers::same_image(image_of(constant, 3), expected));
  }
  const auto packed = [](std::span<const Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = channel(i % 3, requests[i / 3].x, requests[i / 3].y);
    }
  };
  EXPECT_TRUE(helpers::same_image(image_of(strided(3, packed), 3), expected));
  EXPECT_TRUE(helpers::same_image(image_of(strided(0, packed), 3), expected));
}

TEST(Strided, StrideOfASamplerIsChecked) {
  Synthesizer engine(settings_of(16, 16, 3));
  for (const std::size_t stride : {1u, 2u}) {
    EXPECT_THAT([&] { engine.run(strided(stride, StridedHost{stride}), at_samples(10)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(
                    "stride is " + std::to_string(stride) + ", not at least the number of chan")));
  }
  EXPECT_EQ(engine.stats().samples, 0u);
}

TEST(Strided, ThatForgetsASampleIsNoticed) {
  Synthesizer engine(settings_of(40, 32, 3));
  engine.run(strided(4, [](std::span<const Request>, std::span<float>) {}), at_samples(100));
  EXPECT_EQ(engine.stopped(), StopReason::unusable);
}

TEST(Strided, DeliveriesGiveTheSameImage) {
  const FrequencyImage expected = image_of(numbers<3>, 3);
  for (const std::size_t stride : {0u, 3u, 4u, 7u}) {
    for (const bool whole : {true, false}) {
      Synthesizer engine(settings_of(40, 32, 3));
      engine.set_stop(at_samples(300));
      std::vector<Request> requests(5);
      while (const std::size_t count = engine.request(requests)) {
        const std::size_t apart = stride == 0 ? 3 : stride;
        std::vector<float> values(count * apart - (whole ? 0 : apart - 3), 1e30f);
        for (std::size_t i = 0; i < count; ++i) {
          for (std::size_t c = 0; c < 3; ++c) {
            values[i * apart + c] = channel(c, requests[i].x, requests[i].y);
          }
        }
        engine.deliver(std::span<const Request>(requests).first(count), values, stride);
      }
      EXPECT_TRUE(helpers::same_image(engine.image(), expected));
    }
  }
}

TEST(Strided, SizesOfDeliveriesAreChecked) {
  Synthesizer engine(settings_of(40, 32, 3, 20));
  std::vector<Request> requests(5);
  ASSERT_EQ(engine.request(requests), 5u);
  const std::vector<float> values(100, 0.5f);
  const auto refused = [&](std::size_t size, std::size_t stride, const std::string& why) {
    EXPECT_THAT([&] { engine.deliver(requests, std::span(values).first(size), stride); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refused(18, 4, "18 values for 5 requests of 3 channels, each 4 apart");
  refused(21, 4, "21 values for 5 requests of 3 channels, each 4 apart");
  refused(14, 3, "14 values for 5 requests of 3 channels");
  refused(16, 0, "16 values for 5 requests of 3 channels");
  refused(10, 2, "stride is 2, not at least the number of channels");
  EXPECT_THROW(engine.deliver({}, values, 4), std::invalid_argument);
  engine.deliver({}, {}, 4);
  EXPECT_EQ(engine.stats().samples, 0u);
  engine.deliver(requests, std::span(values).first(19), 4);
  EXPECT_EQ(engine.stats().samples, 5u);
}

}  // namespace
}  // namespace freqsynth
