// SPDX-License-Identifier: MIT
/// \file
/// The free parameters of the method: the values of each that freqsynth_tune tries.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "freqsynth/freqsynth.h"

namespace tune {

/// All that a run depends on but the scene.
struct Setup {
  freqsynth::SynthesisSettings synthesis;
  freqsynth::FinishSettings finish;
};

/// All that make_parameters() changes: setups with equal keys give equal pictures.
using Key = std::array<double, 19>;
[[nodiscard]] Key key_of(const Setup& setup);

/// One of the values of a parameter.
struct Value {
  std::string text;
  std::function<void(Setup&)> apply;
};

/// The scenes that a parameter is for: noisy ones have other defaults of their own.
enum class For { all, quiet, noisy };

/// What is moved away from its default.
struct Parameter {
  std::string name;
  For scenes;
  std::vector<Value> values;
  /// Made before any value, and to what the values are compared with.
  std::function<void(Setup&)> base = [](Setup&) {};

  [[nodiscard]] bool concerns(bool noisy) const {
    return scenes == For::all || (scenes == For::noisy) == noisy;
  }
};

/// The table.
[[nodiscard]] std::vector<Parameter> make_parameters();

/// \param value  null: what the values of the parameter are compared with
/// \param size   side of the picture in pixels
[[nodiscard]] Setup setup_of(const Parameter& parameter, const Value* value, std::size_t size);

/// Whether the value changes nothing.
[[nodiscard]] bool is_default(const Parameter& parameter, const Value& value, std::size_t size);

/// A default that has moved away from the values of its parameter must not go unseen.
/// \throws std::logic_error that names a parameter of which not just one value is the default.
void check_defaults(const std::vector<Parameter>& parameters, std::size_t size);

}  // namespace tune
