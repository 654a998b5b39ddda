// SPDX-License-Identifier: MIT
#include "measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

#include "baselines/sampler.h"

namespace field_cases {
namespace {

using SharedList = decltype(freqsynth::SynthesisSettings::shared_list);

// The list of a seed is built once: that takes longer than a small picture.
SharedList list_of(std::uint64_t seed) {
  static std::mutex mutex;
  static std::map<std::uint64_t, SharedList> lists;
  const std::lock_guard lock(mutex);
  SharedList& list = lists[seed];
  if (!list) {
    freqsynth::SynthesisSettings settings = settings_of(8, 8);
    settings.list.seed = seed;
    list = freqsynth::Synthesizer(settings).settings().shared_list;
  }
  return list;
}

std::size_t pixel_of(double position, std::size_t size) {
  return std::min(static_cast<std::size_t>(position), size - 1);
}

}  // namespace

Sampler sampler_of(const Field& field) {
  return [value = field.value](double x, double y, std::uint64_t, std::span<float> values) {
    values[0] = static_cast<float>(value(x, y));
  };
}

freqsynth::SynthesisSettings settings_of(std::size_t width, std::size_t height) {
  freqsynth::SynthesisSettings settings;
  settings.width = width;
  settings.height = height;
  settings.channels = 1;
  return settings;
}

freqsynth::SynthesisSettings uniform_settings(freqsynth::SynthesisSettings settings) {
  settings.priority.exploration = 1;
  return settings;
}

freqsynth::SynthesisSettings display_settings(freqsynth::SynthesisSettings settings) {
  settings.priority.steer = freqsynth::Steer::display;
  return settings;
}

freqsynth::FrequencyImage synthesize_image(const Sampler& sampler,
                                           freqsynth::SynthesisSettings settings, double rate,
                                           std::uint64_t seed, std::uint64_t* samples) {
  settings.list.seed = seed;
  settings.shared_list = list_of(seed);
  const std::size_t channels = settings.channels;
  freqsynth::Synthesizer engine(std::move(settings));
  freqsynth::StopRule stop;
  stop.samples_per_pixel = rate;
  engine.run(
      [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          sampler(requests[i].x, requests[i].y, requests[i].id,
                  values.subspan(i * channels, channels));
        }
      },
      stop);
  if (samples) *samples = engine.stats().samples;
  return engine.finished_image();
}

Picture synthesize(const Sampler& sampler, const freqsynth::SynthesisSettings& settings,
                   double rate, std::uint64_t seed) {
  Picture picture{settings.width, settings.height, settings.channels, {}, 0};
  picture.pixels =
      freqsynth::reconstruct(synthesize_image(sampler, settings, rate, seed, &picture.samples));
  return picture;
}

Picture jittered(const Sampler& sampler, std::size_t width, std::size_t height,
                 std::size_t channels, std::uint64_t samples, std::uint64_t seed) {
  baselines::Job job;
  job.width = width;
  job.height = height;
  job.samples = samples;
  baselines::Random random(baselines::scatter(seed));
  Picture picture{width, height, channels, std::vector<float>(width * height * channels), samples};
  std::vector<double> sums(width * height * channels);
  std::vector<double> nearest(width * height * channels);
  std::vector<std::uint32_t> counts(width * height * channels);
  std::vector<float> values(channels);
  std::uint64_t id = baselines::scatter(seed + 1);
  baselines::for_each_stratum(job, [&](const baselines::Rectangle& stratum) {
    const double x = stratum.left + stratum.width() * random.uniform();
    const double y = stratum.top + stratum.height() * random.uniform();
    sampler(x, y, id++, values);
    const std::size_t own = (pixel_of(y, height) * width + pixel_of(x, width)) * channels;
    for (std::size_t c = 0; c < channels; ++c) {
      if (!std::isfinite(values[c])) continue;
      sums[own + c] += static_cast<double>(values[c]);
      ++counts[own + c];
    }
    // Pixels whose centres lie in the stratum.
    const auto first = [](double low) {
      return static_cast<std::size_t>(std::max(0.0, std::ceil(low - 0.5)));
    };
    for (std::size_t j = first(stratum.top); j < height && double(j) + 0.5 < stratum.bottom; ++j) {
      for (std::size_t i = first(stratum.left); i < width && double(i) + 0.5 < stratum.right; ++i) {
        for (std::size_t c = 0; c < channels; ++c) {
          if (std::isfinite(values[c])) {
            nearest[(j * width + i) * channels + c] = static_cast<double>(values[c]);
          }
        }
      }
    }
  });
  for (std::size_t k = 0; k < sums.size(); ++k) {
    picture.pixels[k] = static_cast<float>(counts[k] > 0 ? sums[k] / counts[k] : nearest[k]);
  }
  return picture;
}

std::uint64_t samples_at(double rate, std::size_t width, std::size_t height) {
  const double samples = std::round(rate * static_cast<double>(width * height));
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(samples));
}

double squared_error(const Picture& picture, std::span<const double> right,
                     const Columns& columns) {
  double sum = 0;
  const std::size_t to = std::min(columns.to, picture.width);
  for (std::size_t j = 0; j < picture.height; ++j) {
    for (std::size_t i = columns.from; i < to; ++i) {
      const double error = picture.at(i, j) - right[j * picture.width + i];
      sum += error * error;
    }
  }
  return sum / static_cast<double>(picture.height * (to - columns.from));
}

double mean(const Picture& picture) {
  double sum = 0;
  for (std::size_t j = 0; j < picture.height; ++j) {
    for (std::size_t i = 0; i < picture.width; ++i) sum += picture.at(i, j);
  }
  return sum / static_cast<double>(picture.width * picture.height);
}

double over_seeds(const Sampler& sampler, const freqsynth::SynthesisSettings& settings, double rate,
                  const Measure& measure, std::uint64_t seeds) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    sum += measure(synthesize(sampler, settings, rate, seed));
  }
  return sum / static_cast<double>(seeds);
}

double over_jittered(const Sampler& sampler, std::size_t width, std::size_t height,
                     std::size_t channels, double rate, const Measure& measure,
                     std::uint64_t seeds) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    sum +=
        measure(jittered(sampler, width, height, channels, samples_at(rate, width, height), seed));
  }
  return sum / static_cast<double>(seeds);
}

double display(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

}  // namespace field_cases
