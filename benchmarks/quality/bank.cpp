// SPDX-License-Identifier: MIT
// Pictures by a bank of priors beside those of the engine, from the same samples: every block has
// the first 25, 81 or 289 positions of the sequence, which is about 1/4, 1 and 4 samples per pixel.
//
//   freqsynth_bank_quality [SCENE ...]   RMSE of linear RGB at 256 x 256, and processor time
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "freqsynth/image/bank_picture.h"
#include "quality/metrics.h"
#include "quality/reference_cache.h"
#include "quality/scene_radiance.h"

namespace {

using namespace freqsynth;

constexpr std::size_t size = 256, blocks = size / block_size;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

quality::PictureView view(std::span<const float> pixels) { return {size, size, pixels}; }

/// The first samples of all blocks. Those on borders are taken once.
struct Samples {
  std::vector<std::vector<float>> values;
  std::size_t calls = 0;

  Samples(const scenes::Scene& scene, std::span<const UnitPoint> positions)
      : values(blocks * blocks) {
    std::map<std::pair<double, double>, std::size_t> known;  // on borders
    std::vector<float> shared;
    for (std::size_t b = 0; b < values.size(); ++b) {
      for (const UnitPoint& point : positions) {
        const double x = (static_cast<double>(b % blocks) + point.s) * block_size;
        const double y = (static_cast<double>(b / blocks) + point.t) * block_size;
        const bool border = point.s == 0 || point.s == 1 || point.t == 0 || point.t == 1;
        float rgb[3];
        const auto found = border ? known.find({x, y}) : known.end();
        if (found != known.end()) {
          for (std::size_t c = 0; c < 3; ++c) rgb[c] = shared[found->second + c];
        } else {
          scene.radiance(x, y, std::uint64_t{++calls} << 24, rgb);
          if (border) {
            known[{x, y}] = shared.size();
            shared.insert(shared.end(), rgb, rgb + 3);
          }
        }
        values[b].insert(values[b].end(), rgb, rgb + 3);
      }
    }
  }
};

/// What the engine makes of as many samples at the same positions.
std::vector<float> engine_pixels(const scenes::Scene& scene, std::size_t count,
                                 const InverseListSettings& list) {
  SynthesisSettings settings;
  settings.width = settings.height = size;
  settings.list = list;
  settings.max_samples_per_block = count;
  settings.noise = scene.noisy() ? Noise::present : Noise::none;
  Synthesizer engine(settings);
  engine.run(
      [&](std::span<const Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          scene.radiance(requests[i].x, requests[i].y, quality::id_of(requests[i], 0),
                         values.subspan(3 * i).first<3>());
        }
      },
      {.samples = std::uint64_t{1} << 40});
  return reconstruct(engine.finished_image(), {.clamp_negative = true});
}

std::vector<float> bank_pixels(const BankPictures& pictures, const Samples& samples,
                               double& seconds, double& predicted) {
  std::vector<BlockSamples> list;
  for (const auto& values : samples.values) list.push_back({values.data(), values.size() / 3});
  std::vector<float> pixels(3 * size * size), errors(size * size);
  const double begin = processor_seconds();
  pictures.render(list, {pixels.data(), size, size}, 3, errors);
  seconds = processor_seconds() - begin;
  double sum = 0;
  for (const float error : errors) sum += double{error};
  predicted = std::sqrt(sum / static_cast<double>(errors.size()));
  for (float& value : pixels) value = value < 0 ? 0 : value;
  return pixels;
}

/// Bank pictures of one kind, whose lists all scenes share.
struct Variant {
  const char* name;
  bool ring;
  std::size_t blend;
};
constexpr Variant variants[] = {{"alone", false, 0},
                                {"blended", false, 2},
                                {"ring", true, 0},
                                {"ring, blended", true, 2},
                                {"ring, blended 1", true, 1}};

void measure(const std::string& name, ThreadPool& pool) {
  scenes::SceneOptions options;
  options.name = name;
  options.width = options.height = static_cast<int>(size);
  const auto scene = scenes::make_scene(options);
  const auto reference = quality::cached_reference(
      "out/references", name, quality::radiance_of(*scene), quality::pixel_average_of(*scene),
      {size, size, 256, 1}, pool, [](double) {});
  const std::vector<float> truth = reference.pixels();
  std::printf("%s (reference off by %.2g)\n", name.c_str(), reference.standard_error());
  static std::map<std::tuple<std::size_t, bool, std::size_t>, std::unique_ptr<BankPictures>> made;
  for (const std::size_t count : {std::size_t{25}, std::size_t{81}, std::size_t{289}}) {
    const InverseListSettings list;
    SampleSequence sequence(list.seed, list.positions);
    const auto positions = sequence_points(sequence, count);
    const Samples samples(*scene, positions);
    const std::vector<float> plain = engine_pixels(*scene, count, list);
    const double engine = quality::rmse(view(plain), view(truth));
    std::printf("%4zu samples a block, %.3f calls a pixel: engine %.4g, seam %.2f\n", count,
                static_cast<double>(samples.calls) / (size * size), engine,
                quality::seam_visibility(view(plain), view(truth)));
    for (std::size_t v = 0; v < std::size(variants); ++v) {
      auto& pictures = made[{count, scene->noisy(), v}];
      if (!pictures) {
        BankPictureSettings settings;
        settings.ring = variants[v].ring;
        settings.blend = variants[v].blend;
        if (scene->noisy()) settings.bank = PriorBank::noisy();
        pictures = std::make_unique<BankPictures>(positions, settings);
        double ignored = 0;
        bank_pixels(*pictures, samples, ignored, ignored);  // builds the lists
      }
      double seconds = 0, predicted = 0;
      const auto pixels = bank_pixels(*pictures, samples, seconds, predicted);
      const double error = quality::rmse(view(pixels), view(truth));
      std::printf(
          "  %-15s %.4g, %.3f of the engine's; predicted %.4g; seam %.2f; %.3f s; lists %.1f MB\n",
          variants[v].name, error, error / engine, predicted,
          quality::seam_visibility(view(pixels), view(truth)), seconds,
          static_cast<double>(pictures->memory()) / 1e6);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> names(argv + 1, argv + argc);
  if (names.empty()) names = {"gradient", "edge", "fan", "chess", "zoneplate", "softshadow"};
  ThreadPool pool;
  for (const std::string& name : names) measure(name, pool);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
