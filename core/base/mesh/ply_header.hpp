// The header of a PLY file: layout of its data.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::mesh {

enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::float32;
  std::optional<PlyScalar> count_type;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool binary = false;
  bool big_endian = false;
  std::vector<PlyElement> elements;  ///< in the order of their data
  std::size_t end_byte = 0;          ///< where the data begin
  std::size_t end_line = 0;          ///< number of the line there, from 1
};

/// Of a file, which messages name, with these bytes. Error data_corrupt with the line.
[[nodiscard]] Result<PlyHeader> read_ply_header(const std::string& file, std::string_view bytes);

/// What is wrong, and where, in a file that is not as PLY files are.
[[nodiscard]] Error not_ply(const std::string& place, const std::string& what);

}  // namespace fusebench::mesh
