// SPDX-License-Identifier: MIT
/// \file
/// Who may ask, and who may change something.
///
/// A page of another site can make a browser send requests to this machine. Such a request has
/// another Origin, or, where the site's name has been pointed at this machine, another Host; and it
/// does not know the token, which only the page has that this server hands out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace live {

/// What a request says of itself; empty: it does not.
struct Credentials {
  std::string host, origin, token, content_type;
};

/// Says no.
class Guard {
 public:
  /// \param names  that this server may be called by, without a port
  Guard(const std::vector<std::string>& names, unsigned port);

  /// What the page has to send with what changes something: 32 random hexadecimal digits.
  [[nodiscard]] const std::string& token() const { return token_; }

  /// Whether the request is meant for this server.
  [[nodiscard]] bool may_read(const Credentials& request) const;
  /// Whether it comes from this server's page, or from who was told its token, in a form that
  /// browsers send to other sites only if these agree.
  [[nodiscard]] bool may_change(const Credentials& request) const;

 private:
  std::vector<std::string> hosts_;
  std::string token_;
};

/// The names of this machine for itself, `address`, and `name` unless it is empty.
[[nodiscard]] std::vector<std::string> names_of(const std::string& address,
                                                const std::string& name);

}  // namespace live
