// SPDX-License-Identifier: MIT
#include "freqsynth/basis/large_pages.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace freqsynth {
namespace {

using detail::large_page;
using detail::LargeVector;
using detail::UnsetVector;

std::size_t place_of(const void* memory) { return reinterpret_cast<std::uintptr_t>(memory); }

TEST(LargeVector, StartsOnACacheLineAndWhenLargeOnAPage) {
  for (const std::size_t count : {1u, 1000u, 524287u, 524288u, 2000000u}) {
    LargeVector<float> numbers(count, 3.0f);
    EXPECT_EQ(place_of(numbers.data()) % detail::alignment, 0u);
#if defined(__linux__)
    if (count * sizeof(float) >= large_page) {
      EXPECT_EQ(place_of(numbers.data()) % large_page, 0u);
    }
#endif
    EXPECT_EQ(numbers, LargeVector<float>(count, 3.0f));
    numbers.back() = 4;
    const LargeVector<float> copy = numbers;
    EXPECT_EQ(copy, numbers);
  }
}

TEST(LargeVector, StartsWithZeros) {
  for (const std::size_t count : {1000u, 2000000u}) {
    LargeVector<float> numbers(count, 3.0f);
    numbers.clear();
    numbers.resize(count);
    EXPECT_EQ(numbers, LargeVector<float>(count, 0.0f));
    EXPECT_EQ(numbers, LargeVector<float>(count));
  }
}

TEST(UnsetVector, LeavesNewNumbersAsTheyAre) {
  UnsetVector<float> numbers(1000, 3.0f);
  numbers.resize(10);
  numbers.resize(1000);
  EXPECT_EQ(numbers, UnsetVector<float>(1000, 3.0f));
}

TEST(LargePages, AskingForThemChangesNothing) {
  std::vector<std::uint8_t> bytes(5 * large_page);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 / 5);
  const std::vector<std::uint8_t> before = bytes;
  // Parts with and without a whole page, from the start of one and not.
  const std::size_t first = (large_page - place_of(bytes.data()) % large_page) % large_page;
  for (const std::size_t begin : {first, first + 1, first + large_page - 1, std::size_t{0}}) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, large_page - 1, large_page,
                                   large_page + 1, 3 * large_page}) {
      detail::ask_for_large_pages(bytes.data() + begin, size);
    }
  }
  EXPECT_EQ(bytes, before);
}

}  // namespace
}  // namespace freqsynth
