// SPDX-License-Identifier: MIT
/// \file
/// A model in Embree's hands.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <span>
#include <type_traits>

#include "model.h"

namespace embree_host {

/// Where a ray meets a surface.
struct Surface {
  Vec3 point;
  Vec3 normal;  ///< smooth, on the ray's side; unit length
  Vec3 face;    ///< of the triangle, on the ray's side; unit length
  Vec3 colour;  ///< share of the light that is scattered
};

/// Triangles that Embree finds. Members may be called from several threads at the same time.
class Geometry {
 public:
  /// \throws std::runtime_error with Embree's reason.
  explicit Geometry(Model model);

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] RTCScene scene() const { return scene_.get(); }
  /// Distance that is nothing: rays that leave a surface start that far above it.
  [[nodiscard]] double margin() const { return margin_; }

  /// A ray from a point in a direction of unit length.
  [[nodiscard]] static RTCRay ray(const Vec3& from, const Vec3& direction);
  /// The same, to ask what it meets.
  [[nodiscard]] static RTCRayHit question(const Vec3& from, const Vec3& direction);
  [[nodiscard]] static bool met(const RTCRayHit& ray) {
    return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  /// What the rays meet first, by Embree's packets. What a ray meets does not depend on the others.
  void find(std::span<RTCRayHit> rays) const;
  /// Whether they meet anything: tfar of those that do is below 0.
  void find(std::span<RTCRay> rays) const;

  /// The surface that a ray has met.
  /// \param footprint  width of what is to be averaged of its texture, at right angles to the ray
  [[nodiscard]] Surface surface(const RTCRayHit& ray, double footprint) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  Model model_;
  double margin_ = 0;
  std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

}  // namespace embree_host
