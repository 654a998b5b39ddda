// SPDX-License-Identifier: MIT
/// \file
/// What is looked at: a scene of the examples, or that of the host on Embree.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "freqsynth/sampler.h"

namespace live {

/// Light that can be asked for.
class Subject {
 public:
  virtual ~Subject() = default;
  /// Stores linear red, green and blue of each request. Called from several threads.
  virtual void radiance(std::span<const freqsynth::Request> requests,
                        std::span<float> rgb) const = 0;
  /// Whether these are Monte Carlo estimates.
  [[nodiscard]] virtual bool noisy() const = 0;
};

/// The name of the scene of the host on Embree.
inline constexpr const char* embree_name = "embree";

/// A scene by its name.
/// \throws UsageError when there is no such scene, std::runtime_error when a file cannot be read.
[[nodiscard]] std::unique_ptr<Subject> make_subject(const std::string& name, std::size_t width,
                                                    std::size_t height);

/// That of the host on Embree; only where it is built.
[[nodiscard]] std::unique_ptr<Subject> make_embree_subject(std::size_t width, std::size_t height);

}  // namespace live
