// SPDX-License-Identifier: MIT
#include "freqsynth/basis/node_positions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <utility>

#include "freqsynth/basis/sample_sequence.h"

namespace freqsynth {
namespace {

constexpr double perturbation = 0.3;

std::set<std::pair<int, int>> places(std::span<const NodePosition> positions) {
  std::set<std::pair<int, int>> set;
  for (const NodePosition& p : positions) set.insert({p.s, p.t});
  return set;
}

TEST(NodePositions, AreTheLatticeOfTheSequenceWhereNothingIsMoved) {
  const NodePositions positions(3);
  SampleSequence sequence(3, SamplePositions::lattice);
  ASSERT_EQ(positions.classes(), 4u);
  for (std::size_t of = 0; of < 4; ++of) {
    EXPECT_EQ(positions.pixels(of), std::size_t{8} >> of);
    for (std::size_t i = 0; i < NodePositions::size; ++i) {
      ASSERT_EQ(positions.s(of, i), sequence[i].s) << of << " " << i;
      ASSERT_EQ(positions.t(of, i), sequence[i].t) << of << " " << i;
    }
  }
  for (std::size_t i = 0; i < NodePositions::size; ++i) {
    ASSERT_EQ(positions.spacing(i), sequence[i].spacing);
  }
}

TEST(NodePositions, OfBlocksAreMovedByAShareOfTheSpacing) {
  const NodePositions positions(5, perturbation), plain(5);
  ASSERT_EQ(positions.classes(), 22u);
  SampleSequence sequence(5, SamplePositions::lattice);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < NodePositions::size; ++i) {
    const NodePosition& p = positions.of(0)[i];
    const NodePosition& before = plain.of(0)[i];
    // 4 samples lie on the lattice of spacing 1, 9 on that of 1/2, 25 on that of 1/4.
    const double spacing = i < 4 ? 1 : i < 9 ? 0.5 : i < 25 ? 0.25 : 0.125;
    const bool may = i >= 4 && i < NodePositions::moved;
    const double most = may ? perturbation * spacing * NodePositions::edge + 0.5 : 0;
    EXPECT_LE(std::abs(p.s - before.s), most) << i;
    EXPECT_LE(std::abs(p.t - before.t), most) << i;
    for (const int end : {0, NodePositions::edge}) {
      EXPECT_EQ(p.s == end, before.s == end) << i;
      EXPECT_EQ(p.t == end, before.t == end) << i;
    }
    moved += p == before ? 0 : 1;
    const SequencePosition& own = sequence[i];
    if (own.partner == i) continue;
    const NodePosition& partner = positions.of(0)[own.partner];
    EXPECT_TRUE(p.s == partner.s || p.t == partner.t) << i;
  }
  EXPECT_GT(moved, 70u);
  EXPECT_NE(places(positions.of(0)), places(NodePositions(6, perturbation).of(0)));
}

TEST(NodePositions, OfEachClassAreAllDifferent) {
  const NodePositions positions(5, perturbation);
  for (std::size_t of = 0; of < positions.classes(); ++of) {
    EXPECT_EQ(places(positions.of(of)).size(), NodePositions::size) << of;
  }
}

class HandedDown : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Moves, HandedDown, testing::Values(0.0, perturbation, 0.45));

TEST_P(HandedDown, SamplesOfQuadrantsAreThoseOfTheWhole) {
  const NodePositions positions(2, GetParam());
  for (std::size_t of = 0; of < positions.classes(); ++of) {
    for (const std::size_t samples : {81u, 289u, 1089u}) {
      const std::size_t count = NodePositions::handed_down(samples);
      std::set<std::uint32_t> all;
      std::size_t elsewhere = 0;
      for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_LT(positions.in_parent(quadrant, i), samples);
          all.insert(positions.in_parent(quadrant, i));
          const std::size_t to = positions.quadrant_class(of, quadrant);
          const double s = (positions.s(to, i) + static_cast<double>(quadrant % 2)) / 2;
          const double t = (positions.t(to, i) + static_cast<double>(quadrant / 2)) / 2;
          const auto there = positions.in_parent(quadrant, i);
          const bool same = s == positions.s(of, there) && t == positions.t(of, there);
          EXPECT_EQ(same, positions.same_place(of, quadrant, i));
          elsewhere += same ? 0 : 1;
          EXPECT_TRUE(same || i < 4);
        }
      }
      // None is lost, but at the corners of the first nodes that have no list of their own.
      EXPECT_EQ(all.size(), samples);
      const bool last = positions.classes() == 22 && of >= 5 && of < 21;
      EXPECT_EQ(elsewhere > 0, last) << of;
      EXPECT_LE(elsewhere, last ? 16u : 0u);
    }
  }
}

TEST_P(HandedDown, PointsOnBordersAreFoundByTheirPlace) {
  const NodePositions positions(2, GetParam());
  for (std::size_t of = 0; of < positions.classes(); ++of) {
    std::size_t found = 0;
    for (std::uint32_t i = 0; i < NodePositions::size; ++i) {
      const NodePosition& p = positions.of(of)[i];
      const bool border = NodePositions::on_border(p);
      EXPECT_EQ(positions.index_at(of, p), border ? i : NodePositions::none);
      found += border ? 1 : 0;
    }
    EXPECT_GE(found, 116u);
    EXPECT_EQ(positions.index_at(of, {1, 0}), NodePositions::none);
    EXPECT_EQ(positions.index_at(of, {0, -512}), NodePositions::none);
  }
}

TEST(NodePositions, OfQuadrantsBehindTheFirstLieOnTheLattice) {
  const NodePositions positions(2, perturbation), plain(2);
  for (std::size_t of = 1; of < positions.classes(); ++of) {
    for (std::size_t i = 25; i < NodePositions::size; ++i) {
      ASSERT_EQ(positions.of(of)[i], plain.of(0)[i]);
    }
  }
  EXPECT_TRUE(std::equal(positions.of(21).begin(), positions.of(21).end(), plain.of(0).begin()));
}

TEST(NodePositions, RefuseMovesThatWouldMeet) {
  EXPECT_THROW(NodePositions(0, -0.1), std::invalid_argument);
  EXPECT_THROW(NodePositions(0, 0.5), std::invalid_argument);
  EXPECT_THROW(NodePositions(0, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
