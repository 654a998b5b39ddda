// SPDX-License-Identifier: MIT
/// \file
/// A session in the browser, by HTTP.
///
///     GET  /                             the page
///     GET  /state                        JSON; with ?after=N it waits for a revision above N
///     GET  /picture.jpg, /density.jpg, /error.jpg    of the newest revision
///     POST /attention, /view, /store     JSON; see messages.h and guard.h
#pragma once

#include <memory>

#include "session.h"

namespace live {

/// Serves from its construction to its destruction. What clients do not read takes no memory here:
/// there is one newest revision, so many connections are served at a time, and more wait in the
/// system's queue.
class Server {
 public:
  /// \throws std::runtime_error when it cannot listen on that address and port.
  explicit Server(Session& session);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] unsigned port() const;
  /// What the page sends with what changes something.
  [[nodiscard]] const std::string& token() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace live
