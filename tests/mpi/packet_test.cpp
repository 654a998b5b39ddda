// SPDX-License-Identifier: MIT
#include "mpi/packet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "freqsynth/synthesizer.h"

namespace farm {
namespace {

/// Requests of all kinds, those on the image's borders included.
std::vector<freqsynth::Request> some_requests(std::size_t width, std::size_t height) {
  freqsynth::Synthesizer engine({.width = width, .height = height, .channels = 1, .seed = 3});
  std::vector<freqsynth::Request> all;
  engine.run(
      [&](const freqsynth::Request& request) {
        all.push_back(request);
        return std::sin(request.x * request.y) + static_cast<double>(request.seed >> 60);
      },
      {.samples_per_pixel = 3});
  return all;
}

TEST(Packet, BringsWhatWasAskedForAndNoMore) {
  const auto requests = some_requests(61, 43);
  ASSERT_GT(requests.size(), 61u * 43u);
  for (int bits = 0; bits < 16; ++bits) {
    const Fields fields{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
    const PacketFormat format{61, 43, 3, fields};
    std::vector<std::byte> bytes;
    format.encode(requests, bytes);
    EXPECT_EQ(bytes.size(), requests.size() * format.request_bytes());
    std::vector<freqsynth::Request> there(5);
    format.decode(bytes, there);
    ASSERT_EQ(there.size(), requests.size());
    for (std::size_t i = 0; i < there.size(); ++i) {
      const freqsynth::Request& one = requests[i];
      EXPECT_EQ(there[i].x, one.x);
      EXPECT_EQ(there[i].y, one.y);
      EXPECT_EQ(there[i].ordinal, fields.ordinal ? one.ordinal : 0);
      EXPECT_EQ(there[i].pixel, fields.ordinal ? one.pixel : 0) << one.x << ' ' << one.y;
      EXPECT_EQ(there[i].seed, fields.seed ? one.seed : 0);
      EXPECT_EQ(there[i].id, fields.id ? one.id : 0);
      EXPECT_EQ(there[i].spacing, fields.spacing ? one.spacing : 0);
    }
  }
}

TEST(Packet, TakesAsFewBytesAsDocumented) {
  EXPECT_EQ((PacketFormat{1, 1, 3, {}}.request_bytes()), 16u);
  EXPECT_EQ((PacketFormat{1, 1, 3, {.ordinal = true}}.request_bytes()), 20u);
  EXPECT_EQ((PacketFormat{1, 1, 3, {}}.value_bytes()), 12u);
}

TEST(Packet, TellsErrors) {
  std::vector<std::byte> answer;
  put_error(answer, "no texture");
  ASSERT_GT(answer.size(), sizeof(AnswerHeader));
  EXPECT_EQ(text_of(std::span(answer).subspan(sizeof(AnswerHeader))), "no texture");
}

}  // namespace
}  // namespace farm
