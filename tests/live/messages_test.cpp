// SPDX-License-Identifier: MIT
#include "live/messages.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace live {
namespace {

TEST(Messages, AttentionHasAFrameAndAPointerOrNone) {
  EXPECT_FALSE(read_attention("{}").frame);
  EXPECT_FALSE(read_attention(R"({"frame": null, "pointer": null})").pointer);
  const Attention both = read_attention(R"({"frame": [1, 2.5, 3, 4], "pointer": [5, -6]})");
  EXPECT_EQ(both.frame->top, 2.5);
  EXPECT_EQ(both.frame->bottom, 4);
  EXPECT_EQ(both.pointer->y, -6);
}

TEST(Messages, RefuseWhatIsWrong) {
  for (const char* message :
       {"", "[]", "{", "nonsense", R"({"frame": 1})", R"({"frame": [1, 2, 3]})",
        R"({"frame": [1, 2, 1, 4]})", R"({"frame": [1, 2, 3, "4"]})", R"({"pointer": [1e999, 0]})",
        R"({"pointer": [1, 2, 3]})"}) {
    EXPECT_THROW((void)read_attention(message), std::invalid_argument) << message;
  }
  for (const char* message :
       {"{}", R"({"stops": 0})", R"({"stops": 9, "quality": 50})", R"({"stops": 0, "quality": 0})",
        R"({"stops": 0, "quality": 101})", R"({"stops": "0", "quality": 50})"}) {
    EXPECT_THROW((void)read_view(message), std::invalid_argument) << message;
  }
  EXPECT_EQ(read_view(R"({"stops": -1.5, "quality": 30})").stops, -1.5);
}

}  // namespace
}  // namespace live
