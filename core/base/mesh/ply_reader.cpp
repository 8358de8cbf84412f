#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/io/input_file.hpp"
#include "core/base/mesh/ply_file.hpp"
#include "core/base/mesh/ply_header.hpp"
#include "core/base/printable.hpp"

namespace fusebench::mesh {
namespace {

// Reads one file from memory. Functions return false after they have set error_.
class PlyReader {
 public:
  PlyReader(std::string file, std::string bytes) : file_(std::move(file)), bytes_(std::move(bytes)) {}

  Result<PreciseMesh> read() {
    Result<PlyHeader> header = read_ply_header(file_, bytes_);
    if (!header) return tl::unexpected(header.error());
    position_ = header->end_byte;
    line_ = header->end_line;
    if (!accept(*header)) return tl::unexpected(error_);
    for (const PlyElement& element : header->elements) {
      if (element.name == "vertex") set_roles(element);
      for (std::size_t row = 0; row < element.count; ++row) {
        const bool ok = element.name == "vertex" ? read_vertex(element)
                        : element.name == "face" ? read_face(element)
                                                 : read_other(element);
        if (!ok) return tl::unexpected(error_);
      }
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::array<std::string_view, 11> kVertexNames = {
      "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "quality", "radius"};
  static constexpr std::size_t kQuality = 9;
  static constexpr std::size_t kRadius = 10;

  bool reject(const std::string& what) {
    const std::string place =
        binary_ ? fmt::format("{}: byte {}", file_, position_) : fmt::format("{}:{}", file_, line_);
    error_ = not_ply(place, what);
    return false;
  }

  bool accept(const PlyHeader& header) {
    const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex"; });
    if (vertex == header.elements.end()) return reject("no element vertex");
    for (const PlyElement& element : header.elements) {
      if (element.properties.empty())
        return reject(fmt::format("element {} has no properties", printable(element.name)));
    }
    const auto has = [&](std::size_t first, std::size_t count = 3) {  // neighbours in kVertexNames
      return std::all_of(
          kVertexNames.begin() + first, kVertexNames.begin() + first + count, [&](std::string_view name) {
            return std::any_of(vertex->properties.begin(), vertex->properties.end(),
                               [&](const PlyProperty& p) { return p.name == name && !p.count_type; });
          });
    };
    if (!has(0)) return reject("element vertex has no properties x, y and z");
    mesh_.vertices.reserve(vertex->count);
    has_normals_ = has(3);
    has_colors_ = has(6);
    has_quality_ = has(kQuality, 1);
    const bool has_faces = std::ranges::any_of(
        header.elements, [](const PlyElement& e) { return e.name == "face" && e.count > 0; });
    has_radii_ = has(kRadius, 1) && has_normals_ && !has_faces;
    vertex_count_ = vertex->count;
    binary_ = header.binary;
    big_endian_ = header.big_endian;
    return true;
  }

  /// Once, and not for each vertex: names are compared slowly.
  void set_roles(const PlyElement& element) {
    roles_.clear();
    for (const PlyProperty& property : element.properties) {
      const auto name = std::find(kVertexNames.begin(), kVertexNames.end(), property.name);
      roles_.push_back(property.count_type ? kVertexNames.size()
                                           : static_cast<std::size_t>(name - kVertexNames.begin()));
    }
  }

  bool read_vertex(const PlyElement& element) {
    std::array<double, kVertexNames.size()> values{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const std::size_t role = roles_[i];
      if (role == kVertexNames.size()) {
        if (!skip(property)) return false;
        continue;
      }
      double& value = values[role];
      if (!read_value(property.type, property.name, value)) return false;
      if (role < 3 && !(std::abs(value) <= std::numeric_limits<float>::max()))
        return reject(fmt::format("property {} is not finite as a float", property.name));
      if (role >= 6 && role < kQuality && has_colors_ &&
          !(value >= 0 && value <= 255 && value == std::floor(value))) {
        return reject(fmt::format("property {} = {} (expected an integer in 0-255)", property.name, value));
      }
      if (role == kRadius && has_radii_ && !(value > 0 && value <= std::numeric_limits<float>::max()))
        return reject(fmt::format("property {} = {} (expected metres above 0)", property.name, value));
    }
    mesh_.vertices.emplace_back(values[0], values[1], values[2]);
    if (has_normals_) mesh_.normals.push_back(Vector3d(values[3], values[4], values[5]).cast<float>());
    if (has_quality_) mesh_.quality.push_back(static_cast<float>(values[kQuality]));
    if (has_radii_) mesh_.radii_m.push_back(static_cast<float>(values[kRadius]));
    if (has_colors_) {
      mesh_.colors.push_back({static_cast<std::uint8_t>(values[6]), static_cast<std::uint8_t>(values[7]),
                              static_cast<std::uint8_t>(values[8])});
    }
    return true;
  }

  bool read_face(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      const bool is_polygon = property.name == "vertex_indices" || property.name == "vertex_index";
      if (!is_polygon || !property.count_type) {
        if (!skip(property)) return false;
        continue;
      }
      std::size_t count = 0;
      if (!read_count(property, count)) return false;
      if (count < 3) return reject(fmt::format("property {}: a face of {} vertices", property.name, count));
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t i = 0; i < count; ++i) {
        double index = 0;
        if (!read_value(property.type, property.name, index)) return false;
        if (!(index >= 0 && index < static_cast<double>(vertex_count_) && index == std::floor(index))) {
          return reject(fmt::format("property {}: vertex {} of {}", property.name, index, vertex_count_));
        }
        triangle[std::min<std::size_t>(i, 2)] = static_cast<std::uint32_t>(index);
        if (i < 2) continue;
        mesh_.triangles.push_back(triangle);
        triangle[1] = triangle[2];  // the next triangle of the fan
      }
    }
    return true;
  }

  bool read_other(const PlyElement& element) {
    return std::all_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& property) { return skip(property); });
  }

  bool skip(const PlyProperty& property) {
    std::size_t count = 1;
    if (property.count_type && !read_count(property, count)) return false;
    double ignored = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!read_value(property.type, property.name, ignored)) return false;
    }
    return true;
  }

  bool read_count(const PlyProperty& list, std::size_t& count) {
    double value = 0;
    if (!read_value(*list.count_type, list.name, value)) return false;
    if (!(value >= 0 && value <= static_cast<double>(bytes_.size()) && value == std::floor(value))) {
      return reject(fmt::format("property {}: a list of {} values", printable(list.name), value));
    }
    count = static_cast<std::size_t>(value);
    return true;
  }

  bool read_value(PlyScalar type, const std::string& name, double& value) {
    if (!binary_) return read_word(name, value);
    switch (type) {
      case PlyScalar::int8:
        return read_bytes<std::int8_t>(name, value);
      case PlyScalar::uint8:
        return read_bytes<std::uint8_t>(name, value);
      case PlyScalar::int16:
        return read_bytes<std::int16_t>(name, value);
      case PlyScalar::uint16:
        return read_bytes<std::uint16_t>(name, value);
      case PlyScalar::int32:
        return read_bytes<std::int32_t>(name, value);
      case PlyScalar::uint32:
        return read_bytes<std::uint32_t>(name, value);
      case PlyScalar::float32:
        return read_bytes<float>(name, value);
      case PlyScalar::float64:
        break;
    }
    return read_bytes<double>(name, value);
  }

  template <class Value>
  bool read_bytes(const std::string& name, double& value) {
    if (bytes_.size() - position_ < sizeof(Value))
      return reject(fmt::format("the file ends before property {}", printable(name)));
    std::array<char, sizeof(Value)> bytes;
    std::memcpy(bytes.data(), bytes_.data() + position_, sizeof(Value));
    if (big_endian_) std::ranges::reverse(bytes);
    const auto stored = std::bit_cast<Value>(bytes);
    position_ += sizeof(Value);
    value = static_cast<double>(stored);
    return true;
  }

  bool read_word(const std::string& name, double& value) {
    constexpr std::string_view kSpace = " \t\r\n";
    for (; position_ < bytes_.size() && kSpace.find(bytes_[position_]) != kSpace.npos; ++position_) {
      if (bytes_[position_] == '\n') ++line_;
    }
    if (position_ == bytes_.size())
      return reject(fmt::format("the file ends before property {}", printable(name)));
    const std::size_t end = std::min(bytes_.find_first_of(kSpace, position_), bytes_.size());
    const char* last = bytes_.data() + end;
    const auto [stop, status] = std::from_chars(bytes_.data() + position_, last, value);
    if (status != std::errc{} || stop != last) {
      return reject(fmt::format("property {}: '{}' is not a number", printable(name),
                                printable(std::string_view(bytes_).substr(position_, end - position_))));
    }
    position_ = end;
    return true;
  }

  std::string file_;
  std::string bytes_;
  std::size_t position_ = 0;  // of the next byte
  std::size_t line_ = 1;      // of ascii data, from 1
  bool binary_ = false;       // errors name the byte
  bool big_endian_ = false;
  std::size_t vertex_count_ = 0;
  std::vector<std::size_t> roles_;  // of a vertex' properties in kVertexNames; its size: of no use
  bool has_normals_ = false;
  bool has_colors_ = false;
  bool has_quality_ = false;
  bool has_radii_ = false;
  PreciseMesh mesh_;
  Error error_;
};

}  // namespace

Result<PreciseMesh> read_ply(const std::filesystem::path& file) {
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(file, no_size);
  std::ifstream stream = io::input_file(file);
  // Of what is none, the beginning is enough to say so: no room is made for 60 GB of holes.
  constexpr std::uintmax_t kBeginning = 4096;
  std::string bytes(no_size ? 0 : std::min(size, kBeginning), '\0');
  bool is_read = !no_size && stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (is_read && size > kBeginning && bytes.starts_with("ply")) {
    bytes.resize(size);
    is_read =
        static_cast<bool>(stream.read(&bytes[kBeginning], static_cast<std::streamsize>(size - kBeginning)));
  }
  if (!is_read) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot read the file", file.string()),
                "check the path and its permissions");
  }
  return PlyReader(file.string(), std::move(bytes)).read();
}

}  // namespace fusebench::mesh
