// SPDX-License-Identifier: MIT
// A client that is no browser looks at a session, and does what it may not.
#include "live/server.h"

#include <gtest/gtest.h>
#include <httplib.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "freqsynth/jpeg/jpeg.h"
#include "freqsynth/synthesizer_file.h"
#include "live/shown_light.h"
#include "running_session.h"

namespace live {
namespace {

using nlohmann::json;

class ServedSession : public testing::Test {
 protected:
  static Options options() {
    return RunningSession::small(testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void begin(const Options& options) {
    running = std::make_unique<RunningSession>(options);
    http =
        std::make_unique<httplib::Client>("127.0.0.1", static_cast<int>(running->server().port()));
    http->set_read_timeout(60);
  }
  /// Begins, and samples.
  void run(const Options& options) {
    begin(options);
    running->start();
  }

  /// The state of a revision after that one.
  json state_after(std::uint64_t revision) {
    for (;;) {
      const auto answer = http->Get("/state?after=" + std::to_string(revision));
      if (!answer || answer->status != 200) throw std::runtime_error("no state");
      json state = json::parse(answer->body);
      if (state["revision"].get<std::uint64_t>() > revision) return state;
    }
  }
  json finished_state() {
    json state = state_after(0);
    while (!state["finished"].get<bool>()) state = state_after(state["revision"]);
    return state;
  }
  freqsynth::QuantizedImage picture(const std::string& path) {
    const auto answer = http->Get(path);
    if (!answer || answer->status != 200) throw std::runtime_error("no " + path);
    return freqsynth::decode_jpeg(
        {reinterpret_cast<const std::uint8_t*>(answer->body.data()), answer->body.size()});
  }
  int post(const std::string& path, const std::string& body, httplib::Headers headers) {
    const auto answer = http->Post(path, headers, body, "application/json");
    return answer ? answer->status : 0;
  }
  httplib::Headers token() { return {{"X-Freqsynth-Token", running->server().token()}}; }

  std::unique_ptr<RunningSession> running;
  std::unique_ptr<httplib::Client> http;
};

TEST_F(ServedSession, ShowsAPictureThatGrowsUntilItIsFinished) {
  Options wanted = options();
  wanted.samples_per_pixel = 8;
  run(wanted);
  json before = state_after(0);
  const double first = before["samples_per_pixel"];
  EXPECT_EQ(picture("/picture.jpg").width, 160u);
  const json last = finished_state();
  EXPECT_GT(last["samples_per_pixel"].get<double>(), first);
  EXPECT_NEAR(last["samples_per_pixel"].get<double>(), 8, 0.01);
  EXPECT_GT(last["error"].get<double>(), 0);

  // The picture is that of an engine that is not looked at.
  const auto subject = make_subject(wanted.scene, wanted.width, wanted.height);
  freqsynth::Synthesizer engine(settings_of(wanted.width, wanted.height, false));
  Sampling sampling(engine, *subject, 8, 2);
  while (!sampling.ended()) std::this_thread::yield();
  sampling.stop();
  const std::vector<std::uint8_t> file = picture_jpeg(engine.finished_image(), {});
  EXPECT_EQ(http->Get("/picture.jpg")->body, std::string(file.begin(), file.end()));
  EXPECT_EQ(picture("/density.jpg").width, 20u);
  EXPECT_EQ(picture("/error.jpg").height, 16u);
}

TEST_F(ServedSession, FrameRaisesTheDensityInside) {
  Options wanted = options();
  wanted.scene = "softshadow";
  wanted.samples_per_pixel = 4;
  double share[2];
  for (const bool framed : {false, true}) {
    begin(wanted);
    if (framed) {
      ASSERT_EQ(post("/attention", R"({"frame": [40, 32, 80, 64]})", token()), 200);
    }
    running->start();
    finished_state();
    const freqsynth::QuantizedImage density = picture("/density.jpg");
    // Both in units of the block with most samples: what counts is inside against outside.
    std::vector<float> levels(20 * 16);
    const freqsynth::QuantizedComponent& gray = density.components[0];
    for (std::size_t block = 0; block < gray.blocks_x * gray.blocks_y; ++block) {
      std::array<float, 64> coefficients{}, pixels{};
      for (std::size_t i = 0; i < 64; ++i) {
        coefficients[i] =
            static_cast<float>(gray.values[64 * block + i] * density.tables[gray.table][i]);
      }
      freqsynth::inverse_dct(coefficients, pixels);
      for (std::size_t p = 0; p < 64; ++p) {
        const std::size_t x = block % gray.blocks_x * 8 + p % 8,
                          y = block / gray.blocks_x * 8 + p / 8;
        if (x < 20 && y < 16) levels[y * 20 + x] = (pixels[p] + 128) / 255;
      }
    }
    double inside = 0, all = 0;
    for (std::size_t block = 0; block < levels.size(); ++block) {
      const double samples = double{levels[block]} * double{levels[block]};
      const std::size_t x = block % 20, y = block / 20;
      all += samples;
      if (x >= 5 && x < 10 && y >= 4 && y < 8) inside += samples;
    }
    share[framed] = inside / all;
    running.reset();
  }
  EXPECT_GT(share[1], 1.5 * share[0]);
}

TEST_F(ServedSession, SlidersChangeTheNextRevision) {
  Options wanted = options();
  wanted.samples_per_pixel = 1;
  run(wanted);
  json state = finished_state();
  const freqsynth::QuantizedImage before = picture("/picture.jpg");
  ASSERT_EQ(post("/view", R"({"stops": 2, "quality": 20})", token()), 200);
  state = state_after(state["revision"]);
  EXPECT_EQ(state["quality"], 20);
  const freqsynth::QuantizedImage after = picture("/picture.jpg");
  EXPECT_GT(after.tables[0][0], before.tables[0][0]);
  EXPECT_GT(after.components[0].values[0] * after.tables[0][0],
            before.components[0].values[0] * before.tables[0][0]);
}

TEST_F(ServedSession, StoresFilesThatGoOn) {
  Options wanted = options();
  wanted.samples_per_pixel = 1;
  run(wanted);
  finished_state();
  const auto answer = http->Post("/store", token(), "{}", "application/json");
  ASSERT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body,
            wanted.jpeg_file() + ", " + wanted.exr_file() + ", " + wanted.state_file());
  std::stringstream stored;
  stored << std::ifstream(wanted.jpeg_file(), std::ios::binary).rdbuf();
  EXPECT_EQ(stored.str(), http->Get("/picture.jpg")->body);
  EXPECT_GT(std::filesystem::file_size(wanted.exr_file()), 1000u);
  const freqsynth::Synthesizer engine = freqsynth::load_synthesizer(
      wanted.state_file(), settings_of(wanted.width, wanted.height, false));
  EXPECT_EQ(engine.stats().samples, 160u * 128u);
}

TEST_F(ServedSession, RefusesWhatDoesNotComeFromItsPage) {
  run(options());
  state_after(0);
  const std::string host = "127.0.0.1:" + std::to_string(running->server().port());
  for (const char* path : {"/attention", "/view", "/store"}) {
    EXPECT_EQ(post(path, "{}", {}), 403) << path;
    httplib::Headers headers = token();
    headers.emplace("Origin", "http://evil.example");
    EXPECT_EQ(post(path, "{}", headers), 403) << path;
    headers = token();
    headers.emplace("Host", "evil.example");
    EXPECT_EQ(post(path, "{}", headers), 403) << path;
    const auto plain = http->Post(path, token(), "{}", "text/plain");
    EXPECT_EQ(plain->status, 403) << path;
  }
  EXPECT_FALSE(std::filesystem::exists(running->options().jpeg_file()));
  for (const char* path : {"/", "/state", "/picture.jpg"}) {
    EXPECT_EQ(http->Get(path, {{"Host", "evil.example"}})->status, 403) << path;
    EXPECT_EQ(http->Get(path, {{"Host", host}})->status, 200) << path;
  }
  EXPECT_EQ(post("/attention", "nonsense", token()), 400);
  EXPECT_EQ(post("/view", R"({"stops": 100, "quality": 1})", token()), 400);
  EXPECT_EQ(http->Get("/other")->status, 404);
  EXPECT_NE(post("/attention", std::string(100'000, ' '), token()), 200);
}

TEST_F(ServedSession, PageIsWhole) {
  run(options());
  const auto page = http->Get("/");
  EXPECT_EQ(page->status, 200);
  EXPECT_NE(page->body.find("content=\"" + running->server().token() + "\""), std::string::npos);
  EXPECT_EQ(page->body.find("TOKEN"), std::string::npos);
  EXPECT_NE(page->body.find("</html>"), std::string::npos);
  // Nothing comes from elsewhere.
  EXPECT_EQ(page->body.find("http"), std::string::npos);
  EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"),
            std::string::npos);
}

}  // namespace
}  // namespace live
