// SPDX-License-Identifier: MIT
// What the engine costs a renderer on Embree, and what it is worth: its share of the time, and
// errors at equal seconds against the same renderer's plain samples. All times are CPU times, so
// that a machine that others use as well can be measured.

#include <OpenImageIO/argparse.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/option_values.h"
#include "embree/rendering.h"

namespace {

using namespace embree_host;

double cpu_seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double of_process() { return cpu_seconds(CLOCK_PROCESS_CPUTIME_ID); }
double of_thread() { return cpu_seconds(CLOCK_THREAD_CPUTIME_ID); }

Renderer make_renderer(std::size_t width, std::size_t height, std::uint32_t light_samples) {
  View view;
  Model model = make_colonnade(view);
  return Renderer(Geometry(std::move(model)), view, {}, width, height, light_samples);
}

/// The renderer's own time is that within its calls, on all threads; the engine's that of the
/// thread that runs it, outside of these. The finish is measured on one thread, but all can do it.
void measure_share(const Renderer& renderer, const Job& job, std::size_t threads,
                   std::uint32_t light_samples) {
  HostPool pool = make_pool(threads);
  std::atomic<double> in_all{0};
  double in_caller = 0;
  static thread_local bool is_caller = false;
  is_caller = true;
  const Sampler sampler{renderer};
  const auto timed = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    const double begin = of_thread();
    sampler(requests, values);
    const double seconds = of_thread() - begin;
    in_all += seconds;
    if (is_caller) in_caller += seconds;
  };
  const double begin = of_thread();
  freqsynth::Synthesizer engine(settings_of(job.width, job.height));
  engine.run(timed, {.samples_per_pixel = job.samples_per_pixel}, pool, freqsynth::KeepGoing{},
             batch);
  const double sampled = of_thread();
  std::vector<float> pixels(job.width * job.height * (channels - 1));
  engine.finish({.data = pixels.data(), .width = job.width, .height = job.height});
  const std::vector<float> depths = engine.nearest_pixels(channels - 1);
  const double finished = of_thread();
  const double count = static_cast<double>(engine.stats().samples + engine.stats().probes);
  const double host = in_all / count, core = (sampled - begin - in_caller) / count,
               finish = (finished - sampled) / count;
  const auto workers = static_cast<double>(threads);
  const auto share = [&](double own) { return 100 * own / (own + host / workers); };
  std::printf("| %u | %g | %zu | %.2f | %.2f | %.2f | %.0f %% | %.0f %% |\n", light_samples,
              job.samples_per_pixel, threads, 1e6 * host, 1e6 * core, 1e6 * finish, share(core),
              share(core + finish / workers));
  std::fflush(stdout);
}

void measure_shares(std::size_t width, std::size_t height) {
  std::printf(
      "| paths a sample | samples per pixel | threads | renderer, us a sample | engine | finish "
      "| share of the engine | with finish |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::uint32_t light_samples : {1u, 16u}) {
    const Renderer renderer = make_renderer(width, height, light_samples);
    for (const double rate : {1.0, 4.0}) {
      if (light_samples > 1 && rate > 1) continue;
      for (const std::size_t threads : {1u, 2u}) {
        measure_share(renderer, {width, height, rate}, threads, light_samples);
      }
    }
  }
}

/// Root mean square difference of the light.
double error_of(const Pixels& pixels, const Pixels& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); i += channels) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::pow(double{pixels[i + c]} - double{reference[i + c]}, 2);
    }
  }
  return std::sqrt(sum * static_cast<double>(channels) / (3 * static_cast<double>(pixels.size())));
}

struct Run {
  double rate, seconds, error;
};

/// The error after so many seconds, between two runs, or beyond the last as these two go on.
double error_at(double seconds, const std::vector<Run>& runs) {
  std::size_t i = 1;
  while (i + 1 < runs.size() && runs[i].seconds < seconds) ++i;
  const Run &a = runs[i - 1], &b = runs[i];
  const double slope = std::log(b.error / a.error) / std::log(b.seconds / a.seconds);
  return a.error * std::pow(seconds / a.seconds, slope);
}

void measure_errors(std::size_t width, std::size_t height, std::uint32_t light_samples,
                    double reference_rate) {
  using path_tracer::Numbers;
  const Renderer renderer = make_renderer(width, height, light_samples);
  const Watch go_on = [](const freqsynth::Progress&) { return true; };
  const Pixels reference = [&] {
    HostPool all = make_pool(0);
    return render_plainly(renderer, {width, height, reference_rate, 1u << 20}, Numbers::sobol, all,
                          go_on);
  }();
  HostPool one = make_pool(1);
  const auto measure = [&](double rate, const auto& render) {
    // The mean of squared errors over some frames, as far as these cost little.
    const int frames = rate <= 4 ? 3 : 1;
    double squares = 0, seconds = 0;
    for (int frame = 0; frame < frames; ++frame) {
      const double begin = of_process();
      const Pixels pixels = render(Job{width, height, rate, static_cast<std::uint64_t>(frame)});
      seconds += of_process() - begin;
      squares += std::pow(error_of(pixels, reference), 2);
    }
    return Run{rate, seconds / frames, std::sqrt(squares / frames)};
  };
  const auto plain = [&](Numbers numbers) {
    std::vector<Run> runs;
    for (const double rate : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
      runs.push_back(measure(rate, [&](const Job& job) {
        return render_plainly(renderer, job, numbers, one, go_on);
      }));
    }
    return runs;
  };
  const std::vector<Run> jittered = plain(Numbers::random), sobol = plain(Numbers::sobol);
  std::printf("| sampler | samples per pixel | CPU seconds | RMSE |\n|---|---|---|---|\n");
  for (const auto& [name, runs] : {std::pair{"jittered", &jittered}, std::pair{"Sobol", &sobol}}) {
    for (const Run& run : *runs) {
      std::printf("| %s | %g | %.2f | %.4f |\n", name, run.rate, run.seconds, run.error);
    }
  }
  std::printf(
      "\n| freqsynth, samples per pixel | CPU seconds | RMSE | jittered in that time | Sobol in "
      "that "
      "time |\n|---|---|---|---|---|\n");
  for (const double rate : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
    const Run run =
        measure(rate, [&](const Job& job) { return render_adaptively(renderer, job, one, go_on); });
    const double by_jitter = error_at(run.seconds, jittered),
                 by_sobol = error_at(run.seconds, sobol);
    std::printf("| %g | %.2f | %.4f | %.4f (%.2f times) | %.4f (%.2f times) |\n", rate, run.seconds,
                run.error, by_jitter, by_jitter / run.error, by_sobol, by_sobol / run.error);
    std::fflush(stdout);
  }
}

int run(int argc, const char** argv) {
  std::string size, light_samples, reference, what = "share";
  OIIO::ArgParse parser;
  parser.intro("freqsynth_embree_benchmark: a renderer on Embree with and without freqsynth");
  parser.add_help(false).exit_on_error(false);
  parser.arg("--measure %s:NAME", &what).help("share: of the engine; errors: at equal seconds");
  parser.arg("--size %s:WxH", &size).help("1920x1080 for shares, 320x180 for errors");
  parser.arg("--light-samples %s:N", &light_samples).help("Paths of a sample, for errors (1)");
  parser.arg("--reference %s:N", &reference).help("Samples per pixel of the reference (1024)");
  if (parser.parse_args(argc, argv) < 0) throw UsageError(parser.geterror());
  if (what != "share" && what != "errors") refuse("--measure", what, "share or errors");
  const bool shares = what == "share";
  std::size_t width = shares ? 1920 : 320, height = shares ? 1080 : 180;
  std::uint32_t paths = 1, rate = 1024;
  read_size("--size", size, width, height);
  read_count<std::uint32_t>("--light-samples", light_samples, 1, paths);
  read_count<std::uint32_t>("--reference", reference, 1, rate);
  if (shares) {
    measure_shares(width, height);
  } else {
    measure_errors(width, height, paths, rate);
  }
  return 0;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_embree_benchmark: %s\n", error.what());
    return 1;
  }
}
