#include "core/base/mesh/ply_header.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <system_error>
#include <utility>

#include "core/base/printable.hpp"

namespace fusebench::mesh {
namespace {

std::optional<PlyScalar> scalar_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, PlyScalar>, 16> kNames = {
      {{"char", PlyScalar::int8},
       {"int8", PlyScalar::int8},
       {"uchar", PlyScalar::uint8},
       {"uint8", PlyScalar::uint8},
       {"short", PlyScalar::int16},
       {"int16", PlyScalar::int16},
       {"ushort", PlyScalar::uint16},
       {"uint16", PlyScalar::uint16},
       {"int", PlyScalar::int32},
       {"int32", PlyScalar::int32},
       {"uint", PlyScalar::uint32},
       {"uint32", PlyScalar::uint32},
       {"float", PlyScalar::float32},
       {"float32", PlyScalar::float32},
       {"double", PlyScalar::float64},
       {"float64", PlyScalar::float64}}};
  for (const auto& [known, scalar] : kNames) {
    if (known == name) return scalar;
  }
  return std::nullopt;
}

// Functions return false after they have set error_.
class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  Result<PlyHeader> header() {
    if (!read()) return tl::unexpected(error_);
    return std::move(header_);
  }

 private:
  bool reject(const std::string& what) {
    error_ = not_ply(fmt::format("{}:{}", file_, line_), what);
    return false;
  }

  bool read() {
    std::optional<bool> binary;
    for (; position_ < bytes_.size(); ++line_) {
      const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
      std::istringstream words(std::string(bytes_.substr(position_, end - position_)));
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
        header_.big_endian = format == "binary_big_endian";
      } else if (keyword == "element") {
        if (!read_element(words)) return false;
      } else if (keyword == "property") {
        if (!read_property(words)) return false;
      } else if (keyword == "end_header") {
        ++line_;
        if (!binary) return reject("the header has no format line");
        header_.binary = *binary;
        header_.end_byte = position_;
        header_.end_line = line_;
        return true;
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        return reject(fmt::format("unknown header keyword '{}'", printable(keyword)));
      }
    }
    return reject("the header has no end_header line");
  }

  bool read_element(std::istringstream& words) {
    PlyElement element;
    std::string count;
    words >> element.name >> count;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (!words || error != std::errc() || end != count.data() + count.size())
      return reject(
          fmt::format("expected 'element NAME COUNT', with a whole number and not '{}'", printable(count)));
    const auto is_same = [&](const PlyElement& other) { return other.name == element.name; };
    if (std::ranges::any_of(header_.elements, is_same))
      return reject(fmt::format("element {} is there twice", printable(element.name)));
    // Each row takes at least a byte: a larger count is corrupt and must not be allocated.
    if (element.count > bytes_.size() - rows_) {
      return reject(fmt::format("element {} = {}, but the file has {} bytes", printable(element.name),
                                element.count, bytes_.size()));
    }
    rows_ += element.count;
    header_.elements.push_back(std::move(element));
    return true;
  }

  bool read_property(std::istringstream& words) {
    PlyProperty property;
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
    const std::optional<PlyScalar> scalar = scalar_of(type);
    if (!words || !scalar)
      return reject(fmt::format("property {}: unknown type '{}'", printable(property.name), printable(type)));
    if (header_.elements.empty())
      return reject(fmt::format("property {} before the first element", printable(property.name)));
    property.type = *scalar;
    header_.elements.back().properties.push_back(std::move(property));
    return true;
  }

  const std::string& file_;
  std::string_view bytes_;
  std::size_t position_ = 0;  // of the next byte
  std::size_t line_ = 1;
  std::size_t rows_ = 0;  // of all elements
  PlyHeader header_;
  Error error_;
};

}  // namespace

Result<PlyHeader> read_ply_header(const std::string& file, std::string_view bytes) {
  return HeaderReader(file, bytes).header();
}

Error not_ply(const std::string& place, const std::string& what) {
  return {ErrorCode::data_corrupt, place + ": " + what,
          "expected an ascii or binary PLY file, complete to its last byte"};
}

}  // namespace fusebench::mesh
