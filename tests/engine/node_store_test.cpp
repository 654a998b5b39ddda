// SPDX-License-Identifier: MIT
#include "freqsynth/engine/node_store.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "support/oracles.h"

namespace freqsynth {
namespace {

constexpr std::size_t head = 5, rows = 3;

struct Owner {
  NodeStore::Chunk chunk;
  std::vector<std::vector<float>> rows;  // what they should hold
  std::vector<float> head;
};

void expect_held(const NodeStore& store, const Owner& owner) {
  for (std::size_t i = 0; i < head; ++i) ASSERT_EQ(owner.chunk.data[i], owner.head[i]);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* row = store.row(owner.chunk, r);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(row) % 32, 0u);
    for (std::size_t i = 0; i < owner.chunk.room(); ++i) {
      ASSERT_EQ(row[i], i < owner.rows[r].size() ? owner.rows[r][i] : 0);
    }
  }
}

TEST(NodeStore, KeepsWhatManyOwnersWrite) {
  NodeStore store(head, rows);
  oracle::Random random(1);
  std::vector<Owner> owners(300);
  for (int step = 0; step < 20000; ++step) {
    Owner& owner = owners[random.below(owners.size())];
    if (random.below(60) == 0) {
      store.give_back(owner.chunk);
      owner = {};
      continue;
    }
    const std::size_t used = owner.rows.empty() ? 0 : owner.rows[0].size();
    if (used == 1096) continue;
    store.enlarge(owner.chunk, used, used + 1);
    ASSERT_GE(owner.chunk.room(), used + 1);
    owner.rows.resize(rows);
    owner.head.resize(head);
    for (std::size_t r = 0; r < rows; ++r) {
      owner.rows[r].push_back(random.value());
      store.row(owner.chunk, r)[used] = owner.rows[r].back();
    }
    const std::size_t at = random.below(head);
    owner.chunk.data[at] = owner.head[at] = random.value();
  }
  std::size_t floats = 0;
  for (const Owner& owner : owners) {
    if (!owner.chunk) continue;
    ASSERT_NO_FATAL_FAILURE(expect_held(store, owner));
    floats += 8 + rows * owner.chunk.room();
  }
  EXPECT_EQ(store.bytes_in_use(), floats * sizeof(float));
  EXPECT_GE(store.bytes(), store.bytes_in_use());
}

TEST(NodeStore, HandsOutWhatWasGivenBackBeforeItTakesMore) {
  NodeStore store(head, rows);
  std::vector<NodeStore::Chunk> chunks;
  for (int i = 0; i < 1000; ++i) chunks.push_back(store.take(81));
  const std::size_t bytes = store.bytes();
  for (int round = 0; round < 5; ++round) {
    for (NodeStore::Chunk& chunk : chunks) {
      store.row(chunk, 0)[3] = 1;
      store.give_back(chunk);
      EXPECT_FALSE(chunk);
    }
    EXPECT_EQ(store.bytes_in_use(), 0u);
    for (NodeStore::Chunk& chunk : chunks) {
      chunk = store.take(60);
      ASSERT_EQ(store.row(chunk, 0)[3], 0);
    }
  }
  EXPECT_EQ(store.bytes(), bytes);
}

TEST(NodeStore, HasRoomForCompleteLattices) {
  NodeStore store(head, rows);
  for (const std::size_t samples : {1u, 25u, 81u, 289u, 1089u}) {
    NodeStore::Chunk chunk = store.take(samples);
    EXPECT_GE(chunk.room(), samples);
    EXPECT_LE(chunk.room(), samples + 7);
  }
}

}  // namespace
}  // namespace freqsynth
