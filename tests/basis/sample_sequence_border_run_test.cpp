// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {
namespace {

/// Most positions that are not in the interior and follow each other.
std::size_t longest_run(std::uint64_t seed, std::size_t count) {
  SampleSequence sequence(seed);
  std::size_t run = 0, longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool on_border = sequence[i].side != BlockSide::interior;
    run = on_border ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

class BorderRuns : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, BorderRuns, testing::Range(std::uint64_t{0}, std::uint64_t{5}));

TEST_P(BorderRuns, AreAsLongAsTheConstantSays) {
  EXPECT_EQ(longest_run(GetParam(), std::size_t{129} * 129), SampleSequence::longest_border_run);
}

TEST(BorderRuns, AreNotLongerInTheWholeSequence) {
  EXPECT_EQ(longest_run(3, SampleSequence::max_size), SampleSequence::longest_border_run);
}

}  // namespace
}  // namespace freqsynth
