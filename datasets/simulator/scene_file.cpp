#include "datasets/simulator/scene_file.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh_file.hpp"
#include "core/text_table.hpp"
#include "datasets/simulator/texture_patterns.hpp"

namespace fusebench {

namespace {

namespace fs = std::filesystem;

constexpr float kFarthest_m = 1e6F;  // a float resolves 6 cm there; far below what overflows when multiplied
constexpr float kTextureRepeat_m = 1.2F;
constexpr int kTextureSide = 512;

std::string without_line_end(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  return text;
}

Rgb color_of(const float* channels) {
  Rgb color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(channels[c], 0.0F, 1.0F)));
  }
  return color;
}

/// The library reads what is not a number as 0, so vertices are checked beforehand.
Result<void> check_obj_vertices(const fs::path& file) {
  std::ifstream lines(file);
  std::string line;
  std::vector<std::string_view> fields;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (!line.starts_with("v ") && !line.starts_with("v\t")) continue;
    split_fields(std::string_view(line).substr(2), fields);
    if (fields.size() < 3) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: a vertex of {} numbers (expected 3 or more)",
                                                       file.string(), number, fields.size()));
    }
    for (const std::string_view field : fields) {
      const Result<double> value = parse_number(field);
      if (!value)
        return fail(ErrorCode::data_corrupt,
                    fmt::format("{}:{}: {}", file.string(), number, value.error().message));
    }
  }
  return {};
}

Result<Mesh> read_obj(const fs::path& file) {
  if (!fs::is_regular_file(file))
    return fail(ErrorCode::data_missing, fmt::format("{}: no such file", file.string()));
  if (const Result<void> sound = check_obj_vertices(file); !sound) return tl::unexpected(sound.error());
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;  // no white where the file has no colours
  tinyobj::ObjReader reader;
  if (!reader.ParseFromFile(file.string(), config)) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: not a readable OBJ file: {}", file.string(),
                                                     without_line_end(reader.Error())));
  }
  const tinyobj::attrib_t& attributes = reader.GetAttrib();
  Mesh mesh;
  for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3) {
    mesh.vertices.emplace_back(attributes.vertices[i], attributes.vertices[i + 1],
                               attributes.vertices[i + 2]);
    if (attributes.colors.size() == attributes.vertices.size())
      mesh.colors.push_back(color_of(&attributes.colors[i]));
  }
  for (const tinyobj::shape_t& shape : reader.GetShapes()) {
    for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const int vertex = shape.mesh.indices[i + k].vertex_index;
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size()) {
          return fail(ErrorCode::data_corrupt,
                      fmt::format("{}: shape '{}': a face names vertex {} of {}", file.string(), shape.name,
                                  vertex + 1, mesh.vertices.size()));
        }
        triangle[k] = static_cast<std::uint32_t>(vertex);
      }
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

Result<Mesh> read_mesh(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".ply") return read_ply(file);
  if (ending == ".obj") return read_obj(file);
  return fail(
      ErrorCode::usage,
      fmt::format("scene = {}: the ending '{}' is unknown (allowed .ply, .obj)", file.string(), ending),
      "convert the mesh to PLY");
}

/// A mesh in which no triangles share vertices, textured and lit by the direction that each faces.
SimulatedScene textured(const Mesh& mesh) {
  SimulatedScene scene;
  scene.textures.emplace_back(
      paint_speckles(kTextureSide, reflectance_of(0xc0b8a8), reflectance_of(0x4a4038), 1));
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    const Eigen::Vector3f normal =
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).stableNormalized();
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const std::uint32_t vertex : triangle) {
      const Eigen::Vector3f& point = mesh.vertices[vertex];
      scene.mesh.vertices.push_back(point);
      scene.mesh.normals.push_back(normal);
      scene.texture_coordinates.emplace_back(Eigen::Vector2f(point[(axis + 1) % 3], point[(axis + 2) % 3]) /
                                             kTextureRepeat_m);
      scene.light.push_back(0.75F + 0.2F * normal.z() + 0.1F * normal.x() + 0.05F * normal.y());
    }
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.triangle_textures.assign(scene.mesh.triangles.size(), 0);
  color_vertices(scene);
  return scene;
}

}  // namespace

Result<SimulatedScene> read_scene(const fs::path& file, const SceneFileOptions& options) {
  if (!(options.metres_per_unit >= 1e-6 && options.metres_per_unit <= 1e6)) {
    return fail(ErrorCode::configuration,
                fmt::format("metres_per_unit = {} (allowed 1e-6 .. 1e6)", options.metres_per_unit));
  }
  Result<Mesh> mesh = read_mesh(file);
  if (!mesh) return tl::unexpected(mesh.error());
  if (mesh->triangles.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no triangles, so there is nothing to see", file.string()),
                "a point cloud has to be meshed first");
  }
  Eigen::AlignedBox3d bounds;
  for (Eigen::Vector3f& vertex : mesh->vertices) {
    vertex *= static_cast<float>(options.metres_per_unit);
    if (!(vertex.array().abs() <= kFarthest_m).all()) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: a vertex at {}, {}, {} m (allowed -1e6 .. 1e6; metres_per_unit = {})",
                              file.string(), vertex.x(), vertex.y(), vertex.z(), options.metres_per_unit),
                  "a scene lies near the origin; check its unit");
    }
    if (options.y_up) vertex = Eigen::Vector3f(vertex.x(), -vertex.z(), vertex.y());
    bounds.extend(vertex.cast<double>());
  }
  mesh->normals.clear();  // nothing needs those of the file, which may point anywhere
  SimulatedScene scene;
  if (mesh->colors.empty()) {
    scene = textured(*mesh);
  } else {
    scene.mesh = std::move(*mesh);
  }
  constexpr double kInner = 0.1;  // of the extent, to both sides of the centre
  scene.free_space = {bounds.center() - kInner * bounds.sizes(), bounds.center() + kInner * bounds.sizes()};
  scene.look_at = bounds;
  return scene;
}

}  // namespace fusebench
