// SPDX-License-Identifier: MIT
#include "synthesis.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/checkpoint.h"
#include "common/interrupt.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "common/sampling.h"
#include "direct.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "run_stats.h"

namespace {

/// Samples per pixel of the pictures of figures 12 and 14.
constexpr std::array frame_rates{1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0, 2.0};

/// Finished pixels, or the paper's function where the user asks for it.
freqsynth::FrequencyImage image_of(const freqsynth::Synthesizer& engine, const Options& options) {
  if (options.pixel_filter == freqsynth::PixelFilter::none) return engine.image();
  freqsynth::FinishSettings settings;
  settings.butterworth = options.butterworth;
  settings.residuals = !options.no_residuals;
  return engine.finished_image(settings);
}

Picture picture_of(const freqsynth::FrequencyImage& image, const Options& options, double scale) {
  const freqsynth::ReconstructionSettings settings{options.butterworth, options.pixel_filter, true};
  Picture picture{freqsynth::scaled_size(image.width(), scale),
                  freqsynth::scaled_size(image.height(), scale), image.channels(),
                  freqsynth::reconstruct(image, settings, scale)};
  if (options.averaging == Averaging::display) {
    picture.encoded = true;
    std::vector<float>& pixels = picture.pixels;
    for (std::size_t i = 0; picture.channels == 3 && i < pixels.size(); i += 3) {
      const auto rgb = freqsynth::display_rgb({pixels[i], pixels[i + 1], pixels[i + 2]});
      std::copy(rgb.begin(), rgb.end(), pixels.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (float& value : pixels) value /= 255;
  }
  return picture;
}

/// The sampling density of figures 11 and 13.
Picture density_of(const freqsynth::FrequencyImage& image) {
  std::uint32_t most = 1;
  for (std::size_t by = 0; by < image.blocks_y(); ++by) {
    for (std::size_t bx = 0; bx < image.blocks_x(); ++bx) {
      most = std::max(most, image.samples(bx, by));
    }
  }
  Picture picture{image.width(), image.height(), 1, {}};
  for (std::size_t y = 0; y < image.height(); ++y) {
    for (std::size_t x = 0; x < image.width(); ++x) {
      picture.pixels.push_back(static_cast<float>(image.samples(x / 8, y / 8)) /
                               static_cast<float>(most));
    }
  }
  return picture;
}

std::string frame_name(const Options& options, std::size_t frame) {
  const double rate = frame_rates[frame];
  const std::string share =
      rate < 1 ? "1_" + std::to_string(std::lround(1 / rate)) : std::to_string(std::lround(rate));
  return options.frames + "/" + std::to_string(frame + 1) + "_spp_" + share + ".png";
}

std::string contact_sheet_name(const Options& options) {
  return options.frames + "/contact_sheet.png";
}

freqsynth::SynthesisSettings settings_of(const Options& options) {
  freqsynth::SynthesisSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.channels = options.gray ? 1 : 3;
  settings.wave = options.wave;
  settings.priority.steer = options.steer;
  settings.list.seed = options.seed;
  settings.refiner = options.refiner;
  if (options.refiner == freqsynth::RefinerKind::kriging) return settings;
  settings.list.samples_per_term = options.terms_every;
  if (options.until_quality) {
    settings.quantization = freqsynth::quantization_target(quantization_of(options),
                                                           settings.channels, options.tolerance);
  }
  settings.max_samples_per_block =
      block_limit(options.samples_per_pixel, settings.max_samples_per_block);
  return settings;
}

/// The samples per pixel at which something is to be written, rising.
std::vector<double> stops_of(const Options& options) {
  std::vector<double> stops;
  if (!options.output.empty()) stops.push_back(options.samples_per_pixel);
  if (!options.frames.empty()) stops.insert(stops.end(), frame_rates.begin(), frame_rates.end());
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
  return stops;
}

/// One synthesis, and all that is written of it on the way.
class Synthesis {
 public:
  Synthesis(const Options& options, const scenes::Scene& scene)
      : options_(options),
        scene_(scene),
        stops_(stops_of(options)),
        engine_(make_engine(options.resume, settings_of(options))),
        pool_(options.threads),
        checkpoint_("freqsynth_render", options.checkpoint, options.checkpoint_every) {}

  /// \return whether it came to its end, and was not interrupted
  bool run() {
    bool interrupted = false;
    for (std::size_t i = 0; i < stops_.size() && !interrupted; ++i) {
      reason_ = run_to(stops_[i]);
      interrupted = reason_ == freqsynth::StopReason::cancelled;
      checkpoint_.keep(engine_);
      write_at(stops_[i], interrupted);
    }
    if (!frames_.empty()) write_picture(contact_sheet_name(options_), contact_sheet(frames_, 4));
    tell_bad_samples();
    return !interrupted;
  }

 private:
  /// Goes on to `stop` samples per pixel.
  freqsynth::StopReason run_to(double stop) {
    const std::size_t channels = engine_.settings().channels;
    const SceneSampler sampler(scene_, channels);
    const auto progress = [&](const freqsynth::Progress& now) {
      if (std::isfinite(stop)) {
        // What comes after this stop goes at the same pace.
        const double end = stop / stops_.back(), share = now.fraction * end;
        const double left = share < end ? now.seconds_left * (1 - share) / (end - share) : 0;
        bar_.show(share, left);
      } else {
        bar_.count(samples_per_pixel(options_, engine_.stats()));
      }
      checkpoint_.keep_when_due(engine_);
      return noted_interrupt() == 0;
    };
    const auto run = [&](auto&& values) {
      return engine_.run(values, {.samples_per_pixel = stop}, pool_, progress);
    };
    const freqsynth::RunReport report = options_.averaging == Averaging::display
                                            ? run(freqsynth::DisplaySampler(sampler, channels))
                                            : run(sampler);
    seconds_.sampler += report.sampler_seconds;
    seconds_.core += report.core_seconds;
    if (report.reason == freqsynth::StopReason::unusable) {
      throw std::runtime_error("not one sample of the scene is a finite number");
    }
    if (report.reason == freqsynth::StopReason::exhausted) {
      std::fprintf(stderr, "freqsynth_render: every block has its %zu samples\n",
                   engine_.settings().max_samples_per_block);
    }
    return report.reason;
  }

  /// What is due at `stop` samples per pixel. Of a run that was interrupted before, that is the
  /// picture that was still to come, but no frame: its name would be wrong.
  void write_at(double stop, bool interrupted) {
    const bool last = interrupted || stop == stops_.back();
    const bool output = options_.output.empty()
                            ? last
                            : stop == options_.samples_per_pixel ||
                                  (interrupted && stop < options_.samples_per_pixel);
    const auto frame = std::find(frame_rates.begin(), frame_rates.end(), stop);
    const bool is_frame = !options_.frames.empty() && frame != frame_rates.end() && !interrupted;
    if (!output && !is_frame) return;
    const freqsynth::FrequencyImage image = image_of(engine_, options_);
    if (output) write_output(image);
    if (!is_frame) return;
    frames_.push_back(picture_of(image, options_, 1));
    write_picture(frame_name(options_, static_cast<std::size_t>(frame - frame_rates.begin())),
                  frames_.back());
  }

  /// The picture, its density and the figures, as far as they are wanted. Before the first choice
  /// of blocks is sampled there is no picture, and an older one stays.
  void write_output(const freqsynth::FrequencyImage& image) {
    const bool has_picture =
        reason_ != freqsynth::StopReason::cancelled || engine_.stats().waves > 0;
    if (!has_picture) std::fprintf(stderr, "freqsynth_render: too early for a picture\n");
    if (has_picture && options_.direct) {
      write_direct(options_, image);
    } else if (has_picture && !options_.output.empty()) {
      write_picture(options_.output, picture_of(image, options_, options_.scale),
                    {options_.quality, options_.subsampling});
    }
    seconds_.wall =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    if (has_picture && !options_.density.empty()) {
      write_picture(options_.density, density_of(image));
    }
    if (has_picture && !options_.error.empty()) {
      write_picture(options_.error, {options_.width, options_.height, image.channels(),
                                     engine_.error_image({.residuals = !options_.no_residuals})});
    }
    if (!options_.stats.empty()) write_stats(options_, engine_.stats(), reason_, seconds_);
  }

  void tell_bad_samples() const {
    const auto bad = engine_.bad_samples();
    if (bad.empty()) return;
    std::fprintf(stderr, "freqsynth_render: %llu samples were not finite, the first at (%g, %g)\n",
                 static_cast<unsigned long long>(engine_.stats().bad_samples), bad.front().x,
                 bad.front().y);
  }

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const Options& options_;
  const scenes::Scene& scene_;
  std::vector<double> stops_;
  freqsynth::Synthesizer engine_;
  freqsynth::ThreadPool pool_;
  Checkpoint checkpoint_;
  ProgressBar bar_;
  Seconds seconds_;
  freqsynth::StopReason reason_ = freqsynth::StopReason::samples;
  std::vector<Picture> frames_;
};

}  // namespace

bool synthesize(const Options& options, const scenes::Scene& scene) {
  return Synthesis(options, scene).run();
}

void prepare_frames(const Options& options) {
  const std::size_t channels = options.gray ? 1 : 3;
  make_folder(options.frames);
  for (std::size_t frame = 0; frame < frame_rates.size(); ++frame) {
    check_picture(frame_name(options, frame), options.width, options.height, channels);
  }
  check_picture(contact_sheet_name(options), options.width, options.height, channels);
}
