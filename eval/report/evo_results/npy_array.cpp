#include "eval/report/evo_results/npy_array.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

#include "core/base/printable.hpp"

namespace fusebench::evo_results {

namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostElements = std::size_t{1} << 31;

tl::unexpected<Error> no_array(const std::string& name, const std::string& what) {
  return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", name, what),
              "arrays of results are little-endian doubles ('<f8') as numpy.save() writes them");
}

/// What follows "'key': " in the header, up to the end of the value.
std::optional<std::string_view> value_of(std::string_view header, std::string_view key) {
  const std::string quoted = fmt::format("'{}':", key);
  const std::size_t at = header.find(quoted);
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view value = header.substr(at + quoted.size());
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  const std::size_t end = value.starts_with('(') ? value.find(')') + 1 : value.find_first_of(",}");
  if (end == 0 || end == std::string_view::npos) return std::nullopt;
  return value.substr(0, end);
}

/// "(908,)", "(4, 4)"; "()" has no dimensions.
std::optional<std::vector<std::size_t>> parsed_shape(std::string_view text) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return std::nullopt;
  text = text.substr(1, text.size() - 2);
  std::vector<std::size_t> shape;
  std::size_t elements = 1;
  while (!text.empty()) {
    std::size_t size = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
    if (error != std::errc() || size > kMostElements) return std::nullopt;
    elements *= size;
    if (elements > kMostElements) return std::nullopt;
    shape.push_back(size);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.starts_with(',')) text.remove_prefix(1);
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return shape;
}

template <typename Number>
void take_values(std::string_view bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    Number value;
    std::memcpy(&value, bytes.data() + i * sizeof(Number), sizeof(Number));
    values[i] = static_cast<double>(value);
  }
}

/// The dictionary that describes the array; `bytes` is then what follows it.
std::optional<std::string_view> take_header(std::string_view& bytes) {
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + 4) return std::nullopt;
  const std::size_t length_bytes = bytes[kMagic.size()] == 1 ? 2 : 4;
  bytes.remove_prefix(kMagic.size() + 2);
  if (bytes.size() < length_bytes) return std::nullopt;
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i)
    length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  bytes.remove_prefix(length_bytes);
  if (bytes.size() < length) return std::nullopt;
  const std::string_view header = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return header;
}

}  // namespace

NpyArray row_of(std::vector<double> values) {
  const std::size_t size = values.size();
  return {{size}, std::move(values)};
}

std::string npy_bytes(const NpyArray& array) {
  constexpr std::size_t kBeforeHeader = kMagic.size() + 4;
  const std::string shape = array.shape.size() == 1 ? fmt::format("({},)", array.shape[0])
                                                    : fmt::format("({})", fmt::join(array.shape, ", "));
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': {}, }}", shape);
  // Blanks and a newline bring the values to a multiple of 64 bytes.
  header.append(kAlignment - 1 - (kBeforeHeader + header.size()) % kAlignment, ' ');
  header += '\n';
  std::string bytes(kMagic);
  bytes += '\x01';
  bytes += '\0';
  bytes += static_cast<char>(header.size() & 0xFF);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(array.values.data()), array.values.size() * sizeof(double));
  return bytes;
}

Result<NpyArray> parse_npy(std::string_view bytes, const std::string& name) {
  const auto header = take_header(bytes);
  if (!header) return no_array(name, "is no array of NumPy");
  const auto type = value_of(*header, "descr");
  const auto order = value_of(*header, "fortran_order");
  const auto shape_text = value_of(*header, "shape");
  const auto shape = shape_text ? parsed_shape(*shape_text) : std::nullopt;
  if (!type || !order || !shape)
    return no_array(name, fmt::format("its header is not understood: {}", printable(*header, 80)));
  const bool doubles = *type == "'<f8'";
  if (!doubles && *type != "'<f4'") return no_array(name, "is an array of the type " + printable(*type));
  if (*order != "False" && shape->size() > 1) return no_array(name, "is an array in Fortran's order");
  std::size_t elements = 1;
  for (const std::size_t size : *shape) elements *= size;
  if (bytes.size() != elements * (doubles ? sizeof(double) : sizeof(float)))
    return no_array(name, fmt::format("has {} bytes of values for the shape {}", bytes.size(), *shape_text));
  NpyArray array{*shape, std::vector<double>(elements)};
  if (doubles)
    take_values<double>(bytes, array.values);
  else
    take_values<float>(bytes, array.values);
  return array;
}

}  // namespace fusebench::evo_results
