// SPDX-License-Identifier: MIT
// Pictures of the renderer on Embree.

#include "embree/rendering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace embree_host {
namespace {

constexpr std::size_t width = 75, height = 43;

const Renderer& colonnade() {
  static const Renderer renderer = [] {
    View view;
    Model model = make_colonnade(view);
    return Renderer(Geometry(std::move(model)), view, {}, width, height);
  }();
  return renderer;
}

bool go_on(const freqsynth::Progress& /*progress*/) { return true; }

Job job_of(double samples, std::uint64_t frame = 0) { return {width, height, samples, frame}; }

Pixels adaptive(double samples, std::uint64_t frame = 0, std::size_t threads = 2) {
  HostPool pool = make_pool(threads);
  return render_adaptively(colonnade(), job_of(samples, frame), pool, go_on);
}

Pixels plain(double samples, path_tracer::Numbers numbers, std::uint64_t frame = 0,
             std::size_t threads = 2) {
  HostPool pool = make_pool(threads);
  return render_plainly(colonnade(), job_of(samples, frame), numbers, pool, go_on);
}

double error_of(const Pixels& a, const Pixels& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % channels < 3) sum += std::pow(double{a[i]} - double{b[i]}, 2);
  }
  return std::sqrt(sum / (3.0 * width * height));
}

TEST(EmbreeRendering, IsTheSameForAnyNumberOfThreads) {
  const Pixels one = adaptive(2, 0, 1);
  EXPECT_EQ(one, adaptive(2, 0, 2));
  EXPECT_EQ(one, adaptive(2, 0, 3));
  EXPECT_NE(one, adaptive(2, 1, 1)) << "another frame";
  for (const auto numbers : {path_tracer::Numbers::random, path_tracer::Numbers::sobol}) {
    const Pixels single = plain(2, numbers, 0, 1);
    EXPECT_EQ(single, plain(2, numbers, 0, 3));
    EXPECT_NE(single, plain(2, numbers, 1, 1));
  }
}

TEST(EmbreeRendering, ASampleDoesNotDependOnItsBatch) {
  std::vector<freqsynth::Request> requests;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    freqsynth::Request request;
    request.x = 0.07 * i;
    request.y = std::fmod(0.618 * i, 1) * height;
    request.pixel = i / 3;
    request.ordinal = i % 3;
    request.seed = scenes::mix_bits(i);
    request.spacing = 1;
    requests.push_back(request);
  }
  const Sampler sampler{colonnade()};
  std::vector<float> together(requests.size() * channels), alone = together;
  sampler(requests, together);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    sampler(std::span(requests).subspan(i, 1), std::span(alone).subspan(i * channels, channels));
  }
  EXPECT_EQ(together, alone);
}

TEST(EmbreeRendering, ComesToTheSamePictureInAllWays) {
  const Pixels truth = plain(256, path_tracer::Numbers::sobol, 9);
  const double random = error_of(plain(4, path_tracer::Numbers::random), truth);
  const double sobol = error_of(plain(4, path_tracer::Numbers::sobol), truth);
  const double by_engine = error_of(adaptive(4), truth);
  EXPECT_LT(sobol, random);
  EXPECT_LT(by_engine, sobol);
  EXPECT_LT(error_of(plain(64, path_tracer::Numbers::random), truth), 0.4 * random);
  EXPECT_LT(error_of(adaptive(64), truth), 0.6 * by_engine);
}

TEST(EmbreeRendering, ChannelsAreThoseOfTheFirstSurface) {
  const Pixels truth = plain(64, path_tracer::Numbers::sobol), pixels = adaptive(16);
  // The sky at the top, the floor near the bottom, left of the middle.
  const auto at = [](std::size_t x, std::size_t y) { return (y * width + x) * channels; };
  const std::size_t sky = at(37, 2), floor = at(30, 37);
  for (const Pixels& picture : {truth, pixels}) {
    EXPECT_EQ(picture[sky + 10], std::numeric_limits<float>::infinity());
    EXPECT_NEAR(picture[sky + 3], 0, 1e-3);
    EXPECT_NEAR(picture[floor + 8], 1, 1e-3) << "upwards";
    EXPECT_GT(picture[floor + 10], 3);
    EXPECT_LT(picture[floor + 10], 20);
  }
  double difference = 0;
  for (std::size_t i = 0; i < truth.size(); i += channels) {
    for (std::size_t c = 3; c < 10; ++c) {
      difference += std::abs(double{truth[i + c]} - double{pixels[i + c]});
    }
  }
  EXPECT_LT(difference / (7 * width * height), 0.02);
}

TEST(EmbreeRendering, EndsEarlyWhenAsked) {
  HostPool pool = make_pool(2);
  int calls = 0;
  const Watch twice = [&](const freqsynth::Progress& progress) {
    EXPECT_GT(progress.fraction, 0);
    EXPECT_LT(progress.fraction, 1);
    EXPECT_GT(progress.seconds_left, 0);
    return ++calls < 2;
  };
  const Pixels pixels = render_adaptively(colonnade(), job_of(64), pool, twice);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(pixels.size(), width * height * channels);
  calls = 0;
  (void)render_plainly(colonnade(), job_of(64), path_tracer::Numbers::sobol, pool, twice);
  EXPECT_EQ(calls, 2);
}

TEST(EmbreeRendering, GoesOnWhereItWasInterruptedToTheBit) {
  const std::string file = testing::TempDir() + "embree_state";
  HostPool pool = make_pool(2);
  int calls = 0;
  const Watch some = [&](const freqsynth::Progress&) { return ++calls < 7; };
  const Pixels part = render_adaptively(colonnade(), job_of(2), pool, some, {"test", file, 1e9});
  const Pixels whole =
      render_adaptively(colonnade(), job_of(2), pool, go_on, no_checkpoint(), file);
  EXPECT_NE(part, whole);
  EXPECT_EQ(whole, adaptive(2));
  EXPECT_THROW(
      (void)render_adaptively(colonnade(), job_of(2, 1), pool, go_on, no_checkpoint(), file),
      std::runtime_error)
      << "another frame";
  std::remove(file.c_str());
}

TEST(EmbreeRendering, PlainSamplersRefuseFractions) {
  EXPECT_THROW((void)plain(0.5, path_tracer::Numbers::sobol), std::invalid_argument);
  EXPECT_THROW((void)plain(1.5, path_tracer::Numbers::sobol), std::invalid_argument);
}

}  // namespace
}  // namespace embree_host
