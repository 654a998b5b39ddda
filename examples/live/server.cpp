// SPDX-License-Identifier: MIT
#include "server.h"

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "crew.h"
#include "guard.h"
#include "messages.h"
#include "page.h"

namespace live {
namespace {

/// Connections that are served at the same time. A browser opens up to six.
constexpr std::size_t connections = 24;
/// Of these so many may wait for a revision.
constexpr int most_waiting = 12;
constexpr std::chrono::seconds longest_wait{5};
/// A client that takes nothing for so long is left.
constexpr std::chrono::seconds patience{3};

Credentials credentials_of(const httplib::Request& request) {
  return {request.get_header_value("Host"), request.get_header_value("Origin"),
          request.get_header_value("X-Freqsynth-Token"), request.get_header_value("Content-Type")};
}

void answer(httplib::Response& response, int status, const std::string& text) {
  response.status = status;
  response.set_content(text, "text/plain; charset=utf-8");
}

std::string page_with(const std::string& token) {
  std::string text(page);
  const std::string place = "TOKEN";
  for (std::size_t at = text.find(place); at != std::string::npos; at = text.find(place, at)) {
    text.replace(at, place.size(), token);
  }
  return text;
}

}  // namespace

struct Server::Implementation {
  explicit Implementation(Session& its_session) : session(its_session) {
    const Options& options = session.options();
    http.new_task_queue = [] { return new Crew(connections); };
    http.set_keep_alive_max_count(1000);
    http.set_keep_alive_timeout(1);
    http.set_read_timeout(patience);
    http.set_write_timeout(patience);
    http.set_payload_max_length(4096);
    http.set_tcp_nodelay(true);
    port = options.port;
    if (port == 0) {
      const int any = http.bind_to_any_port(options.host);
      if (any <= 0) throw std::runtime_error("--host " + options.host + ": cannot listen there");
      port = static_cast<unsigned>(any);
    } else if (!http.bind_to_port(options.host, static_cast<int>(port))) {
      throw std::runtime_error("--host " + options.host + " --port " + std::to_string(port) +
                               ": cannot listen there; another program may do so");
    }
    guard = std::make_unique<Guard>(names_of(options.host, options.name), port);
    add_guard();
    add_reading();
    add_changing();
    thread = std::thread([this] {
      http.listen_after_bind();
      ended = true;
    });
  }
  ~Implementation() {
    session.board().close();
    // It has to listen before it can stop.
    while (!http.is_running() && !ended) std::this_thread::yield();
    http.stop();
    thread.join();
  }

  /// Before a body is read.
  void add_guard() {
    http.set_default_headers(
        {{"Content-Security-Policy",
          "default-src 'none'; img-src 'self' blob:; connect-src 'self'; style-src 'nonce-" +
              guard->token() + "'; script-src 'nonce-" + guard->token() +
              "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
         {"X-Content-Type-Options", "nosniff"},
         {"Cross-Origin-Resource-Policy", "same-origin"},
         {"Referrer-Policy", "no-referrer"},
         {"Cache-Control", "no-store"}});
    http.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& response) {
          const Credentials credentials = credentials_of(request);
          const bool reads = request.method == "GET" || request.method == "HEAD";
          if (reads ? guard->may_read(credentials) : guard->may_change(credentials)) {
            return httplib::Server::HandlerResponse::Unhandled;
          }
          answer(response, 403, "refused: not from this server's page\n");
          response.set_header("Connection", "close");
          return httplib::Server::HandlerResponse::Handled;
        });
  }

  void add_reading() {
    http.Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(page_with(guard->token()), "text/html; charset=utf-8");
    });
    http.Get("/state", [this](const httplib::Request& request, httplib::Response& response) {
      std::uint64_t after = 0;
      const bool waits = read_all(request.get_param_value("after"), after);
      const bool may_wait = ++waiting <= most_waiting;
      const Board::Shared newest = waits && may_wait
                                       ? session.board().newer_than(after, longest_wait)
                                       : session.board().newest();
      --waiting;
      response.set_content(state_message(session, newest.get()), "application/json");
    });
    add_picture("/picture.jpg", &Revision::picture);
    add_picture("/density.jpg", &Revision::density);
    add_picture("/error.jpg", &Revision::error);
  }

  void add_picture(const char* path, std::vector<std::uint8_t> Revision::*bytes) {
    http.Get(path, [this, bytes](const httplib::Request&, httplib::Response& response) {
      const Board::Shared newest = session.board().newest();
      if (!newest || ((*newest).*bytes).empty()) return answer(response, 404, "not yet\n");
      response.set_header("X-Revision", std::to_string(newest->number));
      // The revision itself is sent, not a copy.
      response.set_content_provider(
          ((*newest).*bytes).size(), "image/jpeg",
          [newest, bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
            const auto* const begin = reinterpret_cast<const char*>(((*newest).*bytes).data());
            return sink.write(begin + offset, std::min<std::size_t>(length, 1 << 14));
          });
    });
  }

  /// Calls `change`, and answers with what went wrong.
  template <class Change>
  void add_change(const char* path, Change change) {
    http.Post(path, [change](const httplib::Request& request, httplib::Response& response) {
      try {
        response.set_content(change(request.body), "text/plain; charset=utf-8");
      } catch (const std::invalid_argument& error) {
        answer(response, 400, error.what());
      } catch (const std::exception& error) {
        answer(response, 500, error.what());
      }
    });
  }

  void add_changing() {
    add_change("/attention", [this](const std::string& message) {
      session.attend(read_attention(message));
      return std::string();
    });
    add_change("/view", [this](const std::string& message) {
      session.look(read_view(message));
      return std::string();
    });
    add_change("/store", [this](const std::string&) {
      std::string names;
      for (const std::string& name : session.store()) {
        names += (names.empty() ? "" : ", ") + name;
      }
      return names;
    });
  }

  Session& session;
  httplib::Server http;
  unsigned port = 0;
  std::unique_ptr<Guard> guard;
  std::atomic<int> waiting = 0;
  std::atomic<bool> ended = false;
  std::thread thread;
};

Server::Server(Session& session) : implementation_(std::make_unique<Implementation>(session)) {}

Server::~Server() = default;

unsigned Server::port() const { return implementation_->port; }

const std::string& Server::token() const { return implementation_->guard->token(); }

}  // namespace live
