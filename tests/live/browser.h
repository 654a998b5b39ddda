// SPDX-License-Identifier: MIT
/// \file
/// A browser without a window, to be driven by a test: Chromium, by the DevTools protocol on two
/// pipes.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace live {

/// One page of a Chromium that this starts, and ends. Members throw std::runtime_error when it does
/// not answer within a minute.
class Browser {
 public:
  /// The program's file; empty: there is none.
  [[nodiscard]] static std::string program();

  /// Opens a page, and waits until it is loaded.
  Browser(const std::string& url, int width, int height);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// The value of an expression in the page; of a promise, what it promises.
  nlohmann::json evaluate(const std::string& expression);
  /// Waits until an expression is true, for at most a minute. \return whether it came true
  bool wait_for(const std::string& expression);

  void move_mouse(double x, double y);
  /// Draws with the button down.
  void drag_mouse(double from_x, double from_y, double to_x, double to_y);
  /// Presses a key, such as "Enter" or "ArrowLeft".
  void press(const std::string& key, bool shift = false);

  /// All that the page tells a screen reader: the nodes of its accessibility tree.
  nlohmann::json accessibility();
  /// The bytes of a PNG file.
  std::string screenshot();

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  void mouse(const char* type, double x, double y, int buttons);
  nlohmann::json receive();
  void close();

  std::filesystem::path folder_;
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  int last_id_ = 0;
  std::string session_;
  std::string received_;
};

}  // namespace live
