// SPDX-License-Identifier: MIT
#include "freqsynth/basis/innovation_store.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "freqsynth/basis/node_positions.h"
#include "freqsynth/refine/kriging_refiner.h"
#include "freqsynth/refine/prior_bank.h"

namespace freqsynth {
namespace {

using List = std::shared_ptr<const InnovationList>;

Covariance rough() { return Covariance::isotropic(CovarianceShape::exponential, 0.7, 0.003); }

std::vector<UnitPoint> some_points(std::size_t count) {
  std::vector<UnitPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points[i] = {static_cast<double>(i * 7 % 41) / 41, static_cast<double>(i * 11 % 37) / 37};
  }
  return points;
}

TEST(InnovationStore, GivesTheSameListAsLongAsSomebodyHoldsIt) {
  const std::vector<UnitPoint> points = some_points(30);
  List list = shared_innovations(rough(), points, {});
  EXPECT_EQ(shared_innovations(rough(), points, {}), list);
  EXPECT_EQ(list->covariance(), rough());
  EXPECT_EQ(list->positions().size(), points.size());
  EXPECT_EQ(list->row(29).factor.size(), 29u);
  EXPECT_EQ(shared_innovations(rough(), points, {})->size(), 30u);
  const std::weak_ptr<const InnovationList> gone = list;
  list.reset();
  EXPECT_TRUE(gone.expired());
  EXPECT_EQ(shared_innovations(rough(), points, {})->size(), 0u);
}

TEST(InnovationStore, TellsListsApart) {
  const std::vector<UnitPoint> points = some_points(30);
  std::vector<UnitPoint> moved = points, swapped = points;
  moved[17].t += 1e-9;
  std::swap(swapped[3], swapped[4]);
  Covariance noisier = rough(), smoother = rough();
  noisier.noise *= 2;
  smoother.shape = CovarianceShape::matern32;
  const std::vector<List> lists = {shared_innovations(rough(), points, {}),
                                   shared_innovations(rough(), moved, {}),
                                   shared_innovations(rough(), swapped, {}),
                                   shared_innovations(rough(), std::span(points).first(29), {}),
                                   shared_innovations(noisier, points, {}),
                                   shared_innovations(smoother, points, {}),
                                   shared_innovations(rough(), points, AverageGrid::of_node(4))};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(lists[i], lists[j]) << i << ", " << j;
  }
  EXPECT_EQ(lists[1]->positions()[17].t, moved[17].t);
  EXPECT_EQ(lists[4]->covariance(), noisier);
  EXPECT_EQ(lists[6]->grid(), AverageGrid::of_node(4));
}

TEST(InnovationStore, RefusesWhatAListRefuses) {
  EXPECT_THROW(static_cast<void>(shared_innovations(rough(), {}, {})), std::invalid_argument);
}

// Far more than are held at a time.
TEST(InnovationStore, ForgetsListsThatHaveGone) {
  const std::vector<UnitPoint> points = some_points(5);
  const List kept = shared_innovations(rough(), points, AverageGrid::of_node(1));
  for (int i = 1; i <= 300; ++i) {
    Covariance other = rough();
    other.noise = i;
    ASSERT_EQ(shared_innovations(other, points, AverageGrid::of_node(1))->covariance().noise, i);
  }
  EXPECT_EQ(shared_innovations(rough(), points, AverageGrid::of_node(1)), kept);
}

TEST(InnovationStore, IsOneForSeveralThreads) {
  const std::vector<UnitPoint> points = some_points(60);
  const InnovationList alone(rough(), points, {});
  constexpr std::size_t count = 4;
  std::vector<List> lists(count);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < count; ++t) {
    threads.emplace_back([&, t] {
      lists[t] = shared_innovations(rough(), points, {});
      lists[t]->reserve(20 + 10 * t);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const List& list : lists) EXPECT_EQ(list, lists[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(lists[0]->row(i).variance, alone.row(i).variance);
    EXPECT_EQ(lists[0]->row(i).inverse_pivot, alone.row(i).inverse_pivot);
  }
}

TEST(InnovationStore, ServesRefinersAndBanks) {
  const NodePositions positions(3, 0.3), same(3, 0.3), other(4, 0.3);
  const KrigingRefiner one(positions, {1}), two(same, {0.5f, 0.5f}), third(other, {1});
  EXPECT_EQ(&one.list(0), &two.list(0));
  EXPECT_NE(&one.list(0), &third.list(0));
  PriorBank bank;
  bank.add(rough());
  bank.add_waves(wave_priors());
  const std::vector<UnitPoint> points = some_points(100);
  const BankLists first(bank, points, AverageGrid::of_node(4));
  const BankLists second(bank, points, AverageGrid::of_node(4));
  EXPECT_EQ(&first[0], &second[0]);
  EXPECT_EQ(&first[5], &second[5]);
  EXPECT_EQ(&first.probe(5), &second.probe(5));
  EXPECT_NE(&first.probe(5), &first[5]);
}

}  // namespace
}  // namespace freqsynth
