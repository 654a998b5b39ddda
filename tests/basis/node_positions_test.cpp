// SPDX-License-Identifier: MIT
#include "freqsynth/basis/node_positions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
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
  const NodePositions positions(5, perturbation);
  ASSERT_EQ(positions.classes(), 53u);
  SampleSequence sequence(5, SamplePositions::lattice);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < NodePositions::size; ++i) {
    const NodePosition& p = positions.of(0)[i];
    const NodePosition& before = positions.homes()[i];
    // 4 samples lie on the lattice of spacing 1, 9 on that of 1/2, 25 on that of 1/4.
    const double spacing = i < 4     ? 1
                           : i < 9   ? 0.5
                           : i < 25  ? 0.25
                           : i < 81  ? 0.125
                           : i < 289 ? 0.0625
                                     : 0.03125;
    const double most = i >= 4 ? perturbation * spacing * NodePositions::edge + 0.5 : 0;
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
  EXPECT_GT(moved, NodePositions::size - 20);
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
      // None is lost, but at the corners of pixels and of smaller nodes.
      EXPECT_EQ(all.size(), samples);
      const bool last = positions.classes() == 53 && of >= 5;
      EXPECT_EQ(elsewhere > 0, last) << of;
      EXPECT_LE(elsewhere, last ? 16u : 0u);
    }
  }
}

TEST_P(HandedDown, PointsOnBordersAreFoundByTheirHomes) {
  const NodePositions positions(2, GetParam());
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < NodePositions::size; ++i) {
    const NodePosition& home = positions.homes()[i];
    const bool border = NodePositions::on_border(home);
    EXPECT_EQ(positions.index_at(home), border ? i : NodePositions::none);
    found += border ? 1 : 0;
  }
  EXPECT_EQ(found, 128u);
  EXPECT_EQ(positions.index_at({1, 0}), NodePositions::none);
  EXPECT_EQ(positions.index_at({0, -512}), NodePositions::none);
}

/// All nodes of a block, with the places of samples in it.
class Walk {
 public:
  explicit Walk(const NodePositions& positions) : positions_(positions) { visit(0, 0, 0, 0); }

  std::map<std::pair<int, int>, std::pair<int, int>> places;  // by homes
  std::size_t twice = 0, elsewhere = 0;

 private:
  void visit(std::size_t of, int depth, int column, int row) {
    const auto place = [&](const NodePosition& p) {
      const int s = column * NodePositions::edge + p.s, t = row * NodePositions::edge + p.t;
      EXPECT_EQ(s % (1 << depth), 0);
      EXPECT_EQ(t % (1 << depth), 0);
      return std::pair(s >> depth, t >> depth);
    };
    for (std::size_t i = 0; i < 289; ++i) {
      // What is finer than the last lattice of the deepest nodes has no whole steps there.
      const auto [s, t] = place(positions_.homes()[i]);
      const auto there = place(positions_.of(of)[i]);
      const auto known = places.emplace(std::pair(s, t), there);
      if (known.second) continue;
      ++twice;
      if (known.first->second == there) continue;
      // Only corners of pixels, and of what is smaller, lie where others have theirs moved.
      ++elsewhere;
      EXPECT_LT(i, 4u) << depth;
      EXPECT_GE(depth, 3);
    }
    if (depth == 5) return;
    for (int k = 0; k < 4; ++k) {
      visit(positions_.quadrant_class(of, static_cast<std::size_t>(k)), depth + 1,
            2 * column + k % 2, 2 * row + k / 2);
    }
  }

  const NodePositions& positions_;
};

TEST_P(HandedDown, AllNodesThatShareASampleHaveItAtTheSamePlace) {
  const NodePositions positions(4, GetParam());
  const Walk walk(positions);
  EXPECT_GT(walk.twice, 50000u);
  EXPECT_EQ(walk.elsewhere > 0, GetParam() > 0);
  // And the block beside it does.
  for (const auto& [home, place] : walk.places) {
    if (home.first != 0) continue;
    const auto opposite = walk.places.find({NodePositions::edge, home.second});
    ASSERT_NE(opposite, walk.places.end());
    EXPECT_EQ(opposite->second, std::pair(NodePositions::edge, place.second));
    EXPECT_EQ(place.first, 0);
  }
}

TEST(NodePositions, OfSmallNodesDoNotRepeatWithTheLattice) {
  const NodePositions positions(2, perturbation), plain(2);
  for (std::size_t of = 21; of < positions.classes(); ++of) {
    for (const std::size_t samples : {81u, 289u}) {
      std::set<int> columns, rows;
      // Those in the first half of each of four, eight, .. waves along the edge.
      std::array<double, 2> in_light{}, below_light{};
      for (std::size_t i = 0; i < samples; ++i) {
        const NodePosition& p = positions.of(of)[i];
        columns.insert(p.s);
        rows.insert(p.t);
        for (int k = 0; k < 2; ++k) {
          const int wave = NodePositions::edge >> (2 + k);
          in_light[static_cast<std::size_t>(k)] += (p.s + wave) % wave < wave / 2 ? 1 : 0;
          below_light[static_cast<std::size_t>(k)] += (p.t + wave) % wave < wave / 2 ? 1 : 0;
        }
      }
      // 9 or 17 on the plain lattice.
      EXPECT_GE(columns.size(), samples / 3) << of;
      EXPECT_GE(rows.size(), samples / 3) << of;
      // All of them on the plain lattice of 81 for eight waves.
      const auto count = static_cast<double>(samples);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(in_light[k] / count, 0.5, 0.15) << of << " " << k;
        EXPECT_NEAR(below_light[k] / count, 0.5, 0.15) << of << " " << k;
      }
    }
  }
}

TEST(NodePositions, RefuseMovesThatWouldMeet) {
  EXPECT_THROW(NodePositions(0, -0.1), std::invalid_argument);
  EXPECT_THROW(NodePositions(0, 0.5), std::invalid_argument);
  EXPECT_THROW(NodePositions(0, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace freqsynth
