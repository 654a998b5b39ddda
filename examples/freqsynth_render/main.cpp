// Renders a scene with freqsynth, or with jittered samples for comparison.

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "direct.h"
#include "freqsynth/basis/sample_sequence.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "options.h"
#include "picture.h"
#include "progress_bar.h"
#include "reference.h"
#include "sampling.h"
#include "scenes/scene.h"

namespace {

/// Samples per pixel of the pictures of figures 12 and 14.
constexpr std::array frame_rates{1.0 / 64, 1.0 / 32, 1.0 / 16, 1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0, 2.0};

struct Seconds {
  double sampler = 0, core = 0, wall = 0;
};

double samples_per_pixel(const Options& options, const freqsynth::SynthesisStats& stats) {
  return static_cast<double>(stats.samples) / static_cast<double>(options.width * options.height);
}

/// Why a run ended, in the words of --stats.
const char* name_of(freqsynth::StopReason reason) {
  switch (reason) {
    case freqsynth::StopReason::samples:
      return "samples";
    case freqsynth::StopReason::threshold:
      return "target";
    default:
      return "exhausted";
  }
}

void write_stats(const Options& options, const freqsynth::SynthesisStats& stats,
                 freqsynth::StopReason reason, const Seconds& seconds) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::array<char, 1024> text{};
  std::snprintf(text.data(), text.size(),
                "{\n"
                "  \"width\": %zu,\n"
                "  \"height\": %zu,\n"
                "  \"samples\": %llu,\n"
                "  \"samples_per_pixel\": %.9g,\n"
                "  \"ended_by\": \"%s\",\n"
                "  \"absorbed\": %llu,\n"
                "  \"blocks\": %llu,\n"
                "  \"bad_samples\": %llu,\n"
                "  \"sampler_seconds\": %.6f,\n"
                "  \"core_seconds\": %.6f,\n"
                "  \"wall_seconds\": %.6f,\n"
                "  \"peak_rss_bytes\": %lld\n"
                "}\n",
                options.width, options.height, static_cast<unsigned long long>(stats.samples),
                samples_per_pixel(options, stats), name_of(reason),
                static_cast<unsigned long long>(stats.absorbed),
                static_cast<unsigned long long>(stats.blocks),
                static_cast<unsigned long long>(stats.bad_samples), seconds.sampler, seconds.core,
                seconds.wall, static_cast<long long>(usage.ru_maxrss) * 1024);
  write_text(options.stats, text.data());
}

/// Finished pixels, or the paper's function where the user asks for it.
freqsynth::FrequencyImage image_of(const freqsynth::Synthesizer& engine, const Options& options) {
  if (options.pixel_filter == freqsynth::PixelFilter::none) return engine.image();
  freqsynth::FinishSettings settings;
  if (engine.settings().noisy) settings = freqsynth::FinishSettings::noisy();
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

JpegSettings jpeg_of(const Options& options) { return {options.quality, options.subsampling}; }

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

void synthesize(const Options& options, const scenes::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  freqsynth::SynthesisSettings settings;
  settings.width = options.width;
  settings.height = options.height;
  settings.channels = options.gray ? 1 : 3;
  settings.wave = options.wave;
  settings.noisy = scene.noisy();
  settings.list.seed = options.seed;
  settings.list.samples_per_term = options.terms_every;
  if (options.until_quality) {
    settings.quantization = freqsynth::quantization_target(quantization_of(options),
                                                           settings.channels, options.tolerance);
  }
  // Room for blocks with four times the average.
  const double generous = 4 * 64 * options.samples_per_pixel;
  settings.max_samples_per_block = static_cast<std::size_t>(
      options.until_quality
          ? 4096
          : std::clamp<double>(generous, 4096, freqsynth::SampleSequence::max_size));

  freqsynth::Synthesizer engine(settings);
  freqsynth::ThreadPool pool(options.threads);
  const auto sampler = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      sample_scene(scene, requests[i].x, requests[i].y, requests[i].id,
                   values.subspan(i * settings.channels, settings.channels));
    }
  };

  std::vector<double> stops;
  if (!options.output.empty()) stops.push_back(options.samples_per_pixel);
  if (!options.frames.empty()) stops.insert(stops.end(), frame_rates.begin(), frame_rates.end());
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());

  ProgressBar bar;
  Seconds seconds;
  std::vector<Picture> frames;
  for (const double stop : stops) {
    const auto progress = [&](double share) {
      if (std::isfinite(stop)) {
        bar.show(share * stop / stops.back());
      } else {
        bar.count(samples_per_pixel(options, engine.stats()));
      }
      return true;
    };
    const auto run = [&](auto&& values) {
      return engine.run(values, {.samples_per_pixel = stop}, pool, progress);
    };
    const freqsynth::RunReport report =
        options.averaging == Averaging::display
            ? run(freqsynth::DisplaySampler(sampler, settings.channels))
            : run(sampler);
    seconds.sampler += report.sampler_seconds;
    seconds.core += report.core_seconds;
    if (report.reason == freqsynth::StopReason::exhausted) {
      std::fprintf(stderr, "freqsynth_render: every block has its %zu samples\n",
                   settings.max_samples_per_block);
    }
    const freqsynth::FrequencyImage image = image_of(engine, options);
    if (!options.output.empty() && stop == options.samples_per_pixel) {
      if (options.direct) {
        write_direct(options, image);
      } else {
        write_picture(options.output, picture_of(image, options, options.scale), jpeg_of(options));
      }
      seconds.wall =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (!options.density.empty()) write_picture(options.density, density_of(image));
      if (!options.stats.empty()) write_stats(options, engine.stats(), report.reason, seconds);
    }
    const auto frame = std::find(frame_rates.begin(), frame_rates.end(), stop);
    if (!options.frames.empty() && frame != frame_rates.end()) {
      frames.push_back(picture_of(image, options, 1));
      write_picture(frame_name(options, static_cast<std::size_t>(frame - frame_rates.begin())),
                    frames.back());
    }
  }
  if (!frames.empty()) {
    write_picture(options.frames + "/contact_sheet.png", contact_sheet(frames, 4));
  }
  if (const auto bad = engine.bad_samples(); !bad.empty()) {
    std::fprintf(stderr, "freqsynth_render: %llu samples were not finite, the first at (%g, %g)\n",
                 static_cast<unsigned long long>(engine.stats().bad_samples), bad.front().x,
                 bad.front().y);
  }
}

void render_jittered(const Options& options, const scenes::Scene& scene) {
  const auto begin = std::chrono::steady_clock::now();
  freqsynth::ThreadPool pool(options.threads);
  ProgressBar bar;
  const Picture picture = render_reference(
      scene, options.width, options.height, options.gray ? 1 : 3, options.reference, options.seed,
      options.averaging, pool, [&](double share) { bar.show(share); });
  Seconds seconds;
  seconds.sampler = seconds.wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_picture(options.output, picture, jpeg_of(options));
  freqsynth::SynthesisStats stats;
  stats.samples = options.reference * options.width * options.height;
  if (!options.stats.empty()) write_stats(options, stats, freqsynth::StopReason::samples, seconds);
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    std::unique_ptr<scenes::Scene> scene;
    scenes::SceneOptions scene_options{.name = options->scene,
                                       .width = static_cast<int>(options->width),
                                       .height = static_cast<int>(options->height),
                                       .seed = options->seed};
    if (options->zone_frequency) scene_options.zone_frequency = *options->zone_frequency;
    try {
      scene = scenes::make_scene(scene_options);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--scene: ") + error.what());
    }
    if (options->direct) check_direct();
    if (!options->frames.empty()) make_folder(options->frames);
    if (options->reference != 0) {
      render_jittered(*options, *scene);
    } else {
      synthesize(*options, *scene);
    }
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_render: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_render: %s\n", error.what());
    return 1;
  }
}
