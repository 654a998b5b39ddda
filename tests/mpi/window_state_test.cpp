// SPDX-License-Identifier: MIT
#include "mpi/window_state.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace farm {
namespace {

class WindowStateFile : public testing::Test {
 protected:
  WindowStateFile() : state({{{0, 0, 8, 5}, 70}, {{8, 0, 3, 5}, 30}}, 11, empty) {
    state.taken[1] = 29;
    for (std::size_t i = 0; i < state.picture.pixels.size(); ++i) {
      state.picture.pixels[i] = 0.5f * static_cast<float>(i);
    }
  }
  ~WindowStateFile() override { std::filesystem::remove(file); }

  /// What load_windows() says of it.
  [[nodiscard]] std::string refusal(const std::string& what, const Picture& picture) const {
    try {
      static_cast<void>(load_windows(file, what, picture));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing";
  }

  const std::string file = testing::TempDir() + "window_state_test";
  const Picture empty{11, 5, 2, {}};
  WindowState state;
};

TEST_F(WindowStateFile, BringsBackWhatWasSaved) {
  save_windows(file, "chess", state);
  const WindowState read = load_windows(file, "chess", empty);
  EXPECT_EQ(read.coarse, 11u);
  EXPECT_EQ(read.taken, state.taken);
  EXPECT_EQ(read.picture.pixels, state.picture.pixels);
  EXPECT_EQ(read.picture.width, 11u);
  ASSERT_EQ(read.tasks.size(), 2u);
  EXPECT_EQ(read.tasks[1].window.x, 8u);
  EXPECT_EQ(read.tasks[1].window.width, 3u);
  EXPECT_EQ(read.tasks[1].samples, 30u);
}

TEST_F(WindowStateFile, OfAnythingElseIsRefused) {
  EXPECT_EQ(refusal("chess", empty), file + ": cannot be read");
  save_windows(file, "chess", state);
  EXPECT_EQ(refusal("chess 2", empty), file + ": was made with other options");
  EXPECT_EQ(refusal("ches", empty), file + ": was made with other options");
  EXPECT_EQ(refusal("chess", {11, 5, 3, {}}), file + ": was made with other options");
  std::ofstream(file) << "freqsynth";
  EXPECT_EQ(refusal("chess", empty), file + ": no state of windows");
}

TEST_F(WindowStateFile, CutShortOrTooLongIsRefused) {
  save_windows(file, "chess", state);
  std::ifstream stream(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t head = whole.find("chess 2\n") + 8;
  for (std::size_t size = head; size <= whole.size() + 1; ++size) {
    if (size == whole.size()) continue;
    std::ofstream(file, std::ios::binary) << (whole + '\0').substr(0, size);
    EXPECT_EQ(refusal("chess", empty), file + ": is damaged") << size << " bytes";
  }
}

}  // namespace
}  // namespace farm
