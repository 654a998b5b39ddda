// SPDX-License-Identifier: MIT
/// \file
/// The same picture by the interface for C and in C++.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "c/host.h"
#include "freqsynth/freqsynth.h"

namespace freqsynth::helpers {

inline constexpr std::size_t width = 60, height = 45;

/// The radiance of the host in C, of any number of channels.
inline void sample(std::span<const Request> requests, std::span<float> values) {
  const std::size_t channels = requests.empty() ? 0 : values.size() / requests.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Request& request = requests[i / channels];
    values[i] = host_radiance(request.x, request.y, i % channels);
  }
}

/// An engine in C, which it destroys.
struct Engine {
  freqsynth_synthesizer* handle;
  explicit Engine(freqsynth_synthesizer* engine) : handle(engine) {}
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  ~Engine() { freqsynth_synthesizer_destroy(handle); }
};

inline freqsynth_settings c_settings(std::size_t channels) {
  freqsynth_settings settings;
  freqsynth_settings_init(&settings, sizeof settings);
  settings.width = width;
  settings.height = height;
  settings.channels = channels;
  return settings;
}

inline SynthesisSettings cxx_settings(std::size_t channels) {
  SynthesisSettings settings;
  settings.width = width;
  settings.height = height;
  settings.channels = channels;
  return settings;
}

/// The finished picture of an engine in C.
inline std::vector<float> picture(const freqsynth_synthesizer* engine, std::size_t channels,
                                  const freqsynth_finish_settings* finish = nullptr,
                                  const freqsynth_reconstruction_settings* how = nullptr) {
  std::vector<float> pixels(width * height * channels);
  const freqsynth_pixels view = {pixels.data(), width, height, 0, 0, 0};
  EXPECT_EQ(freqsynth_finish(engine, finish, how, &view), FREQSYNTH_OK) << freqsynth_last_error();
  return pixels;
}

inline std::vector<float> render_in_c(const freqsynth_settings& settings,
                                      const freqsynth_stop_rule& rule) {
  const Engine engine(host_render(&settings, &rule, HOST_RUN_SERIAL));
  if (engine.handle == nullptr) return {};
  return picture(engine.handle, settings.channels);
}

inline std::vector<float> render_in_cxx(const SynthesisSettings& settings, const StopRule& rule) {
  Synthesizer engine(settings);
  engine.run(sample, rule);
  return reconstruct(engine.finished_image());
}

inline freqsynth_stop_rule c_rule(std::uint64_t samples) {
  freqsynth_stop_rule rule;
  freqsynth_stop_rule_init(&rule, sizeof rule);
  rule.samples = samples;
  return rule;
}

/// A change of settings in either language.
template <class InC, class InCxx>
struct Setting {
  const char* name;
  std::function<void(InC&)> c;
  std::function<void(InCxx&)> cxx;

  /// One for which both languages have the same words.
  template <class Set>
  static Setting of_both(const char* name, Set set) {
    return {name, set, set};
  }
};

/// Checks that each setting makes the same of a picture in both languages, and not nothing.
/// \param c, cxx              settings that are changed
/// \param in_c, in_cxx        make the picture of settings
template <class InC, class InCxx, class MakeInC, class MakeInCxx>
void expect_that_all_arrive(const std::vector<Setting<InC, InCxx>>& all, const InC& c,
                            const InCxx& cxx, MakeInC in_c, MakeInCxx in_cxx) {
  const std::vector<float> usual = in_c(c);
  EXPECT_EQ(usual, in_cxx(cxx));
  for (const Setting<InC, InCxx>& one : all) {
    InC changed = c;
    InCxx same = cxx;
    one.c(changed);
    one.cxx(same);
    const std::vector<float> pixels = in_c(changed);
    EXPECT_EQ(pixels, in_cxx(same)) << one.name;
    EXPECT_NE(pixels, usual) << one.name << " makes no difference";
  }
}

}  // namespace freqsynth::helpers
