// SPDX-License-Identifier: MIT
#include "scene_options.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "common/option_values.h"

namespace embree_host {
namespace {

/// X,Y,Z
void read_place(std::string_view option, const std::string& text, std::optional<Vec3>& place) {
  if (text.empty()) return;
  std::array<double, 3> values{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2) ||
        !read_all(rest.substr(0, comma), values[i]) || !(std::abs(values[i]) < 1e9)) {
      refuse(option, text, "three numbers X,Y,Z");
    }
    rest.remove_prefix(i == 2 ? rest.size() : comma + 1);
  }
  place = {values[0], values[1], values[2]};
}

}  // namespace

void SceneOptionReader::describe(OIIO::ArgParse& parser, bool with_obj) {
  if (with_obj) {
    parser.arg("--obj %s:FILE", &options_.obj)
        .help("A Wavefront OBJ file, y up, with its materials (a colonnade of 100,000 triangles)");
  }
  parser.arg("--eye %s:X,Y,Z", &eye_).help("Where the camera is; z is up");
  parser.arg("--target %s:X,Y,Z", &target_).help("What it looks at");
  parser.arg("--field %s:A", &field_).help("Degrees that the lesser side shows");
  parser.arg("--sun-size %s:A", &sun_size_).help("Degrees that the sun fills (2)");
  parser.arg("--light-samples %s:N", &light_samples_)
      .help("Paths from what each sample sees, to the sun and to the sky (1)");
}

void SceneOptionReader::read() {
  read_count<std::uint32_t>("--light-samples", light_samples_, 1, options_.light_samples);
  if (options_.light_samples > 4096) refuse("--light-samples", light_samples_, "in 1..4096");
  read_place("--eye", eye_, options_.eye);
  read_place("--target", target_, options_.target);
  read_positive("--sun-size", sun_size_, options_.sun_size);
  if (options_.sun_size > 90) refuse("--sun-size", sun_size_, "at most 90");
  if (!field_.empty()) {
    double field = 0;
    read_positive("--field", field_, field);
    if (field > 170) refuse("--field", field_, "at most 170");
    options_.half_field = std::tan(field * std::numbers::pi / 360);
  }
}

bool SceneOptionReader::any() const {
  return !(options_.obj.empty() && eye_.empty() && target_.empty() && field_.empty() &&
           sun_size_.empty() && light_samples_.empty());
}

}  // namespace embree_host
