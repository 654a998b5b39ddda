// SPDX-License-Identifier: MIT
#include "browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

namespace live {
namespace {

using nlohmann::json;

std::string decode_base64(const std::string& text) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char character : text) {
    const std::size_t digit = digits.find(character);
    if (digit == std::string::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

/// Runs Chromium with its ends of the pipes where it looks for them: 3 and 4.
[[noreturn]] void become(const std::string& program, const std::string& folder, int reads,
                         int writes) {
  // Out of the way first: either may be 3 or 4.
  const int high_reads = fcntl(reads, F_DUPFD, 10), high_writes = fcntl(writes, F_DUPFD, 10);
  dup2(high_reads, 3);
  dup2(high_writes, 4);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, 1);
  dup2(nowhere, 2);
  const std::string profile = "--user-data-dir=" + folder;
  const std::vector<const char*> arguments{program.c_str(),
                                           "--headless",
                                           "--no-sandbox",
                                           "--disable-gpu",
                                           "--disable-dev-shm-usage",
                                           "--no-first-run",
                                           "--disable-background-networking",
                                           "--disable-component-update",
                                           "--disable-sync",
                                           "--hide-scrollbars",
                                           "--remote-debugging-pipe",
                                           profile.c_str(),
                                           nullptr};
  execv(program.c_str(), const_cast<char* const*>(arguments.data()));
  _exit(127);
}

}  // namespace

std::string Browser::program() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::string file = folder + "/" + name;
      if (access(file.c_str(), X_OK) == 0) return file;
    }
  }
  return {};
}

Browser::Browser(const std::string& url, int width, int height) {
  std::string name = (std::filesystem::temp_directory_path() / "freqsynth_browser_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for the browser");
  folder_ = name;
  std::array<int, 2> commands{}, answers{};
  if (pipe2(commands.data(), O_CLOEXEC) != 0 || pipe2(answers.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe to the browser");
  }
  const std::string file = program();
  process_ = fork();
  if (process_ == 0) become(file, name, commands[0], answers[1]);
  ::close(commands[0]);
  ::close(answers[1]);
  to_ = commands[1];
  from_ = answers[0];
  try {
    const json target = call("Target.createTarget", {{"url", "about:blank"}});
    session_ = call("Target.attachToTarget",
                    {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    call("Page.navigate", {{"url", url}});
    if (!wait_for("location.href !== 'about:blank' && document.readyState === 'complete'")) {
      throw std::runtime_error("the page is not loaded");
    }
  } catch (...) {
    close();
    throw;
  }
}

Browser::~Browser() { close(); }

void Browser::close() {
  // Its processes end with the pipes; but for one that hangs.
  ::close(to_);
  ::close(from_);
  for (int i = 0; i < 100 && waitpid(process_, nullptr, WNOHANG) == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (i != 98) continue;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    break;
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

json Browser::receive() {
  for (;;) {
    const std::size_t end = received_.find('\0');
    if (end != std::string::npos) {
      json message = json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    pollfd waiting{from_, POLLIN, 0};
    std::array<char, 65536> bytes{};
    const ssize_t count =
        poll(&waiting, 1, 60000) == 1 ? read(from_, bytes.data(), bytes.size()) : 0;
    if (count <= 0) throw std::runtime_error("the browser does not answer");
    received_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

json Browser::call(const std::string& method, const json& parameters) {
  json message{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  // With the zero at its end.
  for (std::size_t sent = 0; sent <= text.size();) {
    const ssize_t count = write(to_, text.c_str() + sent, text.size() + 1 - sent);
    if (count <= 0) throw std::runtime_error("the browser does not listen");
    sent += static_cast<std::size_t>(count);
  }
  for (;;) {
    json answer = receive();
    if (answer.value("id", 0) != last_id_) continue;  // an event
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

json Browser::evaluate(const std::string& expression) {
  const json result =
      call("Runtime.evaluate",
           {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (result.contains("exceptionDetails")) throw std::runtime_error(result.dump());
  return result["result"].value("value", json());
}

bool Browser::wait_for(const std::string& expression) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    if (evaluate("!!(" + expression + ")") == true) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

void Browser::mouse(const char* type, double x, double y, int buttons) {
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", x},
                                    {"y", y},
                                    {"button", buttons == 0 ? "none" : "left"},
                                    {"buttons", buttons},
                                    {"clickCount", buttons}});
}

void Browser::move_mouse(double x, double y) { mouse("mouseMoved", x, y, 0); }

void Browser::drag_mouse(double from_x, double from_y, double to_x, double to_y) {
  mouse("mouseMoved", from_x, from_y, 0);
  mouse("mousePressed", from_x, from_y, 1);
  mouse("mouseMoved", (from_x + to_x) / 2, (from_y + to_y) / 2, 1);
  mouse("mouseMoved", to_x, to_y, 1);
  mouse("mouseReleased", to_x, to_y, 1);
}

void Browser::press(const std::string& key, bool shift) {
  for (const char* type : {"rawKeyDown", "keyUp"}) {
    json event{{"type", type}, {"key", key}, {"code", key}, {"modifiers", shift ? 8 : 0}};
    if (key == "Tab") event["windowsVirtualKeyCode"] = 9;
    call("Input.dispatchKeyEvent", event);
  }
}

json Browser::accessibility() {
  return call("Accessibility.getFullAXTree", json::object())["nodes"];
}

std::string Browser::screenshot() {
  return decode_base64(call("Page.captureScreenshot", {{"format", "png"}})["data"]);
}

}  // namespace live
