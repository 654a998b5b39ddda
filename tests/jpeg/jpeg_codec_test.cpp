// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/jpeg/jpeg.h"
#include "support/jpeg_helpers.h"
#include "support/peak_memory.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

using test::Bytes;
using test::peak_memory;
using test::random_quantized;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

// --------------------------------------------------------------------------------------- encode

TEST(EncodeJpeg, NamesWhatJpegCannotSay) {
  using Change = std::function<void(QuantizedImage&)>;
  const QuantizedImage good = random_quantized(33, 19, 3, 2, 2);
  const std::vector<std::pair<const char*, Change>> faults = {
      {"no component", [](auto& q) { q.components.clear(); }},
      {"component 0 has 4 x 3 blocks", [](auto& q) { q.components[0].blocks_x = 4; }},
      {"names table 2 of 2", [](auto& q) { q.components[1].table = 2; }},
      {"table 0 holds a 0", [](auto& q) { q.tables[0][63] = 0; }},
      {"5 tables, more than 4", [](auto& q) { q.tables.resize(5, q.tables[0]); }},
      {"2 components, not 1 or 3", [](auto& q) { q.components.pop_back(); }},
      {"4 components", [](auto& q) { q.components.push_back(q.components[2]); }},
      {"block 1 of component 2 holds 1024", [](auto& q) { q.components[2].values[64] = 1024; }},
      {"holds -1025", [](auto& q) { q.components[0].values[0] = -1025; }},
      {"block 0 of component 1 holds -1024", [](auto& q) { q.components[1].values[9] = -1024; }},
      {"holds 32767", [](auto& q) { q.components[0].values[63] = 32767; }},
      {"65501 x 1 pixels", [](auto& q) { q = random_quantized(65501, 1, 1, 1, 1); }},
      {"1 x 65536 pixels", [](auto& q) { q = random_quantized(1, 65536, 3, 2, 2); }},
      {"groups of 18 blocks", [](auto& q) { q = random_quantized(9, 9, 3, 4, 4); }},
  };
  for (const auto& [message, change] : faults) {
    QuantizedImage image = good;
    change(image);
    EXPECT_THAT(
        [&] { (void)encode_jpeg(image); },
        ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("freqsynth: "), HasSubstr(message))));
  }
}

// --------------------------------------------------------------------------------------- decode

auto refuses(const char* why) {
  return ThrowsMessage<std::runtime_error>(
      AllOf(HasSubstr("freqsynth: decode_jpeg: "), HasSubstr(why)));
}

TEST(DecodeJpeg, RefusesWhatIsNoJpeg) {
  EXPECT_THAT([] { (void)decode_jpeg({}); }, refuses("Empty input file"));
  const Bytes text{'P', '5', ' ', '8', ' ', '8'};
  EXPECT_THAT([&] { (void)decode_jpeg(text); }, refuses("Not a JPEG file"));
}

TEST(DecodeJpeg, RefusesEveryFileThatIsCutOff) {
  for (const bool progressive : {false, true}) {
    const Bytes bytes =
        encode_jpeg(random_quantized(20, 20, 3, 2, 2), {.progressive = progressive});
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THROW((void)decode_jpeg(std::span(bytes).first(size)), std::runtime_error) << size;
    }
  }
}

TEST(DecodeJpeg, SurvivesEveryFlippedByte) {
  for (const bool progressive : {false, true}) {
    const Bytes good = encode_jpeg(random_quantized(9, 9, 3, 2, 1), {.progressive = progressive});
    for (std::size_t i = 0; i < good.size(); ++i) {
      for (const int flip : {0x01, 0x80, 0xff}) {
        Bytes bytes = good;
        bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ flip);
        try {
          decode_jpeg(bytes).validate();
        } catch (const std::runtime_error&) {
        }
      }
    }
  }
}

TEST(DecodeJpeg, NamesColoursThatItDoesNotRead) {
  using test::Compression;
  const auto encoded = [](J_COLOR_SPACE space, int channels) {
    return test::encode_pixels_with_libjpeg(16, 16, {.space = space, .channels = channels});
  };
  EXPECT_THAT([&] { (void)decode_jpeg(encoded(JCS_RGB, 3)); }, refuses("RGB, not grayscale"));
  EXPECT_THAT([&] { (void)decode_jpeg(encoded(JCS_CMYK, 4)); }, refuses("CMYK"));
  EXPECT_THAT([&] { (void)decode_jpeg(encoded(JCS_YCCK, 4)); }, refuses("YCCK"));
  Bytes twelve_bits = encoded(JCS_GRAYSCALE, 1);
  for (std::size_t i = 0; i + 4 < twelve_bits.size(); ++i) {
    if (twelve_bits[i] == 0xff && twelve_bits[i + 1] == 0xc0) twelve_bits[i + 4] = 12;
  }
  EXPECT_THAT([&] { (void)decode_jpeg(twelve_bits); }, refuses("precision 12"));
}

// --------------------------------------------------------------------------------------- limits

TEST(JpegLimits, AFewBytesCannotClaimAnySize) {
  const long before = peak_memory();
  EXPECT_THAT([] { (void)decode_jpeg(test::black_hole(65500, 65500, 4)); },
              refuses("65500 x 65500 pixels, more than the limit of 100000000"));
  EXPECT_THAT([] { (void)decode_jpeg(test::black_hole(10001, 10000, 4)); },
              refuses("10001 x 10000 pixels"));
  // Nothing of the size that was claimed.
  EXPECT_LT(peak_memory() - before, 20 << 20);
}

TEST(JpegLimits, AFileOfZerosIsRefusedBeforeItGrows) {
  // The whole of it, 1.7 MB, would be decoded to 290 MB.
  const Bytes bomb = test::black_hole(12000, 12000, 1500 * 1500);
  const long before = peak_memory();
  EXPECT_THAT([&] { (void)decode_jpeg(bomb); }, refuses("12000 x 12000 pixels"));
  EXPECT_LT(peak_memory() - before, 20 << 20);
  // A small one is a black picture, and the limit is one of pixels, inclusive.
  const Bytes black = test::black_hole(160, 80, 20 * 10);
  EXPECT_THAT(decode_jpeg(black, {.pixels = 160 * 80}).components[0].values,
              testing::Each(std::int16_t{0}));
  EXPECT_THAT([&] { (void)decode_jpeg(black, {.pixels = 160 * 80 - 1}); },
              refuses("160 x 80 pixels, more than the limit of 12799"));
}

TEST(JpegLimits, PassesOverTheImageAreCounted) {
  const Bytes many = test::many_scans(40, 40, 300);
  EXPECT_THAT([&] { (void)decode_jpeg(many); }, refuses("more than the limit of 200 scans"));
  const QuantizedImage once = decode_jpeg(test::many_scans(40, 40, 0));
  EXPECT_EQ(decode_jpeg(many, {.scans = 302}).components[0].values, once.components[0].values);
  EXPECT_THAT([&] { (void)decode_jpeg(many, {.scans = 301}); }, refuses("limit of 301 scans"));
}

TEST(JpegLimits, NarrowImagesAreReadWithinTightLimits) {
  // Groups of blocks make libjpeg's memory larger than the pixels.
  for (const auto& [width, height] : {std::pair<std::size_t, std::size_t>{65500, 1}, {1, 65500}}) {
    const QuantizedImage image = random_quantized(width, height, 3, 2, 2);
    const QuantizedImage read = decode_jpeg(encode_jpeg(image), {.pixels = 65500});
    EXPECT_EQ(read.components[2].values, image.components[2].values);
  }
}

TEST(JpegLimits, BytesAreCounted) {
  const Bytes bytes = encode_jpeg(random_quantized(20, 20, 3, 2, 2));
  EXPECT_EQ(decode_jpeg(bytes, {.bytes = bytes.size()}).width, 20u);
  EXPECT_THAT([&] { (void)decode_jpeg(bytes, {.bytes = bytes.size() - 1}); },
              refuses(("limit of " + std::to_string(bytes.size() - 1) + " bytes").c_str()));
}

}  // namespace
}  // namespace freqsynth
