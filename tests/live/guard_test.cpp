// SPDX-License-Identifier: MIT
#include "live/guard.h"

#include <gtest/gtest.h>

namespace live {
namespace {

class GuardOfAPort : public testing::Test {
 protected:
  Guard guard{names_of("127.0.0.1", ""), 8000};
  Credentials good{"localhost:8000", "http://localhost:8000", guard.token(), "application/json"};
};

TEST_F(GuardOfAPort, LetsItsOwnPageIn) {
  EXPECT_TRUE(guard.may_change(good));
  good.host = "[::1]:8000";
  good.origin.clear();
  EXPECT_TRUE(guard.may_change(good));
}

TEST_F(GuardOfAPort, RefusesOtherHosts) {
  for (const char* host :
       {"", "localhost", "localhost:8001", "evil.example:8000", "localhost:80000",
        "127.0.0.1:8000.evil.example", "evil.localhost:8000", "0.0.0.0:8000"}) {
    Credentials other = good;
    other.host = host;
    other.origin = "http://" + other.host;
    EXPECT_FALSE(guard.may_read(other)) << host;
    EXPECT_FALSE(guard.may_change(other)) << host;
  }
}

TEST_F(GuardOfAPort, RefusesOtherOriginsAndForms) {
  for (const char* origin : {"null", "http://evil.example", "https://localhost:8000",
                             "http://127.0.0.1:8000", "http://localhost:8001"}) {
    Credentials other = good;
    other.origin = origin;
    EXPECT_TRUE(guard.may_read(other)) << origin;
    EXPECT_FALSE(guard.may_change(other)) << origin;
  }
  Credentials other = good;
  other.content_type = "text/plain";
  EXPECT_FALSE(guard.may_change(other));
}

TEST_F(GuardOfAPort, RefusesOtherTokens) {
  std::string changed = guard.token();
  changed.back() = changed.back() == '0' ? '1' : '0';
  for (const std::string& token : {std::string(), changed, guard.token() + "0",
                                   Guard(names_of("127.0.0.1", ""), 8000).token()}) {
    Credentials other = good;
    other.token = token;
    EXPECT_FALSE(guard.may_change(other)) << token;
  }
  EXPECT_EQ(guard.token().size(), 32u);
}

TEST(Guard, KnowsTheNamesThatItIsGiven) {
  const Guard guard(names_of("fe80::1", "studio.example"), 80);
  for (const char* host : {"[fe80::1]:80", "studio.example:80", "studio.example", "localhost"}) {
    EXPECT_TRUE(guard.may_read({host, "", "", ""})) << host;
  }
  EXPECT_FALSE(guard.may_read({"other.example", "", "", ""}));
}

}  // namespace
}  // namespace live
