#include "core/base/mesh/obj_file.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/printable.hpp"

namespace fusebench::mesh {

namespace {

namespace fs = std::filesystem;

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

/// Its number of a vertex, before any slash: the library would take the digits that it finds, and wrap.
bool is_corner(std::string_view field) {
  const std::string_view vertex = field.substr(0, field.find('/'));
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(vertex.data(), vertex.data() + vertex.size(), number);
  return error == std::errc() && end == vertex.data() + vertex.size();
}

Result<void> check_corners(std::span<const std::string_view> corners, const fs::path& file,
                           std::size_t line) {
  const auto bad = std::ranges::find_if_not(corners, is_corner);
  if (bad == corners.end()) return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}:{}: '{}' names no vertex of a face", file.string(), line, printable(*bad)));
}

/// In double precision. The library reads floats, and invalid numbers as 0.
Result<std::vector<Vector3d>> read_vertices(const fs::path& file) {
  std::ifstream lines = io::input_file(file);
  std::string line;
  std::vector<std::string_view> fields;
  std::vector<Vector3d> vertices;
  for (std::size_t number = 1; io::next_line(lines, line); ++number) {
    io::split_fields(line, fields);
    if (fields.empty()) continue;
    if (fields[0] == "f") {
      if (auto fits = check_corners(std::span(fields).subspan(1), file, number); !fits)
        return tl::unexpected(fits.error());
    }
    if (fields[0] != "v") continue;
    fields.erase(fields.begin());
    if (fields.size() < 3) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: a vertex of {} numbers (expected 3 or more)",
                                                       file.string(), number, fields.size()));
    }
    Vector3d& vertex = vertices.emplace_back();
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const Result<double> value = io::parse_number(fields[k]);
      if (!value)
        return fail(ErrorCode::data_corrupt,
                    fmt::format("{}:{}: {}", file.string(), number, value.error().message));
      if (k < 3) vertex[static_cast<Eigen::Index>(k)] = *value;
    }
  }
  if (lines.bad())
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: cannot be read, or has a line of more than {} bytes", file.string(),
                            io::kMostLineBytes));
  return vertices;
}

/// Polygons are cut into fans.
Result<void> add_faces(const tinyobj::shape_t& shape, const fs::path& file, PreciseMesh& mesh) {
  std::size_t at = 0;
  for (const auto corners : shape.mesh.num_face_vertices) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
      const int vertex = shape.mesh.indices[at++].vertex_index;
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size()) {
        return fail(ErrorCode::data_corrupt,
                    fmt::format("{}: shape '{}': a face names vertex {} of {}", file.string(),
                                printable(shape.name), vertex + 1, mesh.vertices.size()));
      }
      triangle[std::min<std::size_t>(k, 2)] = static_cast<std::uint32_t>(vertex);
      if (k < 2) continue;
      mesh.triangles.push_back(triangle);
      triangle[1] = triangle[2];  // the next triangle of the fan
    }
  }
  return {};
}

}  // namespace

Result<PreciseMesh> read_obj(const fs::path& file) {
  if (!fs::is_regular_file(file))
    return fail(ErrorCode::data_missing, fmt::format("{}: no such file", file.string()));
  Result<std::vector<Vector3d>> vertices = read_vertices(file);
  if (!vertices) return tl::unexpected(vertices.error());
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::ifstream stream = io::input_file(file);
  constexpr tinyobj::MaterialReader* kNoMaterials = nullptr;  // files that it names are not opened
  constexpr bool kTriangulate = false;    // the library drops polygons of vertices that do not exist
  constexpr bool kDefaultColors = false;  // no white where the file has no colours
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, kNoMaterials,
                        kTriangulate, kDefaultColors)) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: not a readable OBJ file: {}", file.string(),
                                                     printable(without_line_end(error), 200)));
  }
  PreciseMesh mesh;
  mesh.vertices = std::move(*vertices);
  if (attributes.vertices.size() != 3 * mesh.vertices.size()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: {} lines begin with 'v', but it has {} vertices", file.string(),
                            mesh.vertices.size(), attributes.vertices.size() / 3),
                "write it anew with one vertex a line");
  }
  if (attributes.colors.size() == attributes.vertices.size()) {
    for (std::size_t i = 0; i < attributes.colors.size(); i += 3)
      mesh.colors.push_back(color_of(&attributes.colors[i]));
  }
  for (const tinyobj::shape_t& shape : shapes) {
    if (auto added = add_faces(shape, file, mesh); !added) return tl::unexpected(added.error());
  }
  return mesh;
}

}  // namespace fusebench::mesh
