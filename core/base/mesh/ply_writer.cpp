#include "core/base/mesh/ply_file.hpp"

#include <fmt/core.h>

#include <array>
#include <bit>
#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

namespace fusebench::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

template <class Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(std::bit_cast<std::array<char, sizeof(Value)>>(value).data(), sizeof(Value));
}

void append(std::string& bytes, const Eigen::Vector3f& vector) {
  for (const float value : vector) append(bytes, value);
}

std::string header_of(const Mesh& mesh) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += fmt::format("element vertex {}\n", mesh.vertices.size());
  header += "property float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colors.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!mesh.quality.empty()) header += "property float quality\n";
  if (!mesh.radii_m.empty()) header += "property float radius\n";
  header += fmt::format("element face {}\n", mesh.triangles.size());
  return header + "property list uchar int vertex_indices\nend_header\n";
}

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, int error_number) {
  const std::string reason =
      error_number != 0 ? std::generic_category().message(error_number) : "the write failed";
  return fail(ErrorCode::io, fmt::format("{}: cannot write: {}", file.string(), reason),
              "check that the folder exists, may be written to, and has space left");
}

/// `name`: of the file in messages.
Result<void> write_to(const std::filesystem::path& file, const Mesh& mesh,
                      const std::filesystem::path& name) {
  check(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size(), "no normals or one a vertex");
  check(mesh.colors.empty() || mesh.colors.size() == mesh.vertices.size(), "no colours or one a vertex");
  check(mesh.quality.empty() || mesh.quality.size() == mesh.vertices.size(), "no quality or one a vertex");
  check(mesh.radii_m.empty() || mesh.radii_m.size() == mesh.vertices.size(), "no radius or one a vertex");
  errno = 0;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) return cannot_write(name, errno);
  std::string bytes = header_of(mesh);
  int reason = 0;
  // A piece at a time: the file of a room has hundreds of megabytes. False once the disk is full.
  const auto write_from = [&](std::size_t least_bytes) {
    if (bytes.size() < least_bytes) return true;
    if (!stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size())) && reason == 0)
      reason = errno;
    bytes.clear();
    return stream.good();
  };
  constexpr std::size_t kPieceBytes = 1U << 20;
  for (std::size_t i = 0; i < mesh.vertices.size() && write_from(kPieceBytes); ++i) {
    append(bytes, mesh.vertices[i]);
    if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
    if (!mesh.colors.empty()) append(bytes, mesh.colors[i]);
    if (!mesh.quality.empty()) append(bytes, mesh.quality[i]);
    if (!mesh.radii_m.empty()) append(bytes, mesh.radii_m[i]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size() && write_from(kPieceBytes); ++i) {
    append(bytes, std::uint8_t{3});
    append(bytes, mesh.triangles[i]);
  }
  write_from(0);
  errno = 0;
  stream.close();  // a full disk may show only here
  if (!stream) return cannot_write(name, reason != 0 ? reason : errno);
  return {};
}

}  // namespace

Result<void> write_ply(const Mesh& mesh, const std::filesystem::path& file) {
  return write_to(file, mesh, file);
}

Result<void> write_ply(const Mesh& mesh, const io::StagedFile& file) {
  return write_to(file.path(), mesh, file.place());
}

}  // namespace fusebench::mesh
