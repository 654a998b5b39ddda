// SPDX-License-Identifier: MIT
/// \file
/// The error of pictures made with each value of each parameter.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "freqsynth/engine/thread_pool.h"
#include "quality/tune_parameters.h"
#include "scenes/scene.h"

namespace tune {

inline constexpr std::array rates{0.25, 1.0, 4.0};  ///< samples per pixel

/// Names of scenes: to choose by, and to check with.
[[nodiscard]] const std::array<std::vector<std::string>, 2>& halves();

/// What the user asked for.
struct Options {
  std::size_t size = 128;       ///< side of the pictures in pixels
  std::size_t reference = 256;  ///< samples per pixel
  std::vector<Parameter> parameters;
  bool list = false;
};

/// A scene and what is known to be right.
struct Subject {
  std::size_t half;  ///< place in halves()
  std::unique_ptr<scenes::Scene> scene;
  std::vector<float> reference;
};

/// RMSE at each of the rates.
using Errors = std::array<double, rates.size()>;

/// The errors of every setup of every subject.
using Measured = std::map<std::pair<const Subject*, Key>, Errors>;

/// The scenes that any of the wanted parameters is for.
[[nodiscard]] std::vector<Subject> make_subjects(const Options& options,
                                                 freqsynth::ThreadPool& pool);

/// Every setup of every subject, measured once, whoever asks for it. The keys point to the
/// subjects.
/// \throws std::runtime_error with what went wrong in any of the runs.
[[nodiscard]] Measured measure_all(const Options& options, const std::vector<Subject>& subjects,
                                   freqsynth::ThreadPool& pool);

/// Geometric mean of RMSE / RMSE with defaults, over the rates and the scenes of a half.
[[nodiscard]] double ratio_of(const Parameter& parameter, const Value& value, std::size_t half,
                              const Options& options, const std::vector<Subject>& subjects,
                              const Measured& measured);

}  // namespace tune
