// SPDX-License-Identifier: MIT
#include "session.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/checkpoint.h"
#include "common/picture.h"
#include "shown_light.h"

namespace live {
namespace {

using std::chrono::milliseconds;

/// Of the CPU time of sampling, for pictures and their density, and for expected errors. What it
/// takes to serve them comes on top.
constexpr double picture_share = 0.035, error_share = 0.01;
/// Between two revisions.
constexpr milliseconds picture_interval{400};
/// Between two looks whether one is due; before the first, and after it.
constexpr milliseconds first_watch{10}, watch{50};
/// The first one waits so long for a sample in each block.
constexpr milliseconds first_patience{80};

}  // namespace

Session::Session(const Options& options, const Subject& subject)
    : options_(options),
      subject_(subject),
      engine_(
          make_engine(options.resume, settings_of(options.width, options.height, subject.noisy()))),
      picture_pace_(picture_share),
      error_pace_(error_share) {}

void Session::run(const std::function<bool()>& going_on) {
  Sampling sampling(engine_, subject_, options_.samples_per_pixel, options_.threads);
  picture_pace_ = Pace(picture_share);
  error_pace_ = Pace(error_share);
  while (going_on()) {
    if (sampling.ended()) sampling.stop();  // says what went wrong
    update(sampling);
    std::unique_lock lock(mutex_);
    asked_.wait_for(lock, waves_ == 0 ? first_watch : watch, [&] { return view_asked_; });
  }
  sampling.stop();
  if (engine_.stats().waves > 0 && !last_.finished) publish(sampling, true);
}

void Session::attend(const Attention& attention) {
  const std::lock_guard lock(mutex_);
  live::attend(engine_, attention);
  attention_ = attention;
}

Attention Session::attention() const {
  const std::lock_guard lock(mutex_);
  return attention_;
}

void Session::look(const View& view) {
  const std::lock_guard lock(mutex_);
  view_ = view;
  view_asked_ = true;
  asked_.notify_one();
}

View Session::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::vector<std::string> Session::store() {
  const std::lock_guard lock(storing_);
  if (engine_.stats().waves == 0) throw std::runtime_error("there is no picture yet");
  const freqsynth::FrequencyImage image = engine_.finished_image();
  const std::vector<std::uint8_t> jpeg = picture_jpeg(image, view());
  write_text(options_.jpeg_file(), {jpeg.begin(), jpeg.end()});
  write_picture(options_.exr_file(),
                {options_.width, options_.height, 3, freqsynth::reconstruct(linear_light(image))});
  freqsynth::save_file(options_.state_file(), engine_);
  return {options_.jpeg_file(), options_.exr_file(), options_.state_file()};
}

bool Session::picture_due(const Sampling& sampling) {
  if (waves_ > 0 &&
      (Clock::now() - picture_time_ < picture_interval || !picture_pace_.affords(picture_cost_))) {
    return false;
  }
  const freqsynth::SynthesisStats stats = engine_.stats();
  if (stats.waves == waves_) return false;
  if (waves_ == 0) {
    return stats.samples >= stats.blocks ||
           sampling.seconds() >= std::chrono::duration<double>(first_patience).count();
  }
  return true;
}

void Session::update(const Sampling& sampling) {
  const bool ended = sampling.ended();
  if (ended && !last_.finished && engine_.stats().waves > 0) return publish(sampling, true);
  bool asked = false;
  {
    const std::lock_guard lock(mutex_);
    asked = view_asked_;
  }
  if (picture_due(sampling) || (asked && waves_ > 0)) publish(sampling, ended);
}

void Session::publish(const Sampling& sampling, bool ended) {
  // What the first errors take is not known: it is about four pictures' time.
  const double expected = error_cost_ > 0 ? error_cost_ : 4 * picture_cost_;
  const bool ends = ended && !last_.finished;
  if (ends || (!ended && waves_ > 0 && error_pace_.affords(expected))) {
    error_cost_ = error_pace_.spend([&] {
      predicted_error_ = engine_.predicted_rmse();
      errors_ = errors_of(engine_);
    });
  }
  picture_cost_ = picture_pace_.spend([&] { make_picture(sampling, ended); });
  picture_time_ = Clock::now();
  board_.publish(last_);
}

void Session::make_picture(const Sampling& sampling, bool ended) {
  {
    const std::lock_guard lock(mutex_);
    last_.view = view_;
    view_asked_ = false;
  }
  const freqsynth::SynthesisStats stats = engine_.stats();
  if (stats.waves != waves_ || ended != last_.finished) {
    image_ = ended ? engine_.finished_image() : engine_.image();
    waves_ = stats.waves;
    last_.samples = stats.samples;
    last_.samples_per_pixel =
        static_cast<double>(stats.samples) / static_cast<double>(options_.width * options_.height);
    const BlockMap samples = samples_of(image_);
    const float most = *std::max_element(samples.values.begin(), samples.values.end());
    last_.most_samples = static_cast<std::uint32_t>(most);
    last_.density = map_jpeg(samples, std::max(double{most}, 1.0));
  }
  last_.seconds = sampling.seconds();
  last_.picture = picture_jpeg(image_, last_.view);
  last_.finished = ended;
  if (errors_.values.empty()) return;
  const double factor = exposure_factor(last_.view.stops);
  last_.predicted_error = predicted_error_ * factor;
  last_.error = map_jpeg(errors_, white_error / factor);
}

}  // namespace live
