// SPDX-License-Identifier: MIT
#include "guard.h"

#include <algorithm>
#include <random>

namespace live {
namespace {

std::string random_token() {
  std::random_device random;
  std::string token;
  for (int i = 0; i < 32; ++i) token += "0123456789abcdef"[random() % 16];
  return token;
}

/// As long for any wrong token of its length.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned>(a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

Guard::Guard(const std::vector<std::string>& names, unsigned port) : token_(random_token()) {
  for (const std::string& name : names) {
    hosts_.push_back(name + ":" + std::to_string(port));
    if (port == 80) hosts_.push_back(name);
  }
}

bool Guard::may_read(const Credentials& request) const {
  return std::find(hosts_.begin(), hosts_.end(), request.host) != hosts_.end();
}

bool Guard::may_change(const Credentials& request) const {
  return may_read(request) && same(request.token, token_) &&
         (request.origin.empty() || request.origin == "http://" + request.host) &&
         request.content_type == "application/json";
}

std::vector<std::string> names_of(const std::string& address, const std::string& name) {
  std::vector<std::string> names{"127.0.0.1", "localhost", "[::1]"};
  names.push_back(address.find(':') == std::string::npos ? address : "[" + address + "]");
  if (!name.empty()) names.push_back(name);
  return names;
}

}  // namespace live
