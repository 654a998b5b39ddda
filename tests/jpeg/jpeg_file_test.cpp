// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/jpeg/jpeg_file.h"
#include "support/jpeg_helpers.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

namespace fs = std::filesystem;
using test::Bytes;
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

/// The most memory that this process ever held, in bytes.
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

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

// ---------------------------------------------------------------------------------------- files

class JpegFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("freqsynth_jpeg_") + test->name());
    fs::remove_all(folder_);
    fs::create_directory(folder_);
    file_ = folder_ / "picture.jpg";
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  static Bytes content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(stream), {});
  }

  const QuantizedImage image_ = random_quantized(300, 200, 3, 2, 2);
  fs::path folder_, file_;
};

TEST_F(JpegFile, IsWrittenReplacedAndReadBack) {
  for (const QuantizedImage& image : {random_quantized(5, 5, 1, 1, 1), image_}) {
    write_jpeg(file_, image, {.progressive = true});
    EXPECT_EQ(content(file_), encode_jpeg(image, {.progressive = true}));
    EXPECT_EQ(read_jpeg(file_).components[0].values, image.components[0].values);
    EXPECT_EQ(files(), 1);
  }
}

TEST_F(JpegFile, KeepsItsContentWhenTheImageIsRefused) {
  write_jpeg(file_, image_);
  QuantizedImage bad = image_;
  bad.components.pop_back();
  EXPECT_THROW(write_jpeg(file_, bad), std::invalid_argument);
  EXPECT_EQ(content(file_), encode_jpeg(image_));
  EXPECT_THROW(write_jpeg(folder_ / "new.jpg", bad), std::invalid_argument);
  EXPECT_EQ(files(), 1);
}

TEST_F(JpegFile, KeepsItsContentWhenWritingFails) {
  const QuantizedImage old = random_quantized(5, 5, 1, 1, 1);
  write_jpeg(file_, old);
  // No file may grow beyond 4096 bytes.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 4096;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const fs::path& file : {file_, folder_ / "new.jpg"}) {
    EXPECT_THAT([&] { write_jpeg(file, image_); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr("cannot write " + file.string()), HasSubstr("too large"))));
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(content(file_), encode_jpeg(old));
  EXPECT_EQ(files(), 1);
}

TEST_F(JpegFile, KeepsLinksAndPermissions) {
  const auto rights = fs::perms::owner_read | fs::perms::owner_write;
  std::ofstream(file_) << "old";
  fs::permissions(file_, rights);
  const fs::path link = folder_ / "link.jpg";
  fs::create_symlink("picture.jpg", link);
  write_jpeg(link, image_);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_FALSE(fs::is_symlink(file_));
  EXPECT_EQ(content(file_), encode_jpeg(image_));
  EXPECT_EQ(fs::status(file_).permissions(), rights);
  EXPECT_EQ(files(), 2);
}

TEST_F(JpegFile, FailuresNameTheFileAndTheReason) {
  const auto fails = [&](const fs::path& file, const char* why) {
    EXPECT_THAT([&] { write_jpeg(file, image_); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr("cannot write " + file.string()), HasSubstr(why))));
  };
  fails(folder_ / "absent" / "picture.jpg", "No such file or directory");
  fails(folder_, "Is a directory");
  if (fs::exists("/dev/full")) fails("/dev/full", "No space left on device");
  if (fs::exists("/dev/null")) write_jpeg("/dev/null", image_);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(JpegFile, FailuresToReadNameTheFileAndTheReason) {
  const auto fails = [](const fs::path& file, const char* why) {
    EXPECT_THAT([&] { (void)read_jpeg(file); },
                ThrowsMessage<std::runtime_error>(
                    AllOf(HasSubstr("freqsynth: cannot read " + file.string()), HasSubstr(why))));
  };
  fails(file_, "No such file or directory");
  fails(folder_, "Is a directory");
  std::ofstream{file_};
  fails(file_, "Empty input file");
  std::ofstream(file_) << "no picture";
  fails(file_, "Not a JPEG file");
  const Bytes bytes = encode_jpeg(image_);
  std::ofstream(file_, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), 10000);
  fails(file_, "Premature end");
}

TEST_F(JpegFile, NoMoreIsReadThanTheLimit) {
  Bytes bytes = encode_jpeg(image_);
  const std::size_t size = bytes.size();
  const auto store = [&] {
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  store();
  EXPECT_EQ(read_jpeg(file_, {.bytes = size}).width, image_.width);
  const auto refused = [&](const char* why) {
    return ThrowsMessage<std::runtime_error>(
        AllOf(HasSubstr("cannot read " + file_.string()), HasSubstr(why)));
  };
  EXPECT_THAT([&] { (void)read_jpeg(file_, {.bytes = size - 1}); }, refused("limit of"));
  // A file that goes on after the picture, for 300 MB that take no place on the disk.
  fs::resize_file(file_, 300 << 20);
  const long before = peak_memory();
  EXPECT_THAT([&] { (void)read_jpeg(file_, {.bytes = 1 << 20}); },
              refused("more than the limit of 1048576 bytes"));
  EXPECT_LT(peak_memory() - before, 20 << 20);
  EXPECT_THAT([&] { (void)read_jpeg(file_); }, refused("more than the limit of 268435456 bytes"));
}

TEST_F(JpegFile, ADeviceWithoutAnEndIsNotRead) {
  if (!fs::exists("/dev/zero")) GTEST_SKIP();
  const long before = peak_memory();
  EXPECT_THAT([] { (void)read_jpeg("/dev/zero"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("cannot read /dev/zero"), HasSubstr("Not a JPEG file"))));
  EXPECT_LT(peak_memory() - before, 20 << 20);
}

TEST_F(JpegFile, MayBeAPipe) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Bytes bytes = encode_jpeg(image_);
  std::thread writer([&] {
    std::ofstream stream(pipe, std::ios::binary);
    // In pieces, of which the first is shorter than any header.
    for (std::size_t done = 0; done < bytes.size();) {
      const std::size_t size = std::min<std::size_t>(done == 0 ? 1 : 5000, bytes.size() - done);
      stream.write(reinterpret_cast<const char*>(bytes.data() + done),
                   static_cast<std::streamsize>(size));
      stream.flush();
      done += size;
    }
  });
  const QuantizedImage read = read_jpeg(pipe);
  writer.join();
  EXPECT_EQ(read.components[0].values, image_.components[0].values);
}

}  // namespace
}  // namespace freqsynth
