// SPDX-License-Identifier: MIT
/// \file
/// What is seen and how light falls on it: options of all programs that render with Embree.
#pragma once

#include <OpenImageIO/argparse.h>

#include <cstdint>
#include <optional>
#include <string>

#include "scenes/vec3.h"

namespace embree_host {

using scenes::Vec3;

/// The values of `--obj`, `--eye`, `--target`, `--field`, `--sun-size` and `--light-samples`.
struct SceneOptions {
  std::string obj;                   ///< a file; empty: the colonnade
  std::optional<Vec3> eye, target;   ///< z is up
  std::optional<double> half_field;  ///< tangent of half of what the lesser side shows
  double sun_size = 2;               ///< degrees, in 0..90
  std::uint32_t light_samples = 1;   ///< paths of each sample, in 1..4096
};

/// Has a parser know them, and reads their values.
class SceneOptionReader {
 public:
  /// \param options  receives the values; outlives this
  explicit SceneOptionReader(SceneOptions& options) : options_(options) {}
  SceneOptionReader(const SceneOptionReader&) = delete;
  SceneOptionReader& operator=(const SceneOptionReader&) = delete;

  /// \param with_obj  whether `--obj FILE` is one of them
  void describe(OIIO::ArgParse& parser, bool with_obj = true);
  /// What was parsed. \throws UsageError that names the option and its value.
  void read();
  /// Whether any of them was given.
  [[nodiscard]] bool any() const;

 private:
  SceneOptions& options_;
  std::string eye_, target_, field_, sun_size_, light_samples_;
};

}  // namespace embree_host
