// SPDX-License-Identifier: MIT
#include "options.h"

namespace embree_host {

std::optional<Options> parse_options(int argc, const char** argv) {
  Options options;
  SceneOptionReader scene(options.scene);
  CommandLine line("freqsynth_embree: a renderer on Embree as a host of freqsynth", usage_line,
                   options);
  scene.describe(line.parser());
  line.add_size();
  line.add_rate();
  line.add_sampler();
  line.add_frame();
  line.add_threads();
  line.add_channels();
  line.add_checkpoints();
  if (!line.read(argc, argv)) {
    line.print_help();
    return std::nullopt;
  }
  scene.read();
  line.require_output();
  return options;
}

}  // namespace embree_host
