// SPDX-License-Identifier: MIT
#include "reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/sampling.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/jpeg/display_encoding.h"
#include "scenes/random.h"

namespace {

/// Rows between two tellings of progress: enough for all threads, but not many samples.
std::size_t rows_together(const freqsynth::ThreadPool& pool, std::size_t samples_per_row) {
  constexpr std::size_t enough = std::size_t{1} << 16;  // for each thread
  return pool.concurrency() * std::clamp<std::size_t>(enough / samples_per_row, 1, 8);
}

}  // namespace

std::pair<Picture, std::size_t> render_reference(const scenes::Scene& scene, std::size_t width,
                                                 std::size_t height, std::size_t channels,
                                                 std::size_t samples, std::uint64_t seed,
                                                 Averaging averaging, freqsynth::ThreadPool& pool,
                                                 const std::function<bool(double)>& progress) {
  const bool display = averaging == Averaging::display;
  const freqsynth::DisplayEncoding encoding;
  Picture picture{width, height, channels, std::vector<float>(width * height * channels), display};
  auto down = static_cast<std::size_t>(std::sqrt(static_cast<double>(samples)));
  while (samples % down != 0) --down;
  const std::size_t across = samples / down;

  std::size_t row_begin = 0;
  const auto render_row = [&](std::size_t task) {
    const std::size_t y = row_begin + task;
    std::seed_seq seeds{seed, seed >> 32, std::uint64_t{y}};
    std::mt19937_64 random(seeds);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    std::array<float, 3> value{};
    for (std::size_t x = 0; x < width; ++x) {
      std::array<double, 3> sum{};
      for (std::size_t i = 0; i < samples; ++i) {
        const double dx =
            (static_cast<double>(i % across) + uniform()) / static_cast<double>(across);
        const double dy = (static_cast<double>(i / across) + uniform()) / static_cast<double>(down);
        // Other seeds give others.
        const std::uint64_t pixel = std::uint64_t{y} * width + x;
        const std::uint64_t id = scenes::sample_id(scenes::mix_bits(~seed) + pixel, i);
        sample_scene(scene, static_cast<double>(x) + dx, static_cast<double>(y) + dy, id,
                     std::span(value).first(channels));
        for (std::size_t c = 0; c < channels; ++c) {
          sum[c] += double{display ? encoding.encode(value[c]) / 255 : value[c]};
        }
      }
      for (std::size_t c = 0; c < channels; ++c) {
        picture.pixels[(y * width + x) * channels + c] =
            static_cast<float>(sum[c] / static_cast<double>(samples));
      }
    }
  };
  // A few rows at a time, so that progress can be told in between.
  bool goes_on = true;
  while (row_begin < height && goes_on) {
    const std::size_t rows = std::min(rows_together(pool, width * samples), height - row_begin);
    pool.execute(rows, freqsynth::TaskRef(render_row));
    row_begin += rows;
    goes_on = progress(static_cast<double>(row_begin) / static_cast<double>(height));
  }
  return {std::move(picture), row_begin};
}
