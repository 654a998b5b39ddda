// SPDX-License-Identifier: MIT
#include "freqsynth/basis/sample_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace freqsynth {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Point = std::pair<double, double>;

std::vector<SequencePosition> first_positions(std::size_t count, std::uint64_t seed = 0) {
  SampleSequence sequence(seed, SamplePositions::lattice);
  std::vector<SequencePosition> positions;
  for (std::size_t i = 0; i < count; ++i) positions.push_back(sequence[i]);
  return positions;
}

std::vector<Point> points_of(const std::vector<SequencePosition>& positions) {
  std::vector<Point> points;
  for (const SequencePosition& position : positions) points.push_back({position.s, position.t});
  return points;
}

/// Number of positions of the lattice that is complete before quad-tree level `level`.
constexpr std::size_t lattice_size(std::size_t level) {
  const std::size_t edge = (std::size_t{1} << level) + 1;
  return edge * edge;
}

int quadrant(const SequencePosition& position) {
  return (position.s > 0.5 ? 1 : 0) + (position.t > 0.5 ? 2 : 0);
}

/// A position that a node owns: its top or right middle. The others on the block's left and bottom
/// border are partners.
bool owned(const SequencePosition& position) {
  return position.side != BlockSide::left && position.side != BlockSide::bottom;
}

BlockSide opposite(BlockSide side) {
  switch (side) {
    case BlockSide::left:
      return BlockSide::right;
    case BlockSide::right:
      return BlockSide::left;
    case BlockSide::top:
      return BlockSide::bottom;
    case BlockSide::bottom:
      return BlockSide::top;
    default:
      return side;
  }
}

class Sequence : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Sequence, testing::Values(0, 1, 2, 3, 12345, ~std::uint64_t{0}));

TEST_P(Sequence, First14PositionsAreThePapers) {
  const auto points = points_of(first_positions(14, GetParam()));
  const std::vector<Point> corners(points.begin(), points.begin() + 4);
  EXPECT_EQ(corners, (std::vector<Point>{{0, 0}, {1, 1}, {1, 0}, {0, 1}}));
  EXPECT_EQ(points[4], Point(0.5, 0.5));

  const std::vector<Point> borders(points.begin() + 5, points.begin() + 9);
  const std::vector<Point> top_first = {{0.5, 0}, {0.5, 1}, {1, 0.5}, {0, 0.5}};
  const std::vector<Point> right_first = {{1, 0.5}, {0, 0.5}, {0.5, 0}, {0.5, 1}};
  EXPECT_TRUE(borders == top_first || borders == right_first);

  const std::vector<Point> centres(points.begin() + 9, points.begin() + 13);
  EXPECT_EQ(centres, (std::vector<Point>{{0.25, 0.25}, {0.75, 0.75}, {0.75, 0.25}, {0.25, 0.75}}));
  // One of the middles of the first quarter's top and right border.
  EXPECT_TRUE(points[13] == Point(0.25, 0) || points[13] == Point(0.5, 0.25));
}

TEST_P(Sequence, EveryLevelCompletesARegularLattice) {
  for (std::size_t level = 0; level <= 5; ++level) {
    const auto points = points_of(first_positions(lattice_size(level), GetParam()));
    const std::set<Point> distinct(points.begin(), points.end());
    ASSERT_EQ(distinct.size(), points.size()) << "a position comes twice";
    const double steps = static_cast<double>(std::size_t{1} << level);
    std::set<Point> lattice;
    for (double x = 0; x <= steps; ++x) {
      for (double y = 0; y <= steps; ++y) lattice.insert({x / steps, y / steps});
    }
    EXPECT_EQ(distinct, lattice) << "level " << level;
  }
}

TEST_P(Sequence, CentresComeFirstAndAllQuadrantsInTurn) {
  const auto positions = first_positions(lattice_size(5), GetParam());
  for (std::size_t level = 1; level < 5; ++level) {
    const std::size_t begin = lattice_size(level);
    const std::size_t nodes = std::size_t{1} << (2 * level);
    const double edge = static_cast<double>(std::size_t{1} << level);
    std::set<Point> centres, expected;
    for (std::size_t i = begin; i < begin + nodes; ++i) {
      centres.insert({positions[i].s, positions[i].t});
    }
    for (double x = 0.5; x < edge; ++x) {
      for (double y = 0.5; y < edge; ++y) expected.insert({x / edge, y / edge});
    }
    EXPECT_EQ(centres, expected) << "level " << level;
    for (std::size_t i = begin; i < begin + nodes; i += 4) {
      std::set<int> quadrants;
      for (std::size_t k = 0; k < 4; ++k) quadrants.insert(quadrant(positions[i + k]));
      EXPECT_EQ(quadrants.size(), 4u) << "samples from " << i;
      if (i > begin) {
        EXPECT_NE(quadrant(positions[i]), quadrant(positions[i - 1]));
      }
    }
  }
}

TEST_P(Sequence, EveryNodeTakesOneMiddleThenTheOther) {
  const auto positions = first_positions(lattice_size(5), GetParam());
  for (std::size_t level = 0; level < 5; ++level) {
    const std::size_t nodes = std::size_t{1} << (2 * level);
    const double edge = static_cast<double>(std::size_t{1} << level);
    std::vector<SequencePosition> middles;
    for (std::size_t i = lattice_size(level) + nodes; i < lattice_size(level + 1); ++i) {
      if (owned(positions[i])) middles.push_back(positions[i]);
    }
    ASSERT_EQ(middles.size(), 2 * nodes);
    for (const std::size_t half : {std::size_t{0}, nodes}) {
      std::set<Point> visited;
      for (std::size_t i = 0; i < nodes; ++i) {
        // A top middle has half-integer s, a right middle half-integer t, in units of the node.
        const double s = middles[half + i].s * edge;
        const double t = middles[half + i].t * edge;
        const bool top = s != std::floor(s);
        visited.insert(top ? Point(std::floor(s), t) : Point(s - 1, std::floor(t)));
      }
      EXPECT_EQ(visited.size(), nodes) << "level " << level << ": a node takes two in one pass";
    }
  }
}

TEST_P(Sequence, PartnerFollowsAtOnce) {
  const auto positions = first_positions(lattice_size(5), GetParam());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const SequencePosition& position = positions[i];
    if (position.side == BlockSide::interior || position.side == BlockSide::corner) {
      EXPECT_EQ(position.partner, i);
      continue;
    }
    EXPECT_EQ(position.partner, owned(position) ? i + 1 : i - 1);
    const SequencePosition& partner = positions[position.partner];
    EXPECT_EQ(partner.partner, i);
    EXPECT_EQ(partner.side, opposite(position.side));
    EXPECT_EQ(partner.rank, position.rank);
    const bool across = position.side == BlockSide::left || position.side == BlockSide::right;
    EXPECT_EQ(across ? partner.t : partner.s, across ? position.t : position.s);
  }
}

TEST_P(Sequence, SideAndRankAreCounted) {
  std::size_t seen[6] = {};
  for (const SequencePosition& position : first_positions(lattice_size(5), GetParam())) {
    const bool left = position.s == 0, right = position.s == 1;
    const bool top = position.t == 0, bottom = position.t == 1;
    BlockSide side = BlockSide::interior;
    if ((left || right) && (top || bottom)) {
      side = BlockSide::corner;
    } else if (left) {
      side = BlockSide::left;
    } else if (right) {
      side = BlockSide::right;
    } else if (top) {
      side = BlockSide::top;
    } else if (bottom) {
      side = BlockSide::bottom;
    }
    ASSERT_EQ(position.side, side) << position.s << ", " << position.t;
    EXPECT_EQ(position.rank, seen[static_cast<std::size_t>(side)]++);
  }
}

TEST_P(Sequence, SpacingIsTheDistanceToTheNearestEarlierPosition) {
  const auto positions = first_positions(lattice_size(5), GetParam());
  EXPECT_EQ(positions[0].spacing, 1) << "nothing is earlier: the block's edge";
  for (std::size_t i = 1; i < positions.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(
          nearest, std::hypot(positions[i].s - positions[j].s, positions[i].t - positions[j].t));
    }
    EXPECT_FLOAT_EQ(positions[i].spacing, static_cast<float>(nearest)) << "position " << i;
  }
}

TEST(SampleSequence, IsEvenAfterWholeLevelsAndAfterTheCentresOfOne) {
  EXPECT_EQ(SampleSequence::even_size(0), 1u);
  for (std::size_t level = 0; level < 8; ++level) {
    const std::size_t whole = SampleSequence::even_size(2 * level + 1);
    const std::size_t centred = SampleSequence::even_size(2 * level + 2);
    EXPECT_EQ(whole, lattice_size(level));
    // From the one to the other the coordinates are odd multiples of half a node, then no more.
    const double half = std::ldexp(0.5, -static_cast<int>(level));
    const auto positions = first_positions(centred + 1);
    const auto is_centre = [half](const SequencePosition& position) {
      return std::fmod(position.s / half, 2) == 1 && std::fmod(position.t / half, 2) == 1;
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
      EXPECT_EQ(is_centre(positions[i]), i >= whole && i < centred) << level << ' ' << i;
    }
  }
}

TEST(SampleSequence, IsAFunctionOfItsSeed) {
  const std::size_t count = lattice_size(4);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    EXPECT_EQ(points_of(first_positions(count, seed)), points_of(first_positions(count, seed)));
    EXPECT_NE(points_of(first_positions(count, seed)), points_of(first_positions(count, seed + 1)));
    EXPECT_EQ(SampleSequence(seed).seed(), seed);
  }
}

TEST(SampleSequence, GrowsAlikeInOneStepAndInMany) {
  const auto stepwise = points_of(first_positions(2000, 7));
  SampleSequence at_once(7, SamplePositions::lattice);
  EXPECT_EQ(at_once.size(), 0u);
  static_cast<void>(at_once[1999]);
  EXPECT_EQ(at_once.size(), 65u * 65u) << "whole levels";
  for (std::size_t i = 0; i < stepwise.size(); ++i) {
    ASSERT_EQ(Point(at_once[i].s, at_once[i].t), stepwise[i]);
  }
}

TEST(SampleSequence, TopAndRightComeFirstEquallyOften) {
  // 40 seeds x 85 nodes of levels 0 to 3 are 3400 fair coins: a standard deviation of 29.
  int top_first = 0, nodes_seen = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto positions = first_positions(lattice_size(4), seed);
    for (std::size_t level = 0; level < 4; ++level) {
      const std::size_t nodes = std::size_t{1} << (2 * level);
      std::size_t found = 0;
      for (std::size_t i = lattice_size(level) + nodes; found < nodes; ++i) {
        if (!owned(positions[i])) continue;
        ++found;
        const double s = positions[i].s * static_cast<double>(std::size_t{1} << level);
        top_first += s != std::floor(s) ? 1 : 0;
      }
      nodes_seen += static_cast<int>(nodes);
    }
  }
  EXPECT_EQ(nodes_seen, 3400);
  EXPECT_NEAR(top_first, 1700, 5 * 29);
}

TEST(SampleSequence, CornerAtIsTheIndexOfTheCorner) {
  const auto positions = first_positions(4);
  for (const bool right : {false, true}) {
    for (const bool bottom : {false, true}) {
      const SequencePosition& corner = positions[SampleSequence::corner_at(right, bottom)];
      EXPECT_EQ(corner.s, right ? 1 : 0);
      EXPECT_EQ(corner.t, bottom ? 1 : 0);
    }
  }
}

TEST(SampleSequence, LastPositionsCompleteTheFinestLattice) {
  SampleSequence sequence(0, SamplePositions::lattice);
  constexpr std::size_t edge = 1025;
  ASSERT_EQ(SampleSequence::max_size, edge * edge);
  std::vector<bool> seen(edge * edge);
  for (std::size_t i = 0; i < edge * edge; ++i) {
    const SequencePosition& position = sequence[i];
    const double x = position.s * 1024, y = position.t * 1024;
    ASSERT_TRUE(x == std::floor(x) && y == std::floor(y));
    const std::size_t place = static_cast<std::size_t>(y) * edge + static_cast<std::size_t>(x);
    ASSERT_LT(place, seen.size());
    ASSERT_FALSE(seen[place]) << "position " << i << " comes twice";
    seen[place] = true;
  }
}

TEST(SampleSequence, RefusesIndicesBeyondItsSize) {
  SampleSequence sequence(0, SamplePositions::lattice);
  EXPECT_THAT([&] { static_cast<void>(sequence[SampleSequence::max_size]); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("1050625")));
  EXPECT_THROW(static_cast<void>(sequence[std::numeric_limits<std::size_t>::max()]),
               std::invalid_argument);
  EXPECT_EQ(sequence.size(), 0u);
}

}  // namespace
}  // namespace freqsynth
