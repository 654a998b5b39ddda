// SPDX-License-Identifier: MIT
/// \file
/// Options that several programs have: one name, one range and one help text each.
#pragma once

#include <OpenImageIO/argparse.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "option_values.h"

/// Their values; what a program sets before they are read holds where they are not given.
struct SharedOptions {
  std::size_t width = 512;            ///< pixels, 1..65536
  std::size_t height = 512;           ///< pixels, 1..65536
  double samples_per_pixel = 1;       ///< > 0
  std::string sampler = "freqsynth";  ///< or, plainly, jittered or sobol
  std::string output;                 ///< a file
  std::string stats;                  ///< a file; empty: not wanted
  std::size_t wave = 0;               ///< blocks; 0: the library's choice
  std::uint64_t seed = 0;             ///< of the random choices
  std::uint64_t frame = 0;            ///< pictures of other frames have other noise
  std::size_t threads = 0;            ///< 1..1024; 0: all
  std::string checkpoint;             ///< a file for the state of the run; empty: not wanted
  double checkpoint_every = 60;       ///< seconds, > 0
  std::string resume;                 ///< a file to go on from; empty: from the beginning
};

/// A command line with some of these options, and the program's own. Options are described in the
/// order in which the help is to list them; --help comes first.
class CommandLine {
 public:
  /// \param intro    what the program is
  /// \param usage    one line that shows the options that are always needed
  /// \param options  receives the values; outlives this
  CommandLine(const char* intro, const char* usage, SharedOptions& options);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// For the options that are the program's own.
  [[nodiscard]] OIIO::ArgParse& parser() { return parser_; }

  void add_size();         ///< --size WxH
  void add_rate();         ///< --spp N
  void add_sampler();      ///< --sampler NAME
  void add_output();       ///< -o FILE, of colours
  void add_channels();     ///< -o FILE, which has other channels as well where it is EXR
  void add_stats();        ///< --stats FILE
  void add_wave();         ///< --wave N
  void add_seed();         ///< --seed N
  void add_frame();        ///< --frame N
  void add_threads();      ///< --threads N
  void add_checkpoints();  ///< --checkpoint FILE, --checkpoint-every SECONDS, --resume FILE

  /// Parses, and reads the values of the options that were added.
  /// \return false when help was asked for: nothing is read then
  /// \throws UsageError that names the option and its value.
  [[nodiscard]] bool read(int argc, const char** argv);
  void print_help() const { parser_.print_help(); }

  /// Whether --spp was given.
  [[nodiscard]] bool has_rate() const { return !spp_.empty(); }
  /// Whether the run is to be kept, or goes on from one that was.
  [[nodiscard]] bool is_long_run() const;
  /// \throws UsageError where there is no -o.
  void require_output() const;

 private:
  void read_sampler() const;

  OIIO::ArgParse parser_;
  SharedOptions& options_;
  bool help_ = false;
  // As they were given; empty: not given.
  std::string size_, spp_, wave_, seed_, frame_, threads_, checkpoint_every_;
};
