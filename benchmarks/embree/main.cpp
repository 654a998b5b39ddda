// SPDX-License-Identifier: MIT
// What the engine costs a renderer on Embree, and what it is worth: its share of the time, and
// errors at equal seconds against the same renderer's plain samples. All times are CPU times, so
// that a machine that others use as well can be measured.

#include <OpenImageIO/argparse.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
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

/// The colonnade.
Renderer make_renderer(std::size_t width, std::size_t height, std::uint32_t light_samples) {
  SceneOptions options;
  options.light_samples = light_samples;
  return embree_host::make_renderer(options, width, height);
}

/// What is sampled: all channels of the renderer, or the light alone.
struct Channels {
  bool all = true;

  [[nodiscard]] std::size_t count() const { return all ? channels : 3; }
  [[nodiscard]] freqsynth::SynthesisSettings settings(const Job& job) const {
    freqsynth::SynthesisSettings settings = settings_of(job);
    settings.channels = count();
    settings.channel_settings.resize(count());
    return settings;
  }
  void sample(const Sampler& sampler, std::span<const freqsynth::Request> requests,
              std::span<float> values) const {
    if (all) return sampler(requests, values);
    std::vector<float> of_all(requests.size() * channels);
    sampler(requests, of_all);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      std::copy_n(&of_all[i * channels], 3, &values[i * 3]);
    }
  }
};

struct Share {
  double renderer, engine, finish;  ///< seconds of CPU time for a sample, on one thread
};

/// The renderer's time is that within its calls, the engine's what is left of the run.
Share measure_share(const Renderer& renderer, const Job& job, const Channels& kept) {
  const Sampler sampler{renderer};
  double sampling = 0;
  const auto timed = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    const double begin = of_thread();
    kept.sample(sampler, requests, values);
    sampling += of_thread() - begin;
  };
  const double begin = of_thread();
  freqsynth::Synthesizer engine(kept.settings(job));
  engine.run(timed, {.samples_per_pixel = job.samples_per_pixel}, freqsynth::SerialExecutor{},
             freqsynth::KeepGoing{}, batch);
  const double sampled = of_thread();
  std::vector<float> pixels(job.width * job.height * (kept.all ? channels - 1 : 3));
  engine.finish({.data = pixels.data(), .width = job.width, .height = job.height});
  if (kept.all) static_cast<void>(engine.channel_pixels(depth));
  const double finished = of_thread();
  const auto count = static_cast<double>(engine.stats().samples + engine.stats().probes);
  return {sampling / count, (sampled - begin - sampling) / count, (finished - sampled) / count};
}

/// The engine's share of the time of a run on all threads, by the clock on the wall.
double share_on_all(const Renderer& renderer, const Job& job, const Channels& kept) {
  HostPool pool = make_pool(0);
  const Sampler sampler{renderer};
  const auto sample = [&](std::span<const freqsynth::Request> requests, std::span<float> values) {
    kept.sample(sampler, requests, values);
  };
  freqsynth::Synthesizer engine(kept.settings(job));
  const auto report = engine.run(sample, {.samples_per_pixel = job.samples_per_pixel}, pool,
                                 freqsynth::KeepGoing{}, batch);
  return report.core_seconds / (report.core_seconds + report.sampler_seconds);
}

void measure_shares(std::size_t width, std::size_t height) {
  struct Case {
    std::uint32_t light_samples;
    double rate;
    Channels kept;
  };
  std::printf(
      "| paths a sample | samples per pixel | channels | renderer, us a sample | engine | finish | "
      "share of the engine | with finish | of the engine on %zu threads |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      make_pool(0).concurrency());
  for (const Case& each : {Case{1, 1, {false}}, Case{1, 1, {}}, Case{1, 4, {}}, Case{4, 1, {}},
                           Case{16, 1, {}}, Case{32, 1, {}}}) {
    const Renderer renderer = make_renderer(width, height, each.light_samples);
    const Job job{width, height, each.rate};
    const Share share = measure_share(renderer, job, each.kept);
    const double engine = share.engine, finish = share.finish;
    std::printf("| %u | %g | %zu | %.2f | %.2f | %.2f | %.0f %% | %.0f %% | %.0f %% |\n",
                each.light_samples, each.rate, each.kept.count(), 1e6 * share.renderer,
                1e6 * engine, 1e6 * finish, 100 * engine / (engine + share.renderer),
                100 * (engine + finish) / (engine + finish + share.renderer),
                100 * share_on_all(renderer, job, each.kept));
    std::fflush(stdout);
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
  std::printf(
      "| samples per pixel | jittered: seconds | error | Sobol: seconds | error |\n"
      "|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < jittered.size(); ++i) {
    std::printf("| %g | %.2f | %.4f | %.2f | %.4f |\n", jittered[i].rate, jittered[i].seconds,
                jittered[i].error, sobol[i].seconds, sobol[i].error);
  }
  std::printf(
      "\n| freqsynth, samples per pixel | seconds | error | Sobol with as many samples | jittered "
      "in "
      "that time | Sobol in that time |\n|---|---|---|---|---|---|\n");
  for (const double rate : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
    const Run run =
        measure(rate, [&](const Job& job) { return render_adaptively(renderer, job, one, go_on); });
    const double by_jitter = error_at(run.seconds, jittered),
                 by_sobol = error_at(run.seconds, sobol);
    const auto as_many = std::find_if(sobol.begin(), sobol.end(),
                                      [&](const Run& other) { return other.rate == rate; });
    std::printf("| %g | %.2f | %.4f |", rate, run.seconds, run.error);
    const auto tell = [&](double error) {
      std::printf(" %.4f (%.2f times) |", error, error / run.error);
    };
    if (as_many != sobol.end()) {
      tell(as_many->error);
    } else {
      std::printf(" |");
    }
    tell(by_jitter);
    tell(by_sobol);
    std::printf("\n");
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
