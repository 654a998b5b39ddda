// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "live/server.h"
#include "live/session.h"
#include "live/subject.h"

namespace live {

/// A session that a server serves on a free port, until its end.
class RunningSession {
 public:
  explicit RunningSession(const Options& options)
      : options_(options),
        subject_(make_subject(options.scene, options.width, options.height)),
        session_(options_, *subject_),
        server_(session_) {}
  ~RunningSession() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

  /// Sampling begins.
  void start() {
    thread_ = std::thread([this] { session_.run([this] { return !stopping_; }); });
  }
  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] const Server& server() const { return server_; }

  /// Options of a small picture on a free port, whose files are in a folder of the test's.
  static Options small(const std::string& name) {
    Options small;
    small.width = 160;
    small.height = 128;
    small.threads = 1;
    small.port = 0;
    const auto folder = std::filesystem::temp_directory_path() / ("freqsynth_live_" + name);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    small.stem = (folder / "picture").string();
    return small;
  }

 private:
  Options options_;
  std::unique_ptr<Subject> subject_;
  Session session_;
  Server server_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace live
