// SPDX-License-Identifier: MIT
#include "freqsynth/engine/block_grid.h"
#include "freqsynth/basis/sample_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace freqsynth {
namespace {

using Block = std::uint32_t;
using Place = std::pair<double, double>;
using Sharer = std::pair<std::uint32_t, std::uint32_t>;  // block, index

/// A complete lattice of 17 x 17.
constexpr std::uint32_t count = 289;

std::vector<SequencePosition> positions_of_sequence(std::uint64_t seed) {
  SampleSequence sequence(seed);
  std::vector<SequencePosition> positions;
  for (std::uint32_t i = 0; i < count; ++i) positions.push_back(sequence[i]);
  return positions;
}

/// Place in the plane in units of blocks. Whole multiples of 1/16: equal or not, without rounding.
Place place_of(const BlockGrid& grid, Block block, const SequencePosition& position) {
  return {static_cast<double>(block % grid.blocks_x) + position.s,
          static_cast<double>(block / grid.blocks_x) + position.t};
}

struct Size {
  std::size_t x, y;
};

class Grids : public testing::TestWithParam<Size> {
 protected:
  BlockGrid grid_ = BlockGrid::of(8 * GetParam().x, 8 * GetParam().y, 1);
};
INSTANTIATE_TEST_SUITE_P(Sizes, Grids,
                         testing::Values(Size{1, 1}, Size{1, 5}, Size{5, 1}, Size{2, 2},
                                         Size{3, 4}));

TEST_P(Grids, BlocksAreNumberedRowByRow) {
  ASSERT_EQ(grid_.size(), GetParam().x * GetParam().y);
  std::size_t block = 0;
  for (std::size_t y = 0; y < GetParam().y; ++y) {
    for (std::size_t x = 0; x < GetParam().x; ++x, ++block) {
      EXPECT_EQ(grid_.column(block), x);
      EXPECT_EQ(grid_.row(block), y);
    }
  }
}

TEST_P(Grids, PointsAreSharedByAllOtherBlocksThatHaveThem) {
  for (const std::uint64_t seed : {0u, 3u}) {
    const auto positions = positions_of_sequence(seed);
    std::map<Place, std::vector<Sharer>> owners;
    for (Block block = 0; block < grid_.size(); ++block) {
      for (std::uint32_t i = 0; i < count; ++i) {
        owners[place_of(grid_, block, positions[i])].push_back({block, i});
      }
    }
    std::size_t most = 0;
    for (Block block = 0; block < grid_.size(); ++block) {
      for (std::uint32_t i = 0; i < count; ++i) {
        std::vector<Sharer> expected = owners[place_of(grid_, block, positions[i])];
        std::erase(expected, Sharer{block, i});
        std::vector<Sharer> found;
        grid_.visit_sharing(block, positions[i], [&](std::uint32_t other, std::uint32_t index) {
          found.push_back({other, index});
        });
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected) << "block " << block << ", index " << i;
        most = std::max(most, found.size());
      }
    }
    EXPECT_EQ(most, GetParam().x > 1 && GetParam().y > 1
                        ? 3u
                        : std::min<std::size_t>(grid_.size() - 1, 1));
  }
}

TEST_P(Grids, BlocksBesideShareAnEdge) {
  const auto distance = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  for (Block block = 0; block < grid_.size(); ++block) {
    std::vector<Block> expected, found;
    for (Block other = 0; other < grid_.size(); ++other) {
      const std::size_t steps = distance(grid_.column(block), grid_.column(other)) +
                                distance(grid_.row(block), grid_.row(other));
      if (steps == 1) expected.push_back(other);
    }
    grid_.visit_beside(block, [&](std::uint32_t other) { found.push_back(other); });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << "block " << block;
  }
}

TEST_P(Grids, NamesAreThoseOfPoints) {
  const auto positions = positions_of_sequence(0);
  std::map<Place, std::uint64_t> names;
  for (Block block = 0; block < grid_.size(); ++block) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint64_t name = grid_.name(block, i, positions[i]);
      const auto [known, first] = names.emplace(place_of(grid_, block, positions[i]), name);
      ASSERT_EQ(name, known->second) << "block " << block << ", index " << i;
    }
  }
  // All points of a lattice whose blocks overlap by their borders, each with a name of its own.
  EXPECT_EQ(names.size(), (16 * GetParam().x + 1) * (16 * GetParam().y + 1));
  std::set<std::uint64_t> distinct;
  for (const auto& [place, name] : names) distinct.insert(name);
  EXPECT_EQ(distinct.size(), names.size());
}

TEST(BlockGrid, NamesAreDistinctAtTheEndOfTheSequenceToo) {
  // The largest indices of one block and the smallest of the next, in the largest of grids.
  const BlockGrid grid = BlockGrid::of(16, std::size_t{2147483647} * 8, 1);
  const auto last_block = static_cast<Block>(grid.size() - 1);
  SequencePosition inside;
  inside.side = BlockSide::interior;
  std::set<std::uint64_t> names;
  for (const Block block : {Block{0}, Block{1}, last_block - 1, last_block}) {
    for (const std::size_t index :
         {std::size_t{4}, SampleSequence::max_size - 2, SampleSequence::max_size - 1}) {
      names.insert(grid.name(block, static_cast<std::uint32_t>(index), inside));
    }
  }
  EXPECT_EQ(names.size(), 12u);
}

TEST(BlockGrid, NothingLiesBelowTheLastRowOfTheLargestGrid) {
  constexpr Block columns = 2147483647;
  const BlockGrid grid = BlockGrid::of(std::size_t{columns} * 8, 16, 1);
  const auto last = static_cast<Block>(grid.size() - 1);
  std::vector<Block> found;
  grid.visit_beside(last, [&](Block other) { found.push_back(other); });
  EXPECT_EQ(found, (std::vector<Block>{last - 1, last - columns}));
  std::vector<Block> sharing;
  for (const SequencePosition& position : positions_of_sequence(0)) {
    if (position.side != BlockSide::bottom) continue;
    grid.visit_sharing(last, position,
                       [&](Block other, std::uint32_t) { sharing.push_back(other); });
  }
  EXPECT_TRUE(sharing.empty());
}

TEST(BlockGrid, BlocksTileTheImage) {
  const auto positions = positions_of_sequence(0);
  for (std::size_t width = 1; width <= 17; ++width) {
    for (std::size_t height = 1; height <= 17; ++height) {
      const BlockGrid grid = BlockGrid::of(width, height, 3);
      // Whole multiples of 1/16: exact, so that points are equal or not without rounding.
      std::map<Place, std::uint64_t> names;
      std::set<std::uint64_t> distinct;
      for (Block block = 0; block < grid.size(); ++block) {
        const std::size_t left = 8 * grid.column(block), top = 8 * grid.row(block);
        const std::size_t across = std::min<std::size_t>(8, width - left);
        const std::size_t down = std::min<std::size_t>(8, height - top);
        for (std::uint32_t i = 0; i < count; ++i) {
          const BlockGrid::Point point = grid.point(block, positions[i]);
          ASSERT_EQ(point.x,
                    static_cast<double>(left) + positions[i].s * static_cast<double>(across));
          ASSERT_EQ(point.y, static_cast<double>(top) + positions[i].t * static_cast<double>(down));
          ASSERT_TRUE(point.x >= 0 && point.x <= static_cast<double>(width));
          ASSERT_TRUE(point.y >= 0 && point.y <= static_cast<double>(height));
          // A point has one name, whichever block asks.
          const std::uint64_t name = grid.name(block, i, positions[i]);
          ASSERT_EQ(names.emplace(Place(point.x, point.y), name).first->second, name);
          distinct.insert(name);
        }
      }
      ASSERT_EQ(distinct.size(), names.size()) << width << " x " << height;
      ASSERT_EQ(names.size(), (16 * grid.blocks_x + 1) * (16 * grid.blocks_y + 1));
      ASSERT_TRUE(names.contains(Place(width, height)));
    }
  }
}

TEST(BlockGrid, BlocksCoverAllPixels) {
  for (std::size_t width = 0; width <= 17; ++width) {
    for (std::size_t height = 0; height <= 17; ++height) {
      const BlockGrid grid = BlockGrid::of(width, height, 1);
      EXPECT_EQ(grid.width, width);
      EXPECT_EQ(grid.height, height);
      // Every pixel votes for the block that it lies in.
      std::map<std::pair<std::size_t, std::size_t>, std::size_t> pixels;
      for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) ++pixels[{x / 8, y / 8}];
      }
      ASSERT_EQ(grid.size(), pixels.size());
      for (std::size_t block = 0; block < grid.size(); ++block) {
        const auto expected = pixels.find({grid.column(block), grid.row(block)});
        ASSERT_NE(expected, pixels.end());
        ASSERT_EQ(grid.block_width(block) * grid.block_height(block), expected->second);
        ASSERT_EQ(64 * grid.area(block), static_cast<float>(expected->second));
      }
    }
  }
}

}  // namespace
}  // namespace freqsynth
