// Writer and reader of PLY files.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/io/staged_file.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh {

/// Writes binary little-endian PLY: float x y z, nx ny nz (if present), uchar red green blue (if present),
/// float quality and radius (if present; so MeshLab calls them), and triangles. Error io when it cannot be
/// written.
[[nodiscard]] Result<void> write_ply(const Mesh& mesh, const std::filesystem::path& file);

/// The same into a file that gets its name when all of it is written; errors name its place.
[[nodiscard]] Result<void> write_ply(const Mesh& mesh, const io::StagedFile& file);

/// Reads a PLY mesh or point cloud, ascii or binary of either byte order: vertices with x y z and, if
/// present, nx ny nz, red green blue (integers 0-255), quality and, where there are normals and no faces,
/// radius (of surfels, above 0), in any numeric type; faces as lists vertex_indices or vertex_index, where
/// larger polygons are cut into fans. Other properties and elements are skipped. Errors: data_missing (no
/// such file), data_corrupt (names the line of an ascii file or header, or the byte of binary data, and the
/// property).
[[nodiscard]] Result<PreciseMesh> read_ply(const std::filesystem::path& file);

}  // namespace fusebench::mesh
