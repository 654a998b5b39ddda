// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/jpeg/jpeg_file.h"
#include "support/jpeg_helpers.h"
#include "support/peak_memory.h"
#include "support/quantization_helpers.h"

namespace freqsynth {
namespace {

namespace fs = std::filesystem;
using test::Bytes;
using test::peak_memory;
using test::random_quantized;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

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
