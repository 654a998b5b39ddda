// SPDX-License-Identifier: MIT
// The page in Chromium, where there is one: mouse, keyboard, and what a screen reader is told.
#include "browser.h"

#include <gtest/gtest.h>

#include "running_session.h"

namespace live {
namespace {

using nlohmann::json;

class PageInChromium : public testing::Test {
 protected:
  void SetUp() override {
    if (Browser::program().empty()) GTEST_SKIP() << "there is no Chromium here";
    Options options =
        RunningSession::small(testing::UnitTest::GetInstance()->current_test_info()->name());
    options.width = 256;
    options.height = 192;
    options.scene = "softshadow";
    running = std::make_unique<RunningSession>(options);
    running->start();
    browser = std::make_unique<Browser>(
        "http://127.0.0.1:" + std::to_string(running->server().port()) + "/", 1280, 1000);
    ASSERT_TRUE(browser->wait_for("document.getElementById('revision').textContent > 0"));
  }
  void TearDown() override {
    browser.reset();
    running.reset();
  }

  /// Where a pixel of the picture is on the page.
  std::array<double, 2> place(double x, double y) {
    const json box = browser->evaluate(
        "(box => [box.left, box.top, box.width, box.height])"
        "(document.getElementById('region').getBoundingClientRect())");
    return {box[0].get<double>() + x / 256 * box[2].get<double>(),
            box[1].get<double>() + y / 192 * box[3].get<double>()};
  }
  std::string text(const std::string& id) {
    return browser->evaluate("document.getElementById('" + id + "').textContent");
  }
  /// Waits for what the session knows of the page.
  template <class Condition>
  bool eventually(Condition condition) {
    for (int i = 0; i < 600; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  /// Mean levels of the picture of density: within a part of it, and of all.
  std::array<double, 2> density(int left, int top, int right, int bottom) {
    const json means = browser->evaluate(
        "(() => {"
        "const image = document.getElementById('density'), canvas = "
        "document.createElement('canvas');"
        "canvas.width = 32; canvas.height = 24;"
        "const context = canvas.getContext('2d'); context.drawImage(image, 0, 0);"
        "const data = context.getImageData(0, 0, 32, 24).data;"
        "let inside = 0, count = 0, all = 0;"
        "for (let y = 0; y < 24; ++y) for (let x = 0; x < 32; ++x) {"
        "  const level = data[4 * (32 * y + x)]; all += level / 768;"
        "  if (x >= " +
        std::to_string(left) + " && x < " + std::to_string(right) +
        " && y >= " + std::to_string(top) + " && y < " + std::to_string(bottom) +
        ") { inside += level; ++count; }"
        "} return [inside / count, all]; })()");
    return {means[0].get<double>(), means[1].get<double>()};
  }

  std::unique_ptr<RunningSession> running;
  std::unique_ptr<Browser> browser;
};

TEST_F(PageInChromium, PictureArrivesChangesAndGetsBetter) {
  ASSERT_TRUE(browser->wait_for("document.getElementById('picture').naturalWidth === 256"));
  ASSERT_TRUE(browser->wait_for("document.getElementById('density').naturalWidth === 32"));
  const std::string first = browser->evaluate("document.getElementById('picture').src");
  EXPECT_TRUE(
      browser->wait_for("document.getElementById('picture').src !== " + json(first).dump()));
  ASSERT_TRUE(browser->wait_for("document.getElementById('error').naturalWidth === 32"));
  const double early = std::stod(text("rmse"));
  EXPECT_TRUE(browser->wait_for("parseFloat(document.getElementById('rmse').textContent) < " +
                                std::to_string(0.9 * early)));
  EXPECT_NE(text("scene").find("softshadow, 256"), std::string::npos);
  EXPECT_EQ(text("state"), "sampling");
}

TEST_F(PageInChromium, FrameDrawnByTheMouseRaisesTheDensityInside) {
  // A part with nothing in it: two thirds of the way down, at the left.
  ASSERT_TRUE(browser->wait_for("document.getElementById('rate').textContent > 0.5"));
  const auto before = density(1, 2, 7, 6);
  const auto from = place(4, 12), to = place(60, 52);
  browser->drag_mouse(from[0], from[1], to[0], to[1]);
  ASSERT_TRUE(eventually([&] { return running->session().attention().frame.has_value(); }));
  const Frame frame = *running->session().attention().frame;
  EXPECT_NEAR(frame.left, 4, 1);
  EXPECT_NEAR(frame.top, 12, 1);
  EXPECT_NEAR(frame.right, 60, 1);
  EXPECT_NEAR(frame.bottom, 52, 1);
  EXPECT_EQ(browser->evaluate("document.getElementById('frame').hidden"), false);
  EXPECT_TRUE(eventually([&] {
    const auto after = density(1, 2, 7, 6);
    return after[0] / after[1] > 1.3 * before[0] / before[1];
  }));
}

TEST_F(PageInChromium, PointerIsFollowedAndForgotten) {
  const auto middle = place(128, 96);
  browser->move_mouse(middle[0], middle[1]);
  ASSERT_TRUE(eventually([&] { return running->session().attention().pointer.has_value(); }));
  EXPECT_NEAR(running->session().attention().pointer->x, 128, 1);
  browser->move_mouse(1270, 990);
  EXPECT_TRUE(eventually([&] { return !running->session().attention().pointer; }));
}

TEST_F(PageInChromium, KeyboardDoesAllThatTheMouseDoes) {
  // The first stop of the tabulator is the picture.
  browser->press("Tab");
  EXPECT_EQ(browser->evaluate("document.activeElement.id"), "region");
  EXPECT_NE(browser->evaluate("getComputedStyle(document.activeElement).outlineStyle"), "none");
  const auto frame_is = [&](double left, double top, double right, double bottom) {
    return eventually([&] {
      const auto frame = running->session().attention().frame;
      return frame && frame->left == left && frame->top == top && frame->right == right &&
             frame->bottom == bottom;
    });
  };
  browser->press("Enter");
  EXPECT_TRUE(frame_is(64, 48, 192, 144));
  browser->press("ArrowRight");
  browser->press("ArrowUp");
  EXPECT_TRUE(frame_is(72, 40, 200, 136));
  browser->press("ArrowLeft", true);
  browser->press("ArrowDown", true);
  EXPECT_TRUE(frame_is(72, 40, 192, 144));
  EXPECT_NE(text("said").find("Frame of 120 by 104 pixels, 72 from the left"), std::string::npos);
  for (int i = 0; i < 40; ++i) browser->press("ArrowLeft");
  EXPECT_TRUE(frame_is(0, 40, 120, 144));  // it stays whole at the border
  browser->press("Escape");
  EXPECT_TRUE(eventually([&] { return !running->session().attention().frame; }));

  // On to the slider for the exposure, and one step up.
  browser->press("Tab");
  EXPECT_EQ(browser->evaluate("document.activeElement.id"), "stops");
}

TEST_F(PageInChromium, SlidersAndTheButtonWork) {
  browser->evaluate(
      "(() => { const stops = document.getElementById('stops'); stops.value = 1.5;"
      "stops.dispatchEvent(new Event('input')); })()");
  EXPECT_TRUE(eventually([&] { return running->session().view().stops == 1.5; }));
  EXPECT_EQ(text("stops-text"), "+1.5 stops");
  browser->evaluate("document.getElementById('store').click()");
  EXPECT_TRUE(
      browser->wait_for("document.getElementById('said').textContent.startsWith('Stored')"));
  EXPECT_NE(text("said").find("picture.exr"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(running->options().state_file()));
}

TEST_F(PageInChromium, TellsAScreenReaderWhatItShows) {
  ASSERT_TRUE(browser->wait_for("document.getElementById('error').naturalWidth === 32"));
  std::string all;
  for (const json& node : browser->accessibility()) {
    if (node.value("ignored", false)) continue;
    const std::string role = node["role"].value("value", std::string());
    const std::string name =
        node.contains("name") ? node["name"].value("value", std::string()) : std::string();
    all += role + ": " + name + "\n";
    if (role == "image" || role == "slider" || role == "button") {
      EXPECT_FALSE(name.empty()) << role;
    }
  }
  for (const char* told :
       {"application: Picture with a frame to draw", "image: Where samples were taken",
        "image: Where errors are expected", "slider: Exposure", "slider: Quality of JPEG",
        "button: Store JPEG, EXR and checkpoint", "status: "}) {
    EXPECT_NE(all.find(told), std::string::npos) << told << " not in\n" << all;
  }
  const std::string alt = browser->evaluate("document.getElementById('picture').alt");
  EXPECT_EQ(alt.find("Picture of the scene softshadow after "), 0u) << alt;
  // Seldom, but not never.
  EXPECT_TRUE(browser->wait_for("document.getElementById('said').textContent !== ''"));
}

}  // namespace
}  // namespace live
