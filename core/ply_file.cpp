#include "core/ply_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/printable.hpp"

namespace fusebench {
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
  header += fmt::format("element face {}\n", mesh.triangles.size());
  return header + "property list uchar int vertex_indices\nend_header\n";
}

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, int error_number) {
  const std::string reason =
      error_number != 0 ? std::generic_category().message(error_number) : "the write failed";
  return fail(ErrorCode::io, fmt::format("{}: cannot write: {}", file.string(), reason),
              "check that the folder exists, may be written to, and has space left");
}

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Scalar> scalar_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> kNames = {{{"char", Scalar::int8},
                                                                           {"int8", Scalar::int8},
                                                                           {"uchar", Scalar::uint8},
                                                                           {"uint8", Scalar::uint8},
                                                                           {"short", Scalar::int16},
                                                                           {"int16", Scalar::int16},
                                                                           {"ushort", Scalar::uint16},
                                                                           {"uint16", Scalar::uint16},
                                                                           {"int", Scalar::int32},
                                                                           {"int32", Scalar::int32},
                                                                           {"uint", Scalar::uint32},
                                                                           {"uint32", Scalar::uint32},
                                                                           {"float", Scalar::float32},
                                                                           {"float32", Scalar::float32},
                                                                           {"double", Scalar::float64},
                                                                           {"float64", Scalar::float64}}};
  for (const auto& [known, scalar] : kNames) {
    if (known == name) return scalar;
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  Scalar type = Scalar::float32;
  std::optional<Scalar> count_type;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

// Reads one file that lies in memory. Functions return false after they have set error_.
class PlyReader {
 public:
  PlyReader(std::string file, std::string bytes) : file_(std::move(file)), bytes_(std::move(bytes)) {}

  Result<PreciseMesh> read() {
    if (!read_header()) return tl::unexpected(error_);
    for (const Element& element : elements_) {
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
  static constexpr std::array<std::string_view, 10> kVertexNames = {"x",  "y",   "z",     "nx",   "ny",
                                                                    "nz", "red", "green", "blue", "quality"};
  static constexpr std::size_t kQuality = 9;

  bool reject(const std::string& what) {
    const std::string place =
        binary_ ? fmt::format("{}: byte {}", file_, position_) : fmt::format("{}:{}", file_, line_);
    error_ = {ErrorCode::data_corrupt, place + ": " + what,
              "expected an ascii or binary PLY file, complete to its last byte"};
    return false;
  }

  bool read_header() {
    std::optional<bool> binary;
    for (line_ = 1; position_ < bytes_.size(); ++line_) {
      const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
      std::istringstream words(bytes_.substr(position_, end - position_));
      position_ = std::min(end + 1, bytes_.size());
      std::string keyword;
      words >> keyword;
      if (line_ == 1) {
        if (keyword != "ply") return reject("the first line is not 'ply'");
      } else if (keyword == "format") {
        std::string format;
        words >> format;
        if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian") {
          return reject(fmt::format("format {} is not supported", printable(format)));
        }
        binary = format != "ascii";
        big_endian_ = format == "binary_big_endian";
      } else if (keyword == "element") {
        if (!read_element(words)) return false;
      } else if (keyword == "property") {
        if (!read_property(words)) return false;
      } else if (keyword == "end_header") {
        ++line_;
        return binary ? accept_header(*binary) : reject("the header has no format line");
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        return reject(fmt::format("unknown header keyword '{}'", printable(keyword)));
      }
    }
    return reject("the header has no end_header line");
  }

  bool read_element(std::istringstream& words) {
    Element element;
    words >> element.name >> element.count;
    if (!words) return reject("expected 'element NAME COUNT'");
    const auto is_same = [&](const Element& other) { return other.name == element.name; };
    if (std::ranges::any_of(elements_, is_same))
      return reject(fmt::format("element {} is there twice", printable(element.name)));
    // Each row takes at least a byte: a count beyond that is corrupt, and not worth the memory.
    if (element.count > bytes_.size() - rows_) {
      return reject(fmt::format("element {} = {}, but the file has {} bytes", printable(element.name),
                                element.count, bytes_.size()));
    }
    rows_ += element.count;
    elements_.push_back(std::move(element));
    return true;
  }

  bool read_property(std::istringstream& words) {
    Property property;
    std::string type;
    words >> type;
    if (type == "list") {
      std::string count_type;
      words >> count_type >> type;
      property.count_type = scalar_of(count_type);
      if (!property.count_type)
        return reject(fmt::format("unknown type '{}' of a list's count", printable(count_type)));
    }
    words >> property.name;
    const std::optional<Scalar> scalar = scalar_of(type);
    if (!words || !scalar)
      return reject(fmt::format("property {}: unknown type '{}'", printable(property.name), printable(type)));
    if (elements_.empty())
      return reject(fmt::format("property {} before the first element", printable(property.name)));
    property.type = *scalar;
    elements_.back().properties.push_back(std::move(property));
    return true;
  }

  bool accept_header(bool binary) {
    const auto vertex =
        std::find_if(elements_.begin(), elements_.end(), [](const Element& e) { return e.name == "vertex"; });
    if (vertex == elements_.end()) return reject("no element vertex");
    for (const Element& element : elements_) {
      if (element.properties.empty())
        return reject(fmt::format("element {} has no properties", printable(element.name)));
    }
    const auto has = [&](std::size_t first, std::size_t count = 3) {  // neighbours in kVertexNames
      return std::all_of(
          kVertexNames.begin() + first, kVertexNames.begin() + first + count, [&](std::string_view name) {
            return std::any_of(vertex->properties.begin(), vertex->properties.end(),
                               [&](const Property& p) { return p.name == name && !p.count_type; });
          });
    };
    if (!has(0)) return reject("element vertex has no properties x, y and z");
    mesh_.vertices.reserve(vertex->count);
    has_normals_ = has(3);
    has_colors_ = has(6);
    has_quality_ = has(kQuality, 1);
    vertex_count_ = vertex->count;
    binary_ = binary;
    return true;
  }

  bool read_vertex(const Element& element) {
    std::array<double, kVertexNames.size()> values{};
    for (const Property& property : element.properties) {
      const auto name = std::find(kVertexNames.begin(), kVertexNames.end(), property.name);
      if (property.count_type || name == kVertexNames.end()) {
        if (!skip(property)) return false;
        continue;
      }
      const auto role = static_cast<std::size_t>(name - kVertexNames.begin());
      double& value = values[role];
      if (!read_value(property.type, property.name, value)) return false;
      if (role < 3 && !(std::abs(value) <= std::numeric_limits<float>::max()))
        return reject(fmt::format("property {} is not finite as a float", property.name));
      if (role >= 6 && role < kQuality && has_colors_ &&
          !(value >= 0 && value <= 255 && value == std::floor(value))) {
        return reject(fmt::format("property {} = {} (expected an integer in 0-255)", property.name, value));
      }
    }
    mesh_.vertices.emplace_back(values[0], values[1], values[2]);
    if (has_normals_) mesh_.normals.push_back(Vector3d(values[3], values[4], values[5]).cast<float>());
    if (has_quality_) mesh_.quality.push_back(static_cast<float>(values[kQuality]));
    if (has_colors_) {
      mesh_.colors.push_back({static_cast<std::uint8_t>(values[6]), static_cast<std::uint8_t>(values[7]),
                              static_cast<std::uint8_t>(values[8])});
    }
    return true;
  }

  bool read_face(const Element& element) {
    for (const Property& property : element.properties) {
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

  bool read_other(const Element& element) {
    return std::all_of(element.properties.begin(), element.properties.end(),
                       [&](const Property& property) { return skip(property); });
  }

  bool skip(const Property& property) {
    std::size_t count = 1;
    if (property.count_type && !read_count(property, count)) return false;
    double ignored = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!read_value(property.type, property.name, ignored)) return false;
    }
    return true;
  }

  bool read_count(const Property& list, std::size_t& count) {
    double value = 0;
    if (!read_value(*list.count_type, list.name, value)) return false;
    if (!(value >= 0 && value <= static_cast<double>(bytes_.size()) && value == std::floor(value))) {
      return reject(fmt::format("property {}: a list of {} values", printable(list.name), value));
    }
    count = static_cast<std::size_t>(value);
    return true;
  }

  bool read_value(Scalar type, const std::string& name, double& value) {
    if (!binary_) return read_word(name, value);
    switch (type) {
      case Scalar::int8:
        return read_bytes<std::int8_t>(name, value);
      case Scalar::uint8:
        return read_bytes<std::uint8_t>(name, value);
      case Scalar::int16:
        return read_bytes<std::int16_t>(name, value);
      case Scalar::uint16:
        return read_bytes<std::uint16_t>(name, value);
      case Scalar::int32:
        return read_bytes<std::int32_t>(name, value);
      case Scalar::uint32:
        return read_bytes<std::uint32_t>(name, value);
      case Scalar::float32:
        return read_bytes<float>(name, value);
      case Scalar::float64:
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
  std::size_t line_ = 1;      // of the header and of ascii data, from 1
  bool binary_ = false;       // the position is told as a byte
  bool big_endian_ = false;
  std::vector<Element> elements_;
  std::size_t rows_ = 0;  // of all elements
  std::size_t vertex_count_ = 0;
  bool has_normals_ = false;
  bool has_colors_ = false;
  bool has_quality_ = false;
  PreciseMesh mesh_;
  Error error_;
};

}  // namespace

Result<void> write_ply(const Mesh& mesh, const std::filesystem::path& file) {
  check(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size(), "no normals or one a vertex");
  check(mesh.colors.empty() || mesh.colors.size() == mesh.vertices.size(), "no colours or one a vertex");
  check(mesh.quality.empty() || mesh.quality.size() == mesh.vertices.size(), "no quality or one a vertex");
  errno = 0;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) return cannot_write(file, errno);
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
  }
  for (std::size_t i = 0; i < mesh.triangles.size() && write_from(kPieceBytes); ++i) {
    append(bytes, std::uint8_t{3});
    append(bytes, mesh.triangles[i]);
  }
  write_from(0);
  errno = 0;
  stream.close();  // a full disk may show only here
  if (!stream) return cannot_write(file, reason != 0 ? reason : errno);
  return {};
}

Result<PreciseMesh> read_ply(const std::filesystem::path& file) {
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(file, no_size);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(no_size ? 0 : size, '\0');
  if (no_size || !stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot read the file", file.string()),
                "check the path and its permissions");
  }
  return PlyReader(file.string(), std::move(bytes)).read();
}

}  // namespace fusebench
