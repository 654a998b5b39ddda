// SPDX-License-Identifier: MIT
// Structs of the interface for C: what is in them, and programs that know less or more of it.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth {
namespace {

TEST(CStructs, RequestsAreThoseOfCxx) {
  EXPECT_EQ(sizeof(freqsynth_request), 64u);
  EXPECT_EQ(sizeof(freqsynth_request), sizeof(Request));
  EXPECT_EQ(offsetof(freqsynth_request, again), 56u);
  EXPECT_EQ(sizeof(freqsynth_bad_sample), 24u);
  EXPECT_EQ(sizeof(freqsynth_channel), 8u);
}

TEST(CStructs, OfAnOlderProgramHaveDefaultsBehindTheirEnd) {
  freqsynth_settings settings;
  std::memset(&settings, 0xee, sizeof settings);
  freqsynth_settings_init(&settings, offsetof(freqsynth_settings, wave));
  EXPECT_EQ(settings.struct_size, offsetof(freqsynth_settings, wave));
  unsigned char untouched[sizeof settings.wave];
  std::memset(untouched, 0xee, sizeof untouched);
  EXPECT_EQ(std::memcmp(&settings.wave, untouched, sizeof untouched), 0) << "not its memory";
  settings.width = settings.height = 24;
  freqsynth_synthesizer* engine = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&settings, &engine), FREQSYNTH_OK)
      << freqsynth_last_error();
  // Results are not written beyond what it knows.
  freqsynth_stats stats;
  std::memset(&stats, 0xee, sizeof stats);
  stats.struct_size = offsetof(freqsynth_stats, waves);
  ASSERT_EQ(freqsynth_get_stats(engine, &stats), FREQSYNTH_OK);
  EXPECT_EQ(stats.samples, 0u);
  EXPECT_EQ(stats.waves, 0xeeeeeeeeeeeeeeeeu);
  stats.struct_size = 3;
  EXPECT_EQ(freqsynth_get_stats(engine, &stats), FREQSYNTH_INVALID_ARGUMENT);
  freqsynth_synthesizer_destroy(engine);
}

TEST(CStructs, OfANewerProgramAreReadUnlessTheySayMore) {
  struct Newer {
    freqsynth_settings settings;
    double more;
  } newer;
  std::memset(&newer, 0xee, sizeof newer);
  freqsynth_settings_init(&newer.settings, sizeof newer);
  EXPECT_EQ(newer.settings.struct_size, sizeof newer);
  EXPECT_EQ(newer.more, 0);
  newer.settings.width = newer.settings.height = 24;
  freqsynth_synthesizer* engine = nullptr;
  ASSERT_EQ(freqsynth_synthesizer_create(&newer.settings, &engine), FREQSYNTH_OK);
  struct NewerStats {
    freqsynth_stats stats;
    std::uint64_t more;
  } stats;
  std::memset(&stats, 0xee, sizeof stats);
  stats.stats.struct_size = sizeof stats;
  ASSERT_EQ(freqsynth_get_stats(engine, &stats.stats), FREQSYNTH_OK);
  EXPECT_EQ(stats.stats.blocks, 9u);
  EXPECT_EQ(stats.more, 0u);
  freqsynth_synthesizer_destroy(engine);
  newer.more = 1;
  EXPECT_EQ(freqsynth_synthesizer_create(&newer.settings, &engine), FREQSYNTH_INVALID_ARGUMENT);
  EXPECT_STREQ(freqsynth_last_error(), "freqsynth: settings has members of a newer version");
}

}  // namespace
}  // namespace freqsynth
