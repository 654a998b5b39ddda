// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "model.h"

#ifdef EMBREE_HOST_HAS_TINYOBJ
#include <tiny_obj_loader.h>
#endif

namespace embree_host {

#ifdef EMBREE_HOST_HAS_TINYOBJ

namespace {

[[noreturn]] void fail(const std::string& file, std::string reason) {
  while (!reason.empty() && reason.back() == '\n') reason.pop_back();
  throw std::runtime_error(file + ": " + reason);
}

/// y is up in the file, z here.
std::array<float, 3> upright(const std::vector<float>& values, int index) {
  const std::size_t first = 3 * static_cast<std::size_t>(index);
  return {values[first], -values[first + 2], values[first + 1]};
}

void read_materials(const tinyobj::ObjReader& reader, const std::filesystem::path& folder,
                    Model& model) {
  std::map<std::string, std::size_t> read;
  for (const tinyobj::material_t& given : reader.GetMaterials()) {
    Material material{
        {double{given.diffuse[0]}, double{given.diffuse[1]}, double{given.diffuse[2]}}, {}};
    if (std::string name = given.diffuse_texname; !name.empty()) {
      std::replace(name.begin(), name.end(), '\\', '/');
      const auto [place, is_new] = read.try_emplace(name, model.textures.size());
      if (is_new) model.textures.push_back(read_texture((folder / name).string()));
      material.texture = place->second;
      // Many files have a black Kd beside a picture, which they do not mean.
      if (dot(material.colour, material.colour) == 0) material.colour = {1, 1, 1};
    }
    model.materials.push_back(material);
  }
  model.materials.emplace_back();  // of triangles without one
}

/// From a corner above, so that the whole box is seen.
View view_of(const Model& model) {
  Vec3 least{1e30, 1e30, 1e30}, most{-1e30, -1e30, -1e30};
  for (const Vertex& vertex : model.vertices) {
    const auto& [x, y, z] = vertex.point;
    least = {std::fmin(least.x, x), std::fmin(least.y, y), std::fmin(least.z, z)};
    most = {std::fmax(most.x, x), std::fmax(most.y, y), std::fmax(most.z, z)};
  }
  View view;
  view.target = 0.5 * (least + most);
  const double radius = std::fmax(0.5 * length(most - least), 1e-6);
  view.eye = view.target +
             1.05 * radius * std::hypot(1, 1 / view.half_field) * normalize(Vec3{-0.5, -1, 0.5});
  return view;
}

}  // namespace

Model read_obj(const std::string& file, View& view) {
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(file)) {
    fail(file, reader.Error().empty() ? "cannot be read" : reader.Error());
  }
  Model model;
  read_materials(reader, std::filesystem::path(file).parent_path(), model);
  const tinyobj::attrib_t& attributes = reader.GetAttrib();
  const std::size_t points = attributes.vertices.size() / 3;
  const std::size_t normals = attributes.normals.size() / 3;
  const std::size_t places = attributes.texcoords.size() / 2;
  std::map<std::tuple<int, int, int>, std::uint32_t> known;
  const auto vertex_of = [&](const tinyobj::index_t& index) {
    const auto [place, is_new] =
        known.try_emplace({index.vertex_index, index.normal_index, index.texcoord_index},
                          static_cast<std::uint32_t>(model.vertices.size()));
    if (!is_new) return place->second;
    const auto has = [](int i, std::size_t count) {
      return i >= 0 && static_cast<std::size_t>(i) < count;
    };
    if (!has(index.vertex_index, points)) fail(file, "a face has a vertex that is not there");
    Vertex vertex{upright(attributes.vertices, index.vertex_index), {}, {}};
    for (const float value : vertex.point) {
      if (!std::isfinite(value)) fail(file, "a vertex is not finite");
    }
    if (has(index.normal_index, normals)) {
      vertex.normal = upright(attributes.normals, index.normal_index);
    }
    if (has(index.texcoord_index, places)) {
      const std::size_t first = 2 * static_cast<std::size_t>(index.texcoord_index);
      vertex.uv = {attributes.texcoords[first], attributes.texcoords[first + 1]};
    }
    model.vertices.push_back(vertex);
    return place->second;
  };
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    for (std::size_t i = 0; i < shape.mesh.material_ids.size(); ++i) {
      model.triangles.push_back(
          {{vertex_of(shape.mesh.indices[3 * i]), vertex_of(shape.mesh.indices[3 * i + 1]),
            vertex_of(shape.mesh.indices[3 * i + 2])}});
      const int material = shape.mesh.material_ids[i];
      const auto none = static_cast<std::uint32_t>(model.materials.size() - 1);
      model.material_of.push_back(
          material < 0 ? none : std::min(static_cast<std::uint32_t>(material), none));
    }
  }
  if (model.triangles.empty()) fail(file, "has no faces");
  view = view_of(model);
  return model;
}

#else

Model read_obj(const std::string& file, View& /*view*/) {
  throw std::runtime_error(file + ": built without tinyobjloader, which reads OBJ files");
}

#endif

}  // namespace embree_host
