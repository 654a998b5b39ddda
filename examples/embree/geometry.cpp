// SPDX-License-Identifier: MIT
#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace embree_host {
namespace {

Vec3 as_vector(const std::array<float, 3>& v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }

[[noreturn]] void fail(RTCError error) {
  throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY
                               ? "Embree: out of memory"
                               : "Embree: error " + std::to_string(error));
}

/// The longest side of the box around all points.
double extent_of(const Model& model) {
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vertex& vertex : model.vertices) {
      least = std::min(least, double{vertex.point[axis]});
      most = std::max(most, double{vertex.point[axis]});
    }
    extent = std::max(extent, most - least);
  }
  return extent;
}

/// For rays that are not alike: neighbours are seldom asked for together.
RTCIntersectContext context_of_any() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  return context;
}

}  // namespace

Geometry::Geometry(Model model)
    : model_(std::move(model)), margin_(1e-6 * extent_of(model_)), device_(rtcNewDevice(nullptr)) {
  if (!device_) fail(rtcGetDeviceError(nullptr));
  scene_.reset(rtcNewScene(device_.get()));
  if (!scene_) fail(rtcGetDeviceError(device_.get()));
  // No ray slips through between two triangles.
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  if (!model_.triangles.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // A copy: Embree reads 16 bytes behind the last vertex of a shared buffer.
    auto* points = static_cast<std::array<float, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(std::array<float, 3>), model_.vertices.size()));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               model_.triangles.data(), 0, sizeof(Triangle),
                               model_.triangles.size());
    if (points != nullptr) {
      std::transform(model_.vertices.begin(), model_.vertices.end(), points,
                     [](const Vertex& vertex) { return vertex.point; });
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_.get(), geometry);
    }
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error != RTC_ERROR_NONE) fail(error);
}

RTCRay Geometry::ray(const Vec3& from, const Vec3& direction) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x);
  ray.org_y = static_cast<float>(from.y);
  ray.org_z = static_cast<float>(from.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

RTCRayHit Geometry::question(const Vec3& from, const Vec3& direction) {
  RTCRayHit question{};
  question.ray = ray(from, direction);
  question.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return question;
}

void Geometry::find(std::span<RTCRayHit> rays) const {
  RTCIntersectContext context = context_of_any();
  rtcIntersect1M(scene(), &context, rays.data(), static_cast<unsigned>(rays.size()),
                 sizeof(RTCRayHit));
}

void Geometry::find(std::span<RTCRay> rays) const {
  RTCIntersectContext context = context_of_any();
  rtcOccluded1M(scene(), &context, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
}

Surface Geometry::surface(const RTCRayHit& ray, double footprint) const {
  const std::size_t triangle = ray.hit.primID;
  const auto& corners = model_.triangles[triangle].corners;
  const Vertex& a = model_.vertices[corners[0]];
  const Vertex& b = model_.vertices[corners[1]];
  const Vertex& c = model_.vertices[corners[2]];
  const double u = double{ray.hit.u}, v = double{ray.hit.v};
  const auto blend = [&](const Vec3& at_a, const Vec3& at_b, const Vec3& at_c) {
    return (1 - u - v) * at_a + u * at_b + v * at_c;
  };
  const Vec3 p = as_vector(a.point), q = as_vector(b.point), r = as_vector(c.point);
  const Vec3 direction{double{ray.ray.dir_x}, double{ray.ray.dir_y}, double{ray.ray.dir_z}};
  const Vec3 area = cross(q - p, r - p);

  Surface surface;
  surface.point = blend(p, q, r);
  surface.face = normalize(area);
  const Vec3 smooth = blend(as_vector(a.normal), as_vector(b.normal), as_vector(c.normal));
  surface.normal = dot(smooth, smooth) > 0 ? normalize(smooth) : surface.face;
  if (dot(surface.normal, surface.face) < 0) surface.normal = -surface.normal;
  const double cosine = -dot(surface.face, direction);
  if (cosine < 0) {
    surface.face = -surface.face;
    surface.normal = -surface.normal;
  }
  const Material& material = model_.materials[model_.material_of[triangle]];
  surface.colour = material.colour;
  if (material.texture) {
    const auto difference = [](const Vertex& from, const Vertex& to, std::size_t i) {
      return double{to.uv[i]} - double{from.uv[i]};
    };
    const double uv_area = std::abs(difference(a, b, 0) * difference(a, c, 1) -
                                    difference(a, b, 1) * difference(a, c, 0));
    // Units of u and v for a unit of length; a footprint is longer where it lies flat.
    const double density = std::sqrt(uv_area / std::max(length(area), 1e-300));
    const double width = footprint * density / std::sqrt(std::max(std::abs(cosine), 1e-3));
    const auto texture_at = [&](std::size_t i) {
      return (1 - u - v) * double{a.uv[i]} + u * double{b.uv[i]} + v * double{c.uv[i]};
    };
    surface.colour = surface.colour *
                     model_.textures[*material.texture].colour(texture_at(0), texture_at(1), width);
  }
  return surface;
}

}  // namespace embree_host
