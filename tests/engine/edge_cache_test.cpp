// SPDX-License-Identifier: MIT
#include "freqsynth/engine/edge_cache.h"
#include "freqsynth/basis/sample_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

using Values = std::vector<float>;

std::vector<SequencePosition> positions_of_sequence(std::size_t count) {
  SampleSequence sequence(0, SamplePositions::lattice);
  std::vector<SequencePosition> positions;
  for (std::size_t i = 0; i < count; ++i) positions.push_back(sequence[i]);
  return positions;
}

/// The first `count` positions on a side, in the order of their ranks.
std::vector<SequencePosition> on_side(BlockSide side, std::size_t count) {
  std::vector<SequencePosition> found;
  for (const SequencePosition& position : positions_of_sequence(1089)) {
    if (position.side == side && found.size() < count) found.push_back(position);
  }
  return found;
}

const SequencePosition& corner(bool right, bool bottom) {
  static const auto corners = positions_of_sequence(4);
  return corners[SampleSequence::corner_at(right, bottom)];
}

/// What take() gives, copied; empty when the cache does not know the point.
Values taken(EdgeCache& cache, std::size_t x, std::size_t y, const SequencePosition& position,
             std::size_t channels) {
  const float* values = cache.take(x, y, position);
  return values == nullptr ? Values{} : Values(values, values + channels);
}

TEST(EdgeCache, EachEdgeIsFirstInFirstOut) {
  EdgeCache cache({3, 2}, 2);
  for (const BlockSide side : {BlockSide::left, BlockSide::top}) {
    const auto points = on_side(side, 5);
    for (std::size_t k = 0; k < 5; ++k) {
      const auto value = static_cast<float>(k);
      cache.put(1, 1, points[k], Values{value, -value});
    }
    EXPECT_EQ(cache.waiting(), 5u);
    EXPECT_TRUE(taken(cache, 1, 1, points[2], 2).empty()) << "not the head of the edge";
    for (std::size_t k = 0; k < 5; ++k) {
      const auto value = static_cast<float>(k);
      EXPECT_EQ(taken(cache, 1, 1, points[k], 2), (Values{value, -value}));
      EXPECT_TRUE(taken(cache, 1, 1, points[k], 2).empty()) << "consumed";
    }
    EXPECT_EQ(cache.waiting(), 0u);
  }
}

TEST(EdgeCache, RanksNeedNotStartAtZero) {
  // Both blocks may have taken the first points of their edge together.
  EdgeCache cache({2, 1}, 1);
  const auto points = on_side(BlockSide::right, 4);
  cache.put(0, 0, points[2], Values{2});
  EXPECT_TRUE(taken(cache, 0, 0, points[1], 1).empty());
  EXPECT_TRUE(taken(cache, 0, 0, points[3], 1).empty());
  EXPECT_EQ(taken(cache, 0, 0, points[2], 1), Values{2});
}

TEST(EdgeCache, EdgesDoNotMix) {
  EdgeCache cache({3, 3}, 1);
  const SequencePosition left = on_side(BlockSide::left, 1)[0];
  const SequencePosition right = on_side(BlockSide::right, 1)[0];
  const SequencePosition top = on_side(BlockSide::top, 1)[0];
  const SequencePosition bottom = on_side(BlockSide::bottom, 1)[0];
  cache.put(1, 1, left, Values{1});
  cache.put(1, 1, right, Values{2});
  cache.put(1, 1, top, Values{3});
  cache.put(1, 1, bottom, Values{4});
  EXPECT_EQ(taken(cache, 1, 1, bottom, 1), Values{4});
  EXPECT_EQ(taken(cache, 1, 1, right, 1), Values{2});
  EXPECT_EQ(taken(cache, 1, 1, left, 1), Values{1});
  EXPECT_EQ(taken(cache, 1, 1, top, 1), Values{3});
}

TEST(EdgeCache, CornerServesAllFourBlocksForGood) {
  EdgeCache cache({2, 2}, 3);
  EXPECT_EQ(cache.take(1, 1, corner(false, false)), nullptr);
  cache.put(0, 0, corner(true, true), Values{1, 2, 3});
  for (int repetition = 0; repetition < 2; ++repetition) {
    for (const std::size_t x : {0u, 1u}) {
      for (const std::size_t y : {0u, 1u}) {
        EXPECT_EQ(taken(cache, x, y, corner(x == 0, y == 0), 3), (Values{1, 2, 3}));
        EXPECT_EQ(cache.take(x, y, corner(x != 0, y == 0)), nullptr) << "another corner";
      }
    }
  }
  EXPECT_EQ(cache.waiting(), 0u) << "corners do not wait on edges";
}

TEST(EdgeCache, NothingIsKnownInTheInterior) {
  EdgeCache cache({2, 2}, 1);
  EXPECT_EQ(cache.take(0, 0, positions_of_sequence(5)[4]), nullptr);
}

TEST(EdgeCache, BorderOfTheImageHasNoNeighbour) {
  // Every edge inside the image holds a value, none may show up on the border.
  EdgeCache cache({3, 2}, 1);
  const SequencePosition left = on_side(BlockSide::left, 1)[0];
  const SequencePosition right = on_side(BlockSide::right, 1)[0];
  const SequencePosition top = on_side(BlockSide::top, 1)[0];
  const SequencePosition bottom = on_side(BlockSide::bottom, 1)[0];
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 1; x < 3; ++x) cache.put(x, y, left, Values{9});
  }
  for (std::size_t x = 0; x < 3; ++x) cache.put(x, 1, top, Values{9});
  for (std::size_t y = 0; y < 2; ++y) {
    EXPECT_EQ(cache.take(0, y, left), nullptr);
    EXPECT_EQ(cache.take(2, y, right), nullptr);
  }
  for (std::size_t x = 0; x < 3; ++x) {
    EXPECT_EQ(cache.take(x, 0, top), nullptr);
    EXPECT_EQ(cache.take(x, 1, bottom), nullptr);
  }
  EXPECT_EQ(cache.waiting(), 7u);
}

/// Blocks go through the sequence at random speeds; whoever comes to a border point first leaves
/// its value for the others. The oracle is a map from the point in the plane to its value.
class Simulation {
 public:
  Simulation(std::size_t blocks_x, std::size_t blocks_y, std::size_t channels)
      : blocks_x_(blocks_x),
        blocks_y_(blocks_y),
        channels_(channels),
        cache_({blocks_x, blocks_y}, channels),
        counts_(blocks_x * blocks_y) {}

  void step(std::size_t x, std::size_t y, oracle::Random& random) {
    const SequencePosition& position = positions_[counts_[y * blocks_x_ + x]++];
    const std::pair point(static_cast<double>(x) + position.s, static_cast<double>(y) + position.t);
    const auto known = known_.find(point);
    const Values found = taken(cache_, x, y, position, channels_);
    const Values expected = known == known_.end() ? Values{} : known->second;
    ASSERT_EQ(found, expected) << "block " << x << ", " << y << " at " << position.s << ", "
                               << position.t;
    const bool is_corner = position.side == BlockSide::corner;
    if (known != known_.end()) {
      if (!is_corner) --waiting_;
    } else if (position.side != BlockSide::interior) {
      Values values;
      for (std::size_t c = 0; c < channels_; ++c) values.push_back(random.value());
      leave(x, y, position, values);
      known_[point] = values;
    }
    ASSERT_EQ(cache_.waiting(), waiting_);
  }

 private:
  /// Puts the value for every other block that has the point.
  void leave(std::size_t x, std::size_t y, const SequencePosition& position, const Values& values) {
    for (std::size_t other_y = y - (y > 0); other_y <= y + 1 && other_y < blocks_y_; ++other_y) {
      for (std::size_t other_x = x - (x > 0); other_x <= x + 1 && other_x < blocks_x_; ++other_x) {
        const double s = static_cast<double>(x) + position.s - static_cast<double>(other_x);
        const double t = static_cast<double>(y) + position.t - static_cast<double>(other_y);
        const bool own = other_x == x && other_y == y;
        if (own || s < 0 || s > 1 || t < 0 || t > 1) continue;
        if (position.side != BlockSide::corner) ++waiting_;
        for (const SequencePosition& same : positions_) {
          if (same.s == s && same.t == t) cache_.put(other_x, other_y, same, values);
        }
      }
    }
  }

  std::size_t blocks_x_, blocks_y_, channels_;
  EdgeCache cache_;
  std::vector<SequencePosition> positions_ = positions_of_sequence(289);
  std::vector<std::size_t> counts_;
  std::map<std::pair<double, double>, Values> known_;
  std::size_t waiting_ = 0;
};

TEST(EdgeCache, FollowsAMapThroughRandomSimulations) {
  for (const auto& [x, y] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 4}, {5, 1}, {3, 4}}) {
    for (const std::size_t channels : {1u, 3u}) {
      oracle::Random random(static_cast<unsigned>(10 * x + y));
      Simulation simulation(x, y, channels);
      std::vector<std::size_t> left(x * y, 289);
      std::vector<std::size_t> unfinished(x * y);
      for (std::size_t i = 0; i < unfinished.size(); ++i) unfinished[i] = i;
      while (!unfinished.empty()) {
        // Runs of one block let it overtake the others by far.
        const std::size_t place = random.below(unfinished.size());
        const std::size_t block = unfinished[place];
        for (std::size_t run = random.below(40) + 1; run > 0 && left[block] > 0; --run) {
          --left[block];
          ASSERT_NO_FATAL_FAILURE(simulation.step(block % x, block / x, random));
        }
        if (left[block] == 0) {
          unfinished.erase(unfinished.begin() + static_cast<std::ptrdiff_t>(place));
        }
      }
    }
  }
}

}  // namespace
}  // namespace freqsynth
