#include "scene.h"

#include <array>
#include <stdexcept>

#include "chess/chess_scene.h"
#include "fan.h"
#include "image_scene.h"
#include "zone_plate.h"

namespace scenes {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"fan", "chess", "zoneplate"};
constexpr std::string_view kImagePrefix = "image:";

void require_positive(int size, const char* what) {
  if (size <= 0) {
    throw std::invalid_argument("scene " + std::string(what) + " must be positive, but is " +
                                std::to_string(size));
  }
}

}  // namespace

std::unique_ptr<Scene> make_scene(const SceneOptions& options) {
  const auto& [name, width, height, zone_frequency] = options;
  require_positive(width, "width");
  require_positive(height, "height");

  if (name == "fan") return std::make_unique<Fan>(width, height);
  if (name == "chess") return std::make_unique<chess::ChessScene>(width, height);
  if (name == "zoneplate") return std::make_unique<ZonePlate>(width, height, zone_frequency);
  if (name.starts_with(kImagePrefix) && name.size() > kImagePrefix.size()) {
    return std::make_unique<ImageScene>(name.substr(kImagePrefix.size()), width, height);
  }
  std::string known;
  for (const std::string_view each : kNames) known.append(each).append(", ");
  throw std::invalid_argument("unknown scene '" + name + "' (known are " + known + "image:FILE)");
}

std::span<const std::string_view> scene_names() { return kNames; }

}  // namespace scenes
