// SPDX-License-Identifier: MIT
#include "freqsynth/engine/team_work.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace freqsynth {
namespace {

using detail::TeamWork;

/// Counts what is done of each of three stages, and by that checks their order.
struct Work {
  static constexpr std::array<std::size_t, 3> sizes{40, 1, 7};
  std::size_t stage = 0;
  std::array<std::vector<std::atomic<int>>, 3> done{std::vector<std::atomic<int>>(40),
                                                    std::vector<std::atomic<int>>(1),
                                                    std::vector<std::atomic<int>>(7)};
  std::atomic<int> at_work = 0, too_early = 0;

  TeamWork::Job job() {
    return {this,
            [](void* self, std::size_t piece) {
              Work& work = *static_cast<Work*>(self);
              ++work.at_work;
              ++work.done[work.stage][piece];
              std::this_thread::yield();
              --work.at_work;
            },
            [](void* self) -> std::size_t {
              Work& work = *static_cast<Work*>(self);
              work.too_early += work.at_work != 0 ? 1 : 0;
              return ++work.stage < sizes.size() ? sizes[work.stage] : 0;
            }};
  }
  void expect_done() const {
    EXPECT_EQ(stage, sizes.size());
    EXPECT_EQ(too_early, 0) << "a stage began before all of the one before was done";
    for (const auto& stage_done : done) {
      for (const std::atomic<int>& times : stage_done) EXPECT_EQ(times, 1);
    }
  }
};

TEST(TeamWork, NeedsOneThread) {
  TeamWork team;
  Work work;
  EXPECT_FALSE(team.active());
  EXPECT_FALSE(team.finish_stage());
  team.help();
  team.begin(work.job(), Work::sizes[0]);
  EXPECT_TRUE(team.active());
  EXPECT_EQ(team.left(), 40u);
  team.help();
  EXPECT_EQ(team.left(), 39u);
  EXPECT_TRUE(team.finish_stage());
  EXPECT_EQ(team.left(), 1u);
  team.help();
  team.help();
  EXPECT_EQ(work.stage, 1u) << "who helps with a piece goes to no other stage";
  team.finish();
  EXPECT_FALSE(team.active());
  work.expect_done();
}

TEST(TeamWorkOfThreads, IsDoneOnceWhoeverHelps) {
  TeamWork team;
  std::atomic<bool> over = false;
  std::vector<std::thread> helpers;
  for (int i = 0; i < 3; ++i) {
    helpers.emplace_back([&, i] {
      while (!over) {
        if (i == 0) {
          team.help();
        } else {
          team.finish();
        }
        std::this_thread::yield();
      }
    });
  }
  for (int round = 0; round < 30; ++round) {
    Work work;
    team.begin(work.job(), Work::sizes[0]);
    team.finish();
    EXPECT_FALSE(team.active());
    work.expect_done();
  }
  over = true;
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace
}  // namespace freqsynth
