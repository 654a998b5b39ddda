// SPDX-License-Identifier: MIT
// Embree finds the triangles that a loop over all of them finds, alone and in packets.

#include "embree/geometry.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scenes/random.h"

namespace embree_host {
namespace {

Vec3 place_of(const Vertex& vertex) {
  const auto& [x, y, z] = vertex.point;
  return {double{x}, double{y}, double{z}};
}

/// Some curved surfaces, close to each other.
Model tangle() {
  Model model;
  model.materials = {{{0.5, 0.4, 0.3}, {}}};
  for (int i = 0; i < 3; ++i) {
    model.add_surface(30, 14, {1, 1}, 0, [&](double s, double t) {
      const double around = 6.283185307179586 * s, tube = 6.283185307179586 * t;
      const double wide = 1 + 0.35 * std::cos(tube) + 0.1 * std::sin(5 * around);
      return Vec3{wide * std::cos(around) + 0.6 * i, wide * std::sin(around),
                  0.35 * std::sin(tube) + 0.3 * i};
    });
  }
  model.add_box({-2, -2, -1.5}, {3, 2, -1}, 1, 0);
  return model;
}

/// Rays from all around, most of them towards the middle.
std::vector<RTCRayHit> rays_of(std::size_t count) {
  std::vector<RTCRayHit> rays;
  scenes::Random random(3, 0);
  const auto vector = [&] {
    return Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 from = 8 * vector();
    rays.push_back(Geometry::question(from, normalize(3 * vector() - from)));
  }
  return rays;
}

/// The crossing of a ray and a triangle, by Cramer's rule in double.
struct Crossing {
  double distance = std::numeric_limits<double>::infinity();
  double margin = 0;  ///< of the barycentric coordinates: how far within the triangle, or outside
};
Crossing crossing_of(const Model& model, const Triangle& triangle, const RTCRay& ray) {
  const Vec3 from{double{ray.org_x}, double{ray.org_y}, double{ray.org_z}};
  const Vec3 along{double{ray.dir_x}, double{ray.dir_y}, double{ray.dir_z}};
  const Vec3 a = place_of(model.vertices[triangle.corners[0]]);
  const Vec3 p = place_of(model.vertices[triangle.corners[1]]) - a;
  const Vec3 q = place_of(model.vertices[triangle.corners[2]]) - a;
  const double volume = dot(cross(p, q), -along);
  const Vec3 to = from - a;
  const double u = dot(cross(to, q), -along) / volume;
  const double v = dot(cross(p, to), -along) / volume;
  const double distance = dot(cross(p, q), to) / volume;
  return {distance, std::min({u, v, 1 - u - v})};
}

TEST(EmbreeGeometry, FindsWhatALoopOverAllTrianglesFinds) {
  const Geometry geometry(tangle());
  const Model& model = geometry.model();
  std::vector<RTCRayHit> rays = rays_of(4000);
  geometry.find(rays);
  int met = 0, doubtful = 0;
  for (const RTCRayHit& ray : rays) {
    double nearest = std::numeric_limits<double>::infinity(), surely = nearest;
    for (const Triangle& triangle : model.triangles) {
      const auto [distance, margin] = crossing_of(model, triangle, ray.ray);
      if (!(distance > 0)) continue;
      if (margin >= -1e-4) nearest = std::min(nearest, distance);
      if (margin >= 1e-4) surely = std::min(surely, distance);
    }
    // On an edge rounding decides.
    if (surely != nearest) {
      ++doubtful;
      continue;
    }
    ASSERT_EQ(Geometry::met(ray), std::isfinite(nearest));
    if (!Geometry::met(ray)) continue;
    ++met;
    ASSERT_NEAR(double{ray.ray.tfar}, nearest, 2e-5);
    const Surface surface = geometry.surface(ray, 0);
    const Vec3 along{double{ray.ray.dir_x}, double{ray.ray.dir_y}, double{ray.ray.dir_z}};
    const Vec3 from{double{ray.ray.org_x}, double{ray.ray.org_y}, double{ray.ray.org_z}};
    EXPECT_NEAR(length(surface.point - (from + nearest * along)), 0, 2e-5);
    EXPECT_LE(dot(surface.face, along), 0) << "on the ray's side";
    EXPECT_GT(dot(surface.normal, surface.face), 0);
    EXPECT_NEAR(length(surface.normal), 1, 1e-12);
    EXPECT_EQ(surface.colour.x, 0.5);
  }
  EXPECT_GT(met, 1500);
  EXPECT_LT(doubtful, 100);
}

TEST(EmbreeGeometry, PacketsSayTheSameAsSingleRaysToTheBit) {
  View view;
  const Geometry geometry(make_colonnade(view));
  std::vector<RTCRayHit> questions;
  for (RTCRayHit ray : rays_of(20000)) {
    ray.ray.org_z += 4;
    questions.push_back(ray);
  }
  std::vector<RTCRayHit> single = questions;
  std::vector<char> hidden;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  int met = 0;
  for (RTCRayHit& ray : single) {
    RTCRay shadow = ray.ray;
    rtcIntersect1(geometry.scene(), &context, &ray);
    rtcOccluded1(geometry.scene(), &context, &shadow);
    hidden.push_back(shadow.tfar < 0);
    met += Geometry::met(ray);
    ASSERT_EQ(Geometry::met(ray), hidden.back() != 0);
  }
  EXPECT_GT(met, 10000);
  for (const std::size_t size : {questions.size(), std::size_t{1}, std::size_t{7}}) {
    std::vector<RTCRayHit> rays = questions;
    std::vector<RTCRay> shadows;
    for (const RTCRayHit& ray : rays) shadows.push_back(ray.ray);
    for (std::size_t first = 0; first < rays.size(); first += size) {
      const std::size_t count = std::min(size, rays.size() - first);
      geometry.find(std::span(rays).subspan(first, count));
      geometry.find(std::span(shadows).subspan(first, count));
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(rays[i].hit.geomID, single[i].hit.geomID) << size << ", ray " << i;
      ASSERT_EQ(shadows[i].tfar < 0, hidden[i] != 0) << size << ", ray " << i;
      if (!Geometry::met(rays[i])) continue;
      ASSERT_EQ(rays[i].hit.primID, single[i].hit.primID);
      ASSERT_EQ(rays[i].ray.tfar, single[i].ray.tfar);
      ASSERT_EQ(rays[i].hit.u, single[i].hit.u);
      ASSERT_EQ(rays[i].hit.v, single[i].hit.v);
    }
  }
}

TEST(EmbreeGeometry, NoRaySlipsThroughASurfaceThatIsClosed) {
  Model model;
  model.materials = {{}};
  model.add_surface(40, 20, {1, 1}, 0, [](double s, double t) {
    const double round = std::sin(3.141592653589793 * t), angle = 6.283185307179586 * s;
    return Vec3{round * std::cos(angle), round * std::sin(angle), -std::cos(3.141592653589793 * t)};
  });
  const Geometry geometry(std::move(model));
  // Through corners and along edges as well.
  std::vector<RTCRay> rays;
  for (const Vertex& vertex : geometry.model().vertices) {
    rays.push_back(Geometry::ray({0, 0, 0}, normalize(place_of(vertex))));
  }
  geometry.find(rays);
  std::size_t slipped = 0;
  for (const RTCRay& ray : rays) slipped += ray.tfar >= 0;
  EXPECT_EQ(slipped, 0u);
}

TEST(EmbreeGeometry, BearsAModelWithoutTriangles) {
  const Geometry geometry(Model{});
  std::vector<RTCRayHit> rays = rays_of(10);
  geometry.find(rays);
  for (const RTCRayHit& ray : rays) EXPECT_FALSE(Geometry::met(ray));
  geometry.find(std::span<RTCRayHit>());
}

}  // namespace
}  // namespace embree_host
