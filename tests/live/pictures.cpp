// SPDX-License-Identifier: MIT
// Looks at a session as a user does, and keeps what is seen: the pictures of docs/live.md.
//   freqsynth_live_pictures FOLDER

#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>

#include "browser.h"
#include "common/picture.h"
#include "running_session.h"

namespace {

using namespace live;

/// The page at the end of so many samples per pixel.
/// \param frame  left, top, right, bottom: is drawn by the mouse before the first sample; or none
std::string page_after(double samples_per_pixel, std::optional<Frame> frame) {
  Options options;
  options.port = 0;
  options.samples_per_pixel = samples_per_pixel;
  RunningSession running(options);
  Browser browser("http://127.0.0.1:" + std::to_string(running.server().port()) + "/", 1180, 1400);
  const auto expect = [&](const std::string& condition) {
    if (!browser.wait_for(condition)) throw std::runtime_error("not so: " + condition);
  };
  expect("document.getElementById('scene').textContent");
  if (frame) {
    const auto box = browser.evaluate(
        "(box => [box.left, box.top, box.width / 512])"
        "(document.getElementById('region').getBoundingClientRect())");
    const double left = box[0], top = box[1], scale = box[2];
    browser.drag_mouse(left + frame->left * scale, top + frame->top * scale,
                       left + frame->right * scale, top + frame->bottom * scale);
    browser.move_mouse(1170, 1390);
    while (!running.session().attention().frame || running.session().attention().pointer) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  running.start();
  expect("document.getElementById('state').textContent === 'finished'");
  expect("document.getElementById('error').naturalWidth > 0");
  return browser.screenshot();
}

void make_pictures(const std::string& folder) {
  write_text(folder + "/early.png", page_after(1.0 / 16, {}));
  // The knight in front.
  write_text(folder + "/framed.png", page_after(1, Frame{120, 320, 190, 420}));
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: freqsynth_live_pictures FOLDER");
    if (Browser::program().empty()) throw std::runtime_error("there is no Chromium here");
    make_pictures(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_live_pictures: %s\n", error.what());
    return 1;
  }
}
