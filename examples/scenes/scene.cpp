// SPDX-License-Identifier: MIT
#include "scene.h"

#include <array>
#include <stdexcept>

#include "checker.h"
#include "chess/chess_scene.h"
#include "depth_of_field.h"
#include "dots.h"
#include "edge.h"
#include "fan.h"
#include "glossy.h"
#include "gradient.h"
#include "image_scene.h"
#include "lit_corner.h"
#include "path_traced.h"
#include "soft_shadow.h"
#include "star.h"
#include "sun.h"
#include "zone_plate.h"

namespace scenes {
namespace {

constexpr std::array<std::string_view, 16> kNames = {
    "fan", "chess",  "zoneplate", "zoneplate-high", "star", "edge",   "checker", "gradient",
    "dot", "corner", "sun",       "softshadow",     "dof",  "glossy", "cornell", "spheres"};
constexpr double kHighZoneFrequency = 0.8;  // cycles per pixel; 0.5 is the limit
constexpr std::string_view kImagePrefix = "image:";

void require_positive(int size, const char* what) {
  if (size <= 0) {
    throw std::invalid_argument("scene " + std::string(what) + " must be positive, but is " +
                                std::to_string(size));
  }
}

}  // namespace

bool Scene::pixel_average(long /*i*/, long /*j*/, std::span<float, 3> /*rgb*/) const {
  return false;
}

std::unique_ptr<Scene> make_scene(const SceneOptions& options) {
  const auto& [name, width, height, zone_frequency, seed] = options;
  require_positive(width, "width");
  require_positive(height, "height");

  if (name == "fan") return std::make_unique<Fan>(width, height);
  if (name == "chess") return std::make_unique<chess::ChessScene>(width, height);
  if (name == "zoneplate") return std::make_unique<ZonePlate>(width, height, zone_frequency);
  if (name == "zoneplate-high") {
    return std::make_unique<ZonePlate>(width, height, kHighZoneFrequency);
  }
  if (name == "star") return std::make_unique<Star>(width, height);
  if (name == "edge") return std::make_unique<Edge>(width, height);
  if (name == "checker") return std::make_unique<Checker>(width, height);
  if (name == "gradient") return std::make_unique<Gradient>(width, height);
  if (name == "dot") return std::make_unique<Dots>(width, height);
  if (name == "corner") return std::make_unique<LitCorner>(width, height);
  if (name == "sun") return std::make_unique<Sun>(width, height);
  if (name == "softshadow") return std::make_unique<SoftShadow>(width, height, seed);
  if (name == "dof") return std::make_unique<DepthOfField>(width, height, seed);
  if (name == "glossy") return std::make_unique<Glossy>(width, height, seed);
  if (name == "cornell" || name == "spheres") {
    return std::make_unique<PathTraced>(name, width, height, seed);
  }
  if (name.starts_with(kImagePrefix) && name.size() > kImagePrefix.size()) {
    return std::make_unique<ImageScene>(name.substr(kImagePrefix.size()), width, height);
  }
  throw std::invalid_argument("unknown scene '" + name + "' (known are " + scene_list() + ")");
}

std::span<const std::string_view> scene_names() { return kNames; }

std::string scene_list() {
  std::string list;
  for (const std::string_view name : kNames) list.append(name).append(", ");
  return list.append(kImagePrefix).append("FILE");
}

}  // namespace scenes
