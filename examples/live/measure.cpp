// SPDX-License-Identifier: MIT
#include "measure.h"

#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/cpu_seconds.h"
#include "server.h"
#include "session.h"
#include "shown_light.h"
#include "subject.h"

namespace live {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A browser without a window: it waits for revisions and fetches all pictures of them.
class Client {
 public:
  Client(unsigned port, Clock::time_point begin)
      : begin_(begin), thread_([this, port] { work(port); }) {}
  void stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }
  ~Client() { stop(); }

  /// Of the thread so far; a browser is another process.
  [[nodiscard]] double cpu() const { return cpu_; }
  [[nodiscard]] std::size_t revisions() const { return revisions_; }
  [[nodiscard]] double first() const { return first_; }  ///< seconds after the beginning

 private:
  void work(unsigned port) {
    httplib::Client http("127.0.0.1", static_cast<int>(port));
    http.set_keep_alive(true);
    http.set_tcp_nodelay(true);
    std::uint64_t revision = 0;
    while (!stopping_) {
      const auto state = http.Get("/state?after=" + std::to_string(revision));
      if (!state || state->status != 200) continue;
      const auto newest = nlohmann::json::parse(state->body)["revision"].get<std::uint64_t>();
      if (newest == revision) continue;
      revision = newest;
      for (const char* path : {"/picture.jpg", "/density.jpg", "/error.jpg"}) {
        const auto picture = http.Get(path);
        if (!picture || picture->body.empty()) break;
        if (std::string(path) != "/picture.jpg") continue;
        if (++revisions_ == 1) first_ = seconds_since(begin_);
      }
      cpu_ = cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
    }
  }

  Clock::time_point begin_;
  std::atomic<double> cpu_ = 0, first_ = 0;
  std::atomic<std::size_t> revisions_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// Microseconds of CPU time that a sample takes when nobody looks.
double plain_cost(const Options& options, const Subject& subject, double target) {
  freqsynth::Synthesizer engine(settings_of(options.width, options.height, subject.noisy()));
  const double before = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
  Sampling sampling(engine, subject, HUGE_VAL, options.threads);
  while (static_cast<double>(engine.stats().samples) < target && !sampling.ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const double cpu = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
  const double cost = 1e6 * cpu / static_cast<double>(engine.stats().samples);
  sampling.stop();
  return cost;
}

struct Served {
  double cost = 0;      ///< as above, the client's own aside
  double first = 0;     ///< seconds from the beginning, the scene included
  double made = 0;      ///< of which for the scene and the server
  double rate = 0;      ///< revisions a second
  double cpu_rate = 0;  ///< revisions in a second of CPU time: does not depend on other programs
};

Served served_cost(Options options, double target) {
  Served served;
  options.port = 0;
  options.samples_per_pixel = HUGE_VAL;
  const Clock::time_point begin = Clock::now();
  const auto subject = make_subject(options.scene, options.width, options.height);
  Session session(options, *subject);
  Server server(session);
  served.made = seconds_since(begin);
  Client client(server.port(), begin);
  const double before = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
  session.run([&] {
    const auto samples = static_cast<double>(session.samples());
    if (samples < target) return true;
    const double cpu = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - before - client.cpu();
    served.cost = 1e6 * cpu / samples;
    served.first = client.first();
    const auto later = static_cast<double>(client.revisions()) - 1;
    served.rate = later / (seconds_since(begin) - served.first);
    served.cpu_rate = later / cpu;
    return false;
  });
  client.stop();
  if (client.revisions() == 0) throw std::runtime_error("--measure: --spp is too few to measure");
  return served;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int measure(const Options& options) {
  const auto subject = make_subject(options.scene, options.width, options.height);
  const double target =
      options.samples_per_pixel * static_cast<double>(options.width * options.height);
  std::vector<double> plain, cost, ratio, first, made, rate, cpu_rate;
  for (std::size_t i = 0; i < options.measure; ++i) {
    plain.push_back(plain_cost(options, *subject, target));
    const Served served = served_cost(options, target);
    cost.push_back(served.cost);
    ratio.push_back(served.cost / plain.back());
    first.push_back(served.first);
    made.push_back(served.made);
    rate.push_back(served.rate);
    cpu_rate.push_back(served.cpu_rate);
  }
  std::printf("| %s | %zu x %zu | %.2f s | %.2f s | %.1f | %.1f | %.2f us | %.2f us | %.3f |\n",
              options.scene.c_str(), options.width, options.height, median(made), median(first),
              median(rate), median(cpu_rate), median(plain), median(cost), median(ratio));
  return 0;
}

}  // namespace live
