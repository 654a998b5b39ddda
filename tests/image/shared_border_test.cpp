// SPDX-License-Identifier: MIT
#include "freqsynth/image/shared_border.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "freqsynth/basis/aligned.h"
#include "freqsynth/basis/shared_list.h"
#include "freqsynth/image/pixel_agreement.h"
#include "freqsynth/refine/least_squares_refiner.h"

namespace freqsynth {
namespace {

using Function = std::function<double(double s, double t)>;
constexpr std::size_t samples = 600;

/// The samples of a block and what pixels show, its own and those of its neighbours.
struct Block {
  explicit Block(const Function& function)
      : list(InverseListSettings{}), refiner(list, 1), state(refiner.state_size()) {
    refiner.reset(state.data());
    OwnedSamples owned;
    for (std::size_t n = 0; n < samples; ++n) {
      const SequencePosition& position = list->position(n);
      const auto value = static_cast<float>(function(position.s, position.t));
      refiner.absorb(state.data(), n, &value);
      owned.add(list->row(n));
      border.add(position, list->row(n));
    }
    for (std::size_t k = 0; k < 9; ++k) {
      for (std::size_t pixel = 0; pixel < max_terms; ++pixel) {
        // The middle of the pixel stands for its samples.
        const double x =
            static_cast<double>(k % 3) - 1 + (static_cast<double>(pixel % 8) + 0.5) / 8;
        const double y =
            static_cast<double>(k / 3) - 1 + (static_cast<double>(pixel / 8) + 0.5) / 8;
        means[k][pixel] = static_cast<float>(function(x, y));
      }
      pointers[k] = means[k].data();
    }
    owned.means(refiner.own_sums(state.data(), 0), means[4]);
  }

  [[nodiscard]] std::vector<Gap> foreign() const {
    return border.foreign(refiner.fit(state.data(), samples, 0), pointers, *list);
  }

  SharedInverseList list;
  LeastSquaresRefiner refiner;
  detail::AlignedVector<float> state;
  SharedBorder border;
  std::array<std::array<float, max_terms>, 9> means;
  BlocksMeans pointers;
};

TEST(SharedBorder, SamplesBeyondAnEdgeOnItAreFound) {
  const auto dark = [](double s, double t) { return 0.1 + 0.02 * s + 0.03 * t; };
  const auto bright = [](double s, double t) { return 2 + 0.2 * t - 0.1 * s; };
  const std::array<std::function<bool(double, double)>, 4> outside{
      [](double s, double) { return s <= 0; }, [](double s, double) { return s >= 1; },
      [](double, double t) { return t <= 0; }, [](double, double t) { return t >= 1; }};
  for (const auto& out : outside) {
    const Block block([&](double s, double t) { return out(s, t) ? bright(s, t) : dark(s, t); });
    const std::vector<Gap> found = block.foreign();
    std::size_t next = 0;
    for (std::size_t n = 0; n < samples; ++n) {
      const SequencePosition& position = block.list->position(n);
      if (!out(position.s, position.t)) continue;
      ASSERT_LT(next, found.size());
      EXPECT_EQ(found[next].sample, n);
      EXPECT_NEAR(double{found[next].value}, bright(position.s, position.t), 0.25);
      ++next;
    }
    EXPECT_EQ(next, found.size());
    EXPECT_GT(next, 8u);
    // The owner of the samples sees nothing odd.
    const Block owner([&](double s, double t) {
      const bool inside = s >= 0 && s <= 1 && t >= 0 && t <= 1;
      return inside ? bright(s, t) : dark(s, t);
    });
    EXPECT_TRUE(owner.foreign().empty());
  }
}

TEST(SharedBorder, OtherEdgesAndSlopesHaveNone) {
  const std::vector<Function> functions{
      [](double s, double) { return s; },
      [](double s, double t) { return std::sin(7 * s + 4 * t); },
      [](double s, double) { return s > 0.93 ? 2.0 : 0.1; },
      [](double s, double t) { return s + 0.2 * t > 1 ? 2.0 : 0.1; },
      [](double s, double t) { return s >= 1 && t > 0.5 ? 2.0 : 0.1; },
      [](double, double) { return 1.0; }};
  for (const Function& function : functions) EXPECT_TRUE(Block(function).foreign().empty());
}

TEST(SharedBorder, NothingIsFoundWhereNothingIsKnownOfTheNeighbour) {
  Block block([](double s, double) { return s >= 1 ? 2.0 : 0.1; });
  EXPECT_FALSE(block.foreign().empty());
  block.pointers[5] = nullptr;
  EXPECT_TRUE(block.foreign().empty());
}

}  // namespace
}  // namespace freqsynth
