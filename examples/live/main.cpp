// SPDX-License-Identifier: MIT
// Renders a scene while browsers show it, and let themselves be pointed at.

#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>

#include "common/interrupt.h"
#include "common/option_values.h"
#include "common/output_file.h"
#include "common/picture.h"
#include "measure.h"
#include "options.h"
#include "server.h"
#include "session.h"
#include "subject.h"

namespace {

using namespace live;

void check_outputs(const Options& options) {
  check_jpeg_size(options.jpeg_file(), options.width, options.height);
  check_writable(options.jpeg_file());
  check_picture(options.exr_file(), options.width, options.height, 3);
  check_writable(options.state_file());
}

/// \return the exit code
int serve(const Options& options) {
  check_outputs(options);
  const std::unique_ptr<Subject> subject =
      make_subject(options.scene, options.width, options.height);
  Session session(options, *subject);
  note_interrupts();
  Server server(session);
  const bool v6 = options.host.find(':') != std::string::npos;
  std::printf("http://%s:%u/\n", v6 ? ("[" + options.host + "]").c_str() : options.host.c_str(),
              server.port());
  std::fflush(stdout);
  if (options.host != Options{}.host) {
    std::fprintf(stderr, "freqsynth_live: all who reach this address can look, point and store\n");
  }
  session.run([] { return noted_interrupt() == 0; });
  if (!session.board().newest()) {
    std::fprintf(stderr, "freqsynth_live: too early for a picture\n");
    return 0;
  }
  for (const std::string& name : session.store()) std::printf("%s\n", name.c_str());
  return 0;
}

}  // namespace

int main(int argc, const char** argv) {
  try {
    const std::optional<Options> options = parse_options(argc, argv);
    if (!options) return 0;
    return options->measure > 0 ? measure(*options) : serve(*options);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "freqsynth_live: %s\nusage: %s\n", error.what(), usage_line);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "freqsynth_live: %s\n", error.what());
    return 1;
  }
}
