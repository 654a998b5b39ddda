// SPDX-License-Identifier: MIT
// Sampling by a tree of nodes beside the engine of blocks, at equal samples:
//   freqsynth_tree [--rates 0.25,1,4] [--seeds 1] [--size 256] [--reference 1024]
//                  [--folder out/references] scene...
// Prints for each rule of splitting the RMSE against averages of so many jittered samples per
// pixel, or exact ones, its ratio to that of the engine, and the processor time without that of the
// scene. References are kept in the folder, if there is one.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "freqsynth/engine/direction_rule.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/engine/tree_sampler.h"
#include "freqsynth/image/tree_pictures.h"
#include "quality/methods.h"
#include "quality/metrics.h"
#include "quality/reference.h"
#include "quality/reference_cache.h"
#include "quality/scene_radiance.h"
#include "scenes/scene.h"

namespace {

struct Options {
  std::vector<double> rates = {0.25, 1, 4};
  std::uint64_t seeds = 1;
  int size = 256;
  std::size_t reference = 1024;  // samples per pixel
  std::string folder;            // of references
  std::vector<std::string> scenes;
};

Options options_of(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (name.rfind("--", 0) != 0) {
      options.scenes.push_back(name);
      continue;
    }
    if (++i == count) throw std::invalid_argument(name + " needs a value");
    const std::string value = arguments[i];
    if (name == "--rates") {
      options.rates.clear();
      std::istringstream list(value);
      for (std::string rate; std::getline(list, rate, ',');) {
        options.rates.push_back(std::stod(rate));
      }
    } else if (name == "--seeds") {
      options.seeds = std::stoull(value);
    } else if (name == "--reference") {
      options.reference = std::stoull(value);
    } else if (name == "--folder") {
      options.folder = value;
    } else if (name == "--size") {
      options.size = std::stoi(value);
    } else {
      throw std::invalid_argument("no option " + name);
    }
  }
  if (options.scenes.empty()) options.scenes = {"gradient", "edge", "fan", "chess", "zoneplate"};
  return options;
}

enum class Splits { always, by_direction, where_needed };

baselines::Rendering by_tree(const baselines::Radiance& radiance, const baselines::Job& job,
                             Splits splits) {
  freqsynth::TreeSettings settings;
  settings.width = job.width;
  settings.height = job.height;
  settings.seed = job.seed;
  settings.noisy = job.noisy;
  constexpr double any_gain = 5;
  freqsynth::DirectionRule rule(
      splits == Splits::by_direction ? any_gain : freqsynth::DirectionRule::usual_gain);
  freqsynth::TreeSampler sampler(settings, splits == Splits::always ? nullptr : &rule);
  baselines::Rendering result{job.width, job.height, {}, {}};
  result.samples.resize(job.width * job.height);
  sampler.run(
      [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
          const freqsynth::Request& request = requests[i];
          radiance(request.x, request.y, quality::id_of(request, job.seed),
                   values.subspan(3 * i).first<3>());
          ++result.samples[request.pixel];
        }
      },
      job.samples);
  freqsynth::TreePictures pictures(sampler.tree().positions(), job.noisy
                                                                   ? freqsynth::PriorBank::noisy()
                                                                   : freqsynth::PriorBank::exact());
  result.pixels = pictures.pixels(sampler.tree());
  for (float& pixel : result.pixels) pixel = pixel > 0 ? pixel : 0;
  return result;
}

std::vector<quality::Method> methods() {
  const auto tree = [](Splits splits) {
    return [splits](const baselines::Radiance& radiance, const baselines::Job& job) {
      return by_tree(radiance, job, splits);
    };
  };
  return {quality::find_method("freqsynth"),
          {"tree, always split", "", "", tree(Splits::always)},
          {"tree, direction", "", "", tree(Splits::by_direction)},
          {"tree", "", "", tree(Splits::where_needed)}};
}

void compare(const Options& options) {
  const std::vector<quality::Method> all = methods();
  freqsynth::ThreadPool pool(1);
  std::printf("%-15s %6s", "scene", "rate");
  for (const quality::Method& method : all) std::printf(" %24s", method.name.c_str());
  std::printf("\n");
  for (const std::string& name : options.scenes) {
    const auto scene =
        scenes::make_scene({.name = name, .width = options.size, .height = options.size});
    const baselines::Radiance radiance = quality::radiance_of(*scene);
    const auto size = static_cast<std::size_t>(options.size);
    const std::vector<float> reference =
        quality::cached_reference(options.folder, name, radiance, quality::pixel_average_of(*scene),
                                  {size, size, options.reference, 1}, pool, [](double) {})
            .pixels();
    const quality::PictureView right{size, size, reference};
    for (const double rate : options.rates) {
      std::printf("%-15s %6g", name.c_str(), rate);
      double first = 0;
      for (const quality::Method& method : all) {
        double squares = 0, seconds = 0;
        for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
          const baselines::Job job =
              quality::job_of(*scene, size, size, quality::samples_of(rate, size, size), seed);
          const quality::Run run = quality::run_method(method, radiance, job);
          const double rmse = quality::rmse({size, size, run.pixels}, right);
          squares += rmse * rmse / static_cast<double>(options.seeds);
          seconds += (run.seconds - run.sampler_seconds) / static_cast<double>(options.seeds);
        }
        const double rmse = std::sqrt(squares);
        if (first == 0) first = rmse;
        std::printf(" %9.3g %7.3f %5.2fs", rmse, rmse / first, seconds);
        std::fflush(stdout);
      }
      std::printf("\n");
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  try {
    compare(options_of(count, arguments));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_tree: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
