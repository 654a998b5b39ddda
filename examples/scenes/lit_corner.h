// SPDX-License-Identifier: MIT
/// \file
/// The `corner` scene.
#pragma once

#include "scene.h"

namespace scenes {

/// A black image (exactly 0) but for a warm quarter of a disc in the bottom right corner, about 1 %
/// of the area: the share of the samples that goes there shows how soon a sampler knows where
/// nothing happens.
class LitCorner final : public Scene {
 public:
  /// `width` and `height` in pixels, both > 0.
  LitCorner(int width, int height);

  void radiance(double x, double y, std::uint64_t id, std::span<float, 3> rgb) const override;
  [[nodiscard]] bool pixel_average(long i, long j, std::span<float, 3> rgb) const override;

 private:
  double width_;
  double height_;
  double radius_;  // pixels
};

}  // namespace scenes
