// SPDX-License-Identifier: MIT
// Frequency images, saved and loaded.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/image/frequency_image.h"
#include "freqsynth/image/frequency_image_file.h"
#include "support/handmade_archive.h"

namespace freqsynth {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;
using testing_support::Bytes;
using testing_support::HandmadeArchive;

FrequencyImage random_image(std::size_t width, std::size_t height, std::size_t channels,
                            CoefficientMeaning meaning = CoefficientMeaning::point_function) {
  FrequencyImage image(width, height, channels, meaning);
  std::mt19937 random(static_cast<unsigned>(width + 100 * height));
  for (std::size_t y = 0; y < image.blocks_y(); ++y) {
    for (std::size_t x = 0; x < image.blocks_x(); ++x) {
      image.samples(x, y) = static_cast<std::uint32_t>(random());
      for (std::size_t c = 0; c < channels; ++c) {
        for (float& one : image.coefficients(x, y, c)) {
          one = std::bit_cast<float>(static_cast<std::uint32_t>(random()));  // NaN, too
        }
      }
    }
  }
  for (std::size_t c = 0; c < channels; ++c) image.set_non_negative(c, random() % 2 == 0);
  return image;
}

void expect_same(const FrequencyImage& a, const FrequencyImage& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  ASSERT_EQ(a.channels(), b.channels());
  EXPECT_EQ(a.meaning(), b.meaning());
  for (std::size_t y = 0; y < a.blocks_y(); ++y) {
    for (std::size_t x = 0; x < a.blocks_x(); ++x) {
      EXPECT_EQ(a.samples(x, y), b.samples(x, y));
      for (std::size_t c = 0; c < a.channels(); ++c) {
        for (std::size_t i = 0; i < max_terms; ++i) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(a.coefficients(x, y, c)[i]),
                    std::bit_cast<std::uint32_t>(b.coefficients(x, y, c)[i]));
        }
      }
    }
  }
}

TEST(SavedFrequencyImage, ComesBackToTheBit) {
  for (const auto& [width, height, channels] :
       {std::array<std::size_t, 3>{1, 1, 1}, {8, 8, 1}, {17, 9, 3}, {100, 3, 2}, {300, 200, 4}}) {
    const FrequencyImage image =
        random_image(width, height, channels, CoefficientMeaning::pixel_average);
    const FrequencyImage loaded = FrequencyImage::load(image.save());
    expect_same(image, loaded);
    for (std::size_t c = 0; c < channels; ++c) {
      EXPECT_EQ(image.non_negative(c), loaded.non_negative(c));
    }
  }
}

TEST(SavedFrequencyImage, ImagesWithoutBlocksDoToo) {
  FrequencyImage moved_from = random_image(9, 9, 3);
  const FrequencyImage taken = std::move(moved_from);
  for (const FrequencyImage& image :
       {FrequencyImage(), FrequencyImage(0, 7, 2), moved_from}) {  // NOLINT: it is empty
    expect_same(image, FrequencyImage::load(image.save()));
  }
}

/// The bytes of an image of 9 x 5 pixels and 2 channels, whose coefficients are 0, 1, 2, ...
HandmadeArchive by_hand() {
  HandmadeArchive archive("IMAG");
  archive.u64(9).u64(5).u64(2).u8(1).section("SIZE");
  archive.u64(256);
  for (int i = 0; i < 256; ++i) archive.f32(static_cast<float>(i));
  archive.section("COEF").u64(2).u32(70000).u32(3).section("SMPL");
  return archive.u64(2).u8(0).u8(1).section("NNEG").section("END ");
}

TEST(SavedFrequencyImage, BytesAreTheseOnEveryMachine) {
  const FrequencyImage image = FrequencyImage::load(by_hand().bytes());
  EXPECT_EQ(image.save(), by_hand().bytes());
  EXPECT_EQ(image.width(), 9u);
  EXPECT_EQ(image.meaning(), CoefficientMeaning::pixel_average);
  EXPECT_EQ(image.samples(0, 0), 70000u);
  EXPECT_EQ(image.coefficients(1, 0, 1)[63], 255.0f);
  EXPECT_FALSE(image.non_negative(0));
  EXPECT_TRUE(image.non_negative(1));
}

TEST(SavedFrequencyImage, EveryTruncationAndEveryChangedByteIsRefused) {
  const Bytes good = by_hand().bytes();
  for (std::size_t at = 0; at < good.size(); ++at) {
    const auto end = good.begin() + static_cast<std::ptrdiff_t>(at);
    EXPECT_THROW(static_cast<void>(FrequencyImage::load(Bytes(good.begin(), end))),
                 std::runtime_error);
    Bytes bytes = good;
    bytes[at] ^= static_cast<std::byte>(1 + at % 255);
    EXPECT_THROW(static_cast<void>(FrequencyImage::load(bytes)), std::runtime_error);
  }
}

TEST(SavedFrequencyImage, SizesThatLieTakeNoMemory) {
  const auto refused = [](std::uint64_t width, std::uint64_t height, std::uint64_t channels,
                          int meaning, std::uint64_t count, const std::string& reason) {
    HandmadeArchive archive("IMAG");
    archive.u64(width).u64(height).u64(channels).u8(meaning).section("SIZE");
    archive.u64(count).section("COEF", 8 + 4 * count).section("SMPL");
    EXPECT_THAT([&] { static_cast<void>(FrequencyImage::load(archive.bytes())); },
                ThrowsMessage<std::runtime_error>(HasSubstr(reason)));
  };
  constexpr std::uint64_t much = std::uint64_t{1} << 40;
  refused(8, 8, 1, 2, 0, "holds what it cannot, in section SIZE");
  refused(much, much, 1, 0, 0, "has sizes that no image has, in section SIZE");
  refused(8, 8, 0, 0, 0, "has sizes that no image has, in section SIZE");
  refused(8, 8, much * much / 2, 0, 0, "has sizes that no image has, in section SIZE");
  refused(8, 8, much, 0, much * 64, "ends too early, in section COEF");
  refused(500000, 500000, 1, 0, std::uint64_t{62500} * 62500 * 64,
          "ends too early, in section COEF");
  refused(8, 8, 1, 0, 63, "ends too early, in section COEF");
}

class SavedFrequencyImageFile : public testing::Test {
 protected:
  SavedFrequencyImageFile() { std::filesystem::create_directories(folder_); }
  ~SavedFrequencyImageFile() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string folder_ =
      testing::TempDir() + "freqsynth_saved_" + std::to_string(std::random_device()());
  std::string file_ = folder_ + "/image";
};

TEST_F(SavedFrequencyImageFile, ComesBackToTheBit) {
  const FrequencyImage image = random_image(100, 50, 3);
  save_file(file_, random_image(8, 8, 1));
  save_file(file_, image);
  expect_same(image, load_frequency_image(file_));
  std::size_t files = 0;
  for (const auto& one : std::filesystem::directory_iterator(folder_)) files += one.exists();
  EXPECT_EQ(files, 1u);
}

TEST_F(SavedFrequencyImageFile, FaultsNameTheFileAndTheReason) {
  EXPECT_THAT([&] { static_cast<void>(load_frequency_image(file_)); },
              ThrowsMessage<std::runtime_error>(AllOf(
                  StartsWith("freqsynth: cannot read " + file_ + ": "), HasSubstr("No such"))));
  EXPECT_THAT([&] { static_cast<void>(load_frequency_image(folder_)); },
              ThrowsMessage<std::runtime_error>(StartsWith("freqsynth: cannot read " + folder_)));
  EXPECT_THAT([&] { save_file(folder_ + "/none/image", FrequencyImage()); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(StartsWith("freqsynth: cannot write " + folder_), HasSubstr("No such"))));
  std::ofstream(file_, std::ios::binary) << "GIF89a and more";
  EXPECT_THAT([&] { static_cast<void>(load_frequency_image(file_)); },
              ThrowsMessage<std::runtime_error>("freqsynth: cannot read " + file_ +
                                                ": this is no saved frequency image"));
  save_file(file_, random_image(20, 20, 1));
  std::filesystem::resize_file(file_, 300);
  EXPECT_THAT(
      [&] { static_cast<void>(load_frequency_image(file_)); },
      ThrowsMessage<std::runtime_error>("freqsynth: cannot read " + file_ +
                                        ": saved frequency image ends too early, in section COEF"));
}

TEST_F(SavedFrequencyImageFile, WhatCannotBeWrittenLeavesTheOldOne) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no device that is full";
  EXPECT_THAT([&] { save_file("/dev/full", random_image(300, 300, 3)); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(StartsWith("freqsynth: cannot write /dev/full"), HasSubstr("No space"))));
}

}  // namespace
}  // namespace freqsynth
