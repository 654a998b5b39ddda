// SPDX-License-Identifier: MIT
#include "freqsynth/basis/archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/handmade_archive.h"

namespace freqsynth {
namespace {

using detail::StateReader;
using detail::StateWriter;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::Bytes;
using testing_support::HandmadeArchive;

constexpr detail::ArchiveKind kind{"saved thing", "THNG", 7};

enum class Colour : std::uint8_t { red, green };

struct Thing {
  std::uint16_t small = 0;
  std::int32_t negative = 0;
  std::uint64_t large = 0;
  float real = 0;
  double fine = 0;
  bool flag = false;
  Colour colour = Colour::red;
  std::size_t size = 0;
  std::vector<float> fixed = std::vector<float>(3);
  std::vector<std::uint32_t> some;
  std::vector<std::vector<float>> nested;

  template <class Archive, class Self>
  static void archive(Archive& archive, Self& self) {
    archive.section("ONE ", [&] {
      archive.number(self.small);
      archive.number(self.negative);
      archive.number(self.large);
      archive.number(self.real);
      archive.number(self.fine);
      archive.number(self.flag);
      archive.number(self.colour);
      archive.count(self.size);
    });
    archive.section("TWO ", [&] {
      archive.array(self.fixed);
      archive.list(self.some, 100000);
      archive.list(self.nested, 4, [&](auto& one) { archive.list(one, 2); });
    });
    archive.finish();
  }
};

Bytes save(const Thing& thing) {
  Bytes bytes;
  const auto sink = [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  StateWriter writer(sink, kind);
  Thing::archive(writer, thing);
  return bytes;
}

Thing load(ByteSource source) {
  Thing thing;
  StateReader reader(source, kind);
  Thing::archive(reader, thing);
  return thing;
}

Thing example() {
  Thing thing;
  thing.small = 0x1234;
  thing.negative = -2;
  thing.large = 0x0102030405060708u;
  thing.real = -1.5f;
  thing.fine = 1.0 / 3;
  thing.flag = true;
  thing.colour = Colour::green;
  thing.size = 5;
  thing.fixed = {1, std::numeric_limits<float>::infinity(), -0.0f};
  thing.some = {7, 8};
  thing.nested = {{1, 2}, {}, {3}};
  return thing;
}

/// The same, byte by byte.
HandmadeArchive by_hand() {
  HandmadeArchive archive("THNG", 7);
  archive.u8(0x34).u8(0x12).u32(0xfffffffeu).u64(0x0102030405060708u).u32(0xbfc00000u);
  archive.u64(0x3fd5555555555555u).u8(1).u8(1).u64(5).section("ONE ");
  archive.u32(0x3f800000u).u32(0x7f800000u).u32(0x80000000u);
  archive.u64(2).u32(7).u32(8);
  archive.u64(3).u64(2).f32(1).f32(2).u64(0).u64(1).f32(3).section("TWO ");
  return archive.section("END ");
}

TEST(Archive, CheckValueIsThatOfTheCastagnoliPolynomial) {
  const std::string digits = "123456789";
  EXPECT_EQ(detail::crc32c(0, std::as_bytes(std::span(digits))), 0xe3069283u);
  std::mt19937 random(1);
  Bytes bytes(1000);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 0xffu);
  for (std::size_t size = 0; size < 40; ++size) {
    const std::span<const std::byte> some = std::span(bytes).subspan(size, 17 * size);
    const std::size_t part = random() % (some.size() + 1);
    const std::uint32_t first = detail::crc32c(0, some.first(part));
    EXPECT_EQ(detail::crc32c(first, some.subspan(part)), testing_support::slow_crc32c(some));
  }
}

TEST(Archive, BytesAreTheseOnEveryMachine) { EXPECT_EQ(save(example()), by_hand().bytes()); }

TEST(Archive, ReadsWhatItWrote) {
  const Thing read = load(by_hand().bytes());
  EXPECT_EQ(save(read), by_hand().bytes());
  EXPECT_EQ(read.negative, -2);
  EXPECT_EQ(read.large, 0x0102030405060708u);
  EXPECT_EQ(read.nested, example().nested);
}

TEST(Archive, BytesMayComeAndGoInAnyParts) {
  Thing large = example();
  for (std::uint32_t i = 0; i < 90000; ++i) large.some.push_back(i * 2654435761u);
  const Bytes bytes = save(large);
  for (const std::size_t most : {std::size_t{1}, std::size_t{3}, std::size_t{70001}}) {
    std::size_t at = 0;
    const auto source = [&](std::span<std::byte> out) {
      const std::size_t count = std::min({out.size(), most, bytes.size() - at});
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), count, out.begin());
      at += count;
      return count;
    };
    EXPECT_EQ(load(source).some, large.some);
    EXPECT_EQ(at, bytes.size());  // and not one more is asked for
  }
}

TEST(Archive, ReadsNothingBehindTheEnd) {
  Bytes bytes = by_hand().bytes();
  const std::size_t own = bytes.size();
  bytes.resize(own + 100);
  std::size_t at = 0;
  const auto source = [&](std::span<std::byte> out) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
    at += out.size();
    return out.size();
  };
  load(source);
  EXPECT_EQ(at, own);
}

TEST(Archive, RefusesByNameOfTheReason) {
  const auto refused = [](const Bytes& bytes, const std::string& reason) {
    EXPECT_THAT([&] { load(bytes); }, ThrowsMessage<std::runtime_error>(HasSubstr(reason)))
        << reason;
  };
  const Bytes good = by_hand().bytes();
  Bytes bytes = good;
  bytes[2] = std::byte{'x'};
  refused(bytes, "freqsynth: this is no saved thing");
  refused(HandmadeArchive("IMAG").bytes(), "this is no saved thing, but a saved frequency image");
  refused(HandmadeArchive("OTHR").bytes(), "this is no saved thing");
  refused(HandmadeArchive("THNG", 8).bytes(),
          "saved thing is of format 8, newer than format 7, which is read");
  refused(HandmadeArchive("THNG", 6).bytes(), "is of format 6, older than format 7");
  refused({}, "saved thing ends too early, in its header");
  bytes = good;
  bytes.resize(15);
  refused(bytes, "ends too early, in its header");
  bytes = good;
  bytes[13] ^= std::byte{1};  // the version
  refused(bytes, "is damaged in its header: a check value is wrong");
  bytes = good;
  bytes[40] ^= std::byte{1};
  refused(bytes, "is damaged in section ONE");
  bytes = good;
  bytes.resize(45);
  refused(bytes, "ends too early, in section ONE");
  bytes = good;
  bytes.push_back(std::byte{0});
  refused(bytes, "goes on after its end");
  refused(HandmadeArchive("THNG", 7).section("TWO ").bytes(),
          "has another section where ONE belongs");
  refused(HandmadeArchive("THNG", 7).u8(0).section("ONE ").bytes(), "is too short, in section ONE");
}

TEST(Archive, RefusesContentThatCannotBe) {
  const auto one = [](int flag, int more) {
    HandmadeArchive archive("THNG", 7);
    archive.u8(0).u8(0).u32(0).u64(0).u32(0).u64(0).u8(flag).u8(0).u64(0);
    for (int i = 0; i < more; ++i) archive.u8(0);
    return archive.section("ONE ");
  };
  const auto refused = [](const Bytes& bytes, const std::string& reason) {
    EXPECT_THAT([&] { load(bytes); }, ThrowsMessage<std::runtime_error>(HasSubstr(reason)))
        << reason;
  };
  refused(one(2, 0).bytes(), "holds what it cannot, in section ONE");
  refused(one(1, 3).bytes(), "is too long, in section ONE");
  const auto two = [&](std::uint64_t some, std::uint64_t nested) {
    HandmadeArchive archive = one(1, 0);
    archive.f32(0).f32(0).f32(0).u64(some).u64(nested);
    for (int i = 0; i < 64; ++i) archive.u8(0);
    return archive.section("TWO ");
  };
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t lie : {most, most / 4 + 1, std::uint64_t{100001}}) {
    refused(two(lie, 0).bytes(), "holds what it cannot, in section TWO");
  }
  refused(two(0, 5).bytes(), "holds what it cannot, in section TWO");
  refused(two(0, most).bytes(), "holds what it cannot, in section TWO");
}

TEST(Archive, ALengthThatLiesTakesNoMemory) {
  HandmadeArchive archive("THNG", 7);
  archive.u8(0).u8(0).u32(0).u64(0).u32(0).u64(0).u8(0).u8(0).u64(0).section("ONE ");
  archive.f32(0).f32(0).f32(0).u64(100000).section("TWO ", std::uint64_t{1} << 60);
  EXPECT_THAT([&] { load(archive.bytes()); },
              ThrowsMessage<std::runtime_error>(HasSubstr("ends too early, in section TWO")));
}

TEST(Archive, EveryTruncationAndEveryChangedBitIsRefused) {
  const Bytes good = by_hand().bytes();
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_THROW(load(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))),
                 std::runtime_error)
        << size;
  }
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bytes = good;
    bytes[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    EXPECT_THROW(load(bytes), std::runtime_error) << bit;
  }
}

TEST(Archive, WhatTheSinkThrowsArrives) {
  struct Full {};
  const auto full = [](std::span<const std::byte>) { throw Full(); };
  const Thing thing = example();
  EXPECT_THROW(
      {
        StateWriter writer(full, kind);
        Thing::archive(writer, thing);
      },
      Full);
}

}  // namespace
}  // namespace freqsynth
