// SPDX-License-Identifier: MIT
// Positions of the bent lattice.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {
namespace {

std::vector<SequencePosition> positions(SamplePositions kind, std::size_t count) {
  SampleSequence sequence(3, kind);
  std::vector<SequencePosition> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(sequence[i]);
  return all;
}

TEST(BentPositions, AreThoseOfTheLatticeButForThePlace) {
  const auto bent = positions(SamplePositions::bent, 4225);
  const auto lattice = positions(SamplePositions::lattice, 4225);
  for (std::size_t i = 0; i < bent.size(); ++i) {
    ASSERT_EQ(bent[i].side, lattice[i].side);
    ASSERT_EQ(bent[i].rank, lattice[i].rank);
    ASSERT_EQ(bent[i].partner, lattice[i].partner);
    ASSERT_EQ(bent[i].spacing, lattice[i].spacing);
    ASSERT_TRUE(bent[i].s >= 0 && bent[i].s <= 1 && bent[i].t >= 0 && bent[i].t <= 1);
    ASSERT_LT(std::hypot(bent[i].s - lattice[i].s, bent[i].t - lattice[i].t), 0.13);
  }
}

TEST(BentPositions, OfASideStayOnItAndArePartnersOfTheOpposite) {
  const auto bent = positions(SamplePositions::bent, 4225);
  for (const SequencePosition& position : bent) {
    const SequencePosition& partner = bent[position.partner];
    switch (position.side) {
      case BlockSide::left:
        ASSERT_EQ(position.s, 0);
        ASSERT_EQ(partner.s, 1);
        ASSERT_EQ(position.t, partner.t);
        break;
      case BlockSide::top:
        ASSERT_EQ(position.t, 0);
        ASSERT_EQ(partner.t, 1);
        ASSERT_EQ(position.s, partner.s);
        break;
      case BlockSide::interior:
        ASSERT_TRUE(position.s > 0 && position.s < 1 && position.t > 0 && position.t < 1);
        break;
      default:
        break;
    }
  }
}

TEST(BentPositions, OfTheInteriorHardlyShareColumnsRowsOrBordersOfPixels) {
  std::set<double> columns, rows;
  std::size_t interior = 0, on_border = 0;
  for (const SequencePosition& position : positions(SamplePositions::bent, 1089)) {
    if (position.side != BlockSide::interior) continue;
    ++interior;
    columns.insert(position.s);
    rows.insert(position.t);
    if (8 * position.s == std::round(8 * position.s)) ++on_border;
    if (8 * position.t == std::round(8 * position.t)) ++on_border;
  }
  EXPECT_EQ(interior, 31u * 31u);
  // All but those in the middle lines of the flow. On the lattice it is 434, 31 and 31.
  EXPECT_LT(on_border, interior / 30);
  EXPECT_GT(columns.size(), interior - interior / 10);
  EXPECT_GT(rows.size(), interior - interior / 10);
}

TEST(BentPositions, AreAboutAsEvenAsTheLattice) {
  for (const std::size_t side : {3u, 5u, 9u, 17u, 33u}) {
    const auto bent = positions(SamplePositions::bent, side * side);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bent.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        nearest = std::min(nearest, std::hypot(bent[i].s - bent[j].s, bent[i].t - bent[j].t));
      }
    }
    EXPECT_GT(nearest, 0.6 / static_cast<double>(side - 1)) << side;
  }
}

/// Share of the positions that see the bar of a fence with bars of a fifth of its period.
double seen(const std::vector<SequencePosition>& all, double period, double offset) {
  double sum = 0;
  for (const SequencePosition& position : all) {
    const double at = (8 * position.s + offset) / period;
    sum += at - std::floor(at) < 0.2 ? 1 : 0;
  }
  return sum / static_cast<double>(all.size());
}

TEST(BentPositions, SeePatternsThatRepeatWithTheLattice) {
  for (const double period : {1.0, 0.5, 0.25}) {
    for (const double offset : {0.0, 0.07, 0.3}) {
      for (const std::size_t count : {81u, 289u, 1089u}) {
        EXPECT_NEAR(seen(positions(SamplePositions::bent, count), period, offset), 0.2, 0.3)
            << period << ", " << offset << ", " << count;
      }
    }
  }
  EXPECT_EQ(seen(positions(SamplePositions::lattice, 289), 0.5, 0), 1) << "what they are for";
}

TEST(BentPositions, LeaveNoRoomForLargeDiscs) {
  // The first m^0.82 positions, for the m of 1/4, 1, 4 and 16 samples per pixel.
  const std::pair<std::size_t, double> largest[] = {{15, 2}, {37, 1.5}, {105, 0.8}, {310, 0.4}};
  constexpr int steps = 200;
  for (const auto& [count, radius] : largest) {
    const auto all = positions(SamplePositions::bent, count);
    double worst = 0;
    for (int place = 0; place < steps * steps; ++place) {
      const double s = (place % steps + 0.5) / steps, t = (place / steps + 0.5) / steps;
      double nearest = 2;
      for (const SequencePosition& position : all) {
        nearest = std::min(nearest, std::hypot(position.s - s, position.t - t));
      }
      worst = std::max(worst, nearest);
    }
    // Places between those that were tried are at most half a diagonal away.
    EXPECT_LT(8 * (worst + 0.5 * std::sqrt(2.0) / steps), radius) << count;
  }
}

}  // namespace
}  // namespace freqsynth
