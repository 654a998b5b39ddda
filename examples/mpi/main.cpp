// SPDX-License-Identifier: MIT
// Renders a scene on many machines: rank 0 owns the engine, the others trace what it asks for.

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/channel_file.h"
#include "common/checkpoint.h"
#include "common/interrupt.h"
#include "common/option_values.h"
#include "common/output_file.h"
#include "common/picture.h"
#include "common/progress_bar.h"
#include "cpu_clock.h"
#include "figures.h"
#include "freqsynth/engine/thread_pool.h"
#include "freqsynth/freqsynth.h"
#include "job.h"
#include "leader.h"
#include "mail.h"
#include "options.h"
#include "tracing.h"
#include "window_plan.h"
#include "window_state.h"
#include "windows.h"

namespace {

using farm::Job;
using farm::Options;

/// What rank 0 does.
class Run {
 public:
  Run(Job& job, farm::Mail& mail)
      : job_(job), leader_(mail, job.works(), job.pool(), farm::PacketSettings{}) {}

  /// \return whether it came to its end, and was not interrupted
  bool operator()() {
    const Options& options = job_.options();
    check_picture(options.output, options.width, options.height, 3);
    for (const std::string& file : {options.stats, options.checkpoint}) {
      if (!file.empty()) check_writable(file);
    }
    const bool ended = options.columns != 0 ? in_windows() : with_one_engine();
    if (picture_.pixels.empty()) {
      std::fprintf(stderr, "freqsynth_mpi: too early for a picture\n");
    } else {
      write();
    }
    tell();
    return ended;
  }

 private:
  static constexpr double coarse_share = 0.05;  // of the progress, with windows

  bool with_one_engine() {
    const Options& options = job_.options();
    freqsynth::Synthesizer engine = make_engine(options.resume, job_.settings(Job::picture));
    Checkpoint checkpoint("freqsynth_mpi", options.checkpoint, options.checkpoint_every);
    const auto reason = run(engine, Job::picture, [&](const freqsynth::Progress& now) {
      checkpoint.keep_when_due(engine);
      return show(now.fraction, now.seconds_left);
    });
    checkpoint.keep(engine);
    samples_ = engine.stats().samples;
    waves_ = engine.stats().waves;
    if (waves_ > 0) {
      const farm::CpuClock clock(leader_.figures().finishing);
      picture_.pixels = job_.subject().finish(engine, job_.pool());
    }
    return reason != freqsynth::StopReason::cancelled;
  }

  bool in_windows() {
    const Options& options = job_.options();
    farm::WindowState state;
    const std::string what = farm::picture_of(options);
    if (!options.resume.empty()) {
      state = farm::load_windows(options.resume, what, picture_);
    } else if (!plan_windows(state)) {
      return false;
    }
    Checkpoint checkpoint("freqsynth_mpi", options.checkpoint, options.checkpoint_every);
    const auto keep = [&] {
      checkpoint.keep_by([&](const std::string& file) { farm::save_windows(file, what, state); });
    };
    farm::WindowLeader windows_leader(leader_, state);
    const bool ended = windows_leader.run(
        {job_.settings(Job::picture), job_.works()[Job::picture].sample, job_.subject().finish},
        job_.pool(), [&](double share) {
          if (checkpoint.is_due()) keep();
          return show(coarse_share + (1 - coarse_share) * share);
        });
    keep();
    samples_ = std::accumulate(state.taken.begin(), state.taken.end(), state.coarse);
    picture_ = std::move(state.picture);
    return ended;
  }

  /// MPI counts the bytes of a letter by int.
  void check_letter(const freqsynth::PixelWindow& window) const {
    constexpr std::size_t most = std::numeric_limits<int>::max() / sizeof(float) - 16;
    if (window.width * window.height <= most / picture_.channels) return;
    throw std::runtime_error("--windows: one of " + std::to_string(window.width) + " x " +
                             std::to_string(window.height) +
                             " pixels is no letter of 2 GB; cut into more");
  }

  /// Shares the samples out. \return whether it was not interrupted
  bool plan_windows(farm::WindowState& state) {
    const Options& options = job_.options();
    const auto windows =
        farm::cut_windows(options.width, options.height, options.columns, options.rows);
    for (const auto& window : windows) check_letter(window);
    std::vector<farm::WindowTask> tasks;
    std::uint64_t taken = 0;
    if (options.uniform != 0) {
      for (const auto& window : windows) tasks.push_back({window, farm::WindowTask::no_limit});
    } else {
      freqsynth::Synthesizer coarse(job_.settings(Job::coarse_picture));
      const auto reason = run(coarse, Job::coarse_picture, [&](const freqsynth::Progress& now) {
        return show(coarse_share * now.fraction);
      });
      if (reason == freqsynth::StopReason::cancelled) return false;
      taken = coarse.stats().samples;
      const std::uint64_t all = stop().most_samples(options.width, options.height);
      tasks = farm::share_out(windows, coarse.image(), job_.step(), all - std::min(all, taken));
    }
    state = {std::move(tasks), taken, picture_};
    return true;
  }

  [[nodiscard]] freqsynth::StopRule stop() const {
    return {.samples_per_pixel = job_.options().samples_per_pixel};
  }

  freqsynth::StopReason run(freqsynth::Synthesizer& engine, std::size_t work,
                            const farm::ProgressFunction& progress) {
    const auto reason = leader_.run(engine, stop(), work, progress);
    if (reason == freqsynth::StopReason::unusable) {
      throw std::runtime_error("not one sample of the scene is a finite number");
    }
    return reason;
  }

  bool show(double share, double seconds_left = std::numeric_limits<double>::infinity()) {
    bar_.show(share, seconds_left);
    return noted_interrupt() == 0;
  }

  void write() const {
    const std::string& file = job_.options().output;
    if (picture_.channels == 3) return write_picture(file, picture_);
    write_channels(file,
                   {picture_.width, picture_.height, job_.subject().channels, picture_.pixels});
  }

  void tell() {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
    const farm::RunFigures figures{
        job_.options(),   samples_, waves_, seconds.count(), job_.works()[Job::picture].format,
        leader_.figures()};
    if (!job_.options().stats.empty()) write_text(job_.options().stats, farm::as_json(figures));
    std::printf("%s: %s\n", job_.options().output.c_str(), farm::as_text(figures).c_str());
  }

  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  Job& job_;
  farm::Leader leader_;
  ProgressBar bar_;
  Picture picture_{job_.options().width, job_.options().height, job_.subject().channels.size(), {}};
  std::uint64_t samples_ = 0, waves_ = 0;
};

/// What the others do. What goes wrong beside tracing, as memory that runs out, ends all.
void serve_or_abort(Job& job, farm::Mail& mail) {
  try {
    const farm::WindowJob windows{job.settings(Job::picture), job.works()[Job::picture].sample,
                                  job.subject().finish};
    farm::serve(mail, job.works(), job.pool(), [&](farm::Letter& letter) {
      farm::answer_window(mail, letter, windows, job.pool(),
                          [](double) { return noted_interrupt() == 0; });
    });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_mpi: rank %d: %s\n", mail.rank(), error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
}

/// The job, when all ranks have one; each tells its own error.
std::unique_ptr<Job> make_job(const Options& options, int rank) {
  std::unique_ptr<Job> job;
  std::exception_ptr error;
  try {
    job = std::make_unique<Job>(options, rank);
  } catch (...) {
    error = std::current_exception();
  }
  int good = error ? 0 : 1;
  MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (error) std::rethrow_exception(error);
  if (good == 0) throw std::runtime_error("another rank failed");
  return job;
}

int run(int argc, const char** argv) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    const std::optional<Options> options = farm::parse_options(argc, argv, rank == 0);
    if (!options) return 0;
    note_interrupts();
    const std::unique_ptr<Job> job = make_job(*options, rank);
    farm::Mail mail(MPI_COMM_WORLD);
    if (rank != 0) {
      serve_or_abort(*job, mail);
      return 0;
    }
    if (Run(*job, mail)()) return 0;
    std::fprintf(stderr, "freqsynth_mpi: interrupted; what there was is written\n");
    return 128 + noted_interrupt();
  } catch (const UsageError& error) {
    if (rank == 0)
      std::fprintf(stderr, "freqsynth_mpi: %s\nusage: %s\n", error.what(), farm::usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_mpi: rank %d: %s\n", rank, error.what());
    return 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);
  std::vector<const char*> arguments(argv, argv + argc);
  const int code = run(argc, arguments.data());
  MPI_Finalize();
  return code;
}
