// SPDX-License-Identifier: MIT
/// \file
/// The list of all systems.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "rendering.h"

namespace baselines {

/// A system with its default settings.
struct Method {
  std::string name;         ///< stable, lower case, with hyphens
  std::string description;  ///< one line
  std::string paper;        ///< authors and year
  std::function<Rendering(const Radiance&, const Job&)> render;
  /// Least samples per pixel that it is made for. It gives a picture below that, too, down to one
  /// sample in all.
  double least_rate = 0;
  /// It is made for Monte Carlo estimates, and measured with these alone.
  bool for_noise = false;
};

/// All systems.
[[nodiscard]] std::span<const Method> methods();

/// The one of these that has the name.
/// \throws std::invalid_argument, naming it and the known ones, when there is none.
[[nodiscard]] const Method& find_method(std::span<const Method> all, std::string_view name);

/// The system of that name; throws as find_method() does.
[[nodiscard]] const Method& method(std::string_view name);

}  // namespace baselines
