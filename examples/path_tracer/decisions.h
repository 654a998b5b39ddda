// SPDX-License-Identifier: MIT
/// \file
/// The random decisions of a path.
#pragma once

#include <array>
#include <cstdint>

#include "freqsynth/basis/owen_sobol.h"
#include "scenes/random.h"

namespace path_tracer {

/// Who a sample is: as freqsynth::Request tells it.
struct SampleName {
  std::uint64_t pixel = 0;
  std::uint32_t ordinal = 0;  ///< 0, 1, 2, ... in its pixel
  std::uint64_t seed = 0;     ///< another one for each sample
  std::uint64_t frame = 0;    ///< the same for all samples of a picture
};

/// Where the numbers of decisions come from.
enum class Numbers : std::uint8_t {
  random,  ///< each for itself
  sobol    ///< evenly spread over the samples of a pixel
};

/// Every decision of a path takes a pair of numbers in [0, 1). The same name and decision always
/// give the same pair.
class Decisions {
 public:
  Decisions(Numbers numbers, const SampleName& name) : numbers_(numbers), name_(name) {}

  /// The pair of a decision. Each decision is a dimension pair of its own.
  [[nodiscard]] std::array<double, 2> pair(unsigned decision) const {
    // Deep in a path there is nothing left to spread evenly.
    if (numbers_ == Numbers::sobol && decision < most_spread) {
      const freqsynth::OwenSobol point(name_.pixel, name_.ordinal,
                                       scenes::mix_bits(name_.frame) + decision);
      return {point(0), point(1)};
    }
    scenes::Random random(name_.seed, decision);
    const double first = random.uniform();
    return {first, random.uniform()};
  }

  // The numbers of decisions.
  static constexpr unsigned place_in_pixel = 0;
  static constexpr unsigned place_on_lens = 1;
  static constexpr unsigned time_of_shutter = 2;
  /// What there is to decide where a path meets a surface.
  enum class Bounce : std::uint8_t { light, place_on_light, direction, survival };
  /// The number of a decision at surface number `depth` of the path, from 0.
  static constexpr unsigned at(unsigned depth, Bounce bounce) {
    return 3 + 4 * depth + static_cast<unsigned>(bounce);
  }

 private:
  static constexpr unsigned most_spread = 3 + 4 * 4;

  Numbers numbers_;
  SampleName name_;
};

}  // namespace path_tracer
