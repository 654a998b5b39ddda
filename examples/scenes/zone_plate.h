// SPDX-License-Identifier: MIT
/// \file
/// The `zoneplate` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// Concentric cosine rings, 0.5 + 0.5 cos(phase), centred at the top left corner of the image.
///
/// The phase is pi f r^2 / R, where r is the distance in pixels from that corner and R that of the
/// opposite corner. The local frequency, f r / R cycles per pixel, so grows linearly and reaches f
/// at the opposite corner. A corner rather than the middle, because then no two parts of the image
/// are mirror images of each other.
class ZonePlate final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0; `frequency` is f, finite and >= 0. Throws
  /// std::invalid_argument for another frequency.
  ZonePlate(int width, int height, double frequency);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double phase_scale_;  // phase per squared pixel
};

}  // namespace scenes
