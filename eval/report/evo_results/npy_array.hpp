// NumPy's files of one array (.npy), of doubles: NEP 1, "A Simple File Format for NumPy Arrays".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::evo_results {

struct NpyArray {
  std::vector<std::size_t> shape;  ///< of one or two dimensions
  std::vector<double> values;      ///< the last dimension runs fastest
};

/// An array of one dimension.
[[nodiscard]] NpyArray row_of(std::vector<double> values);

/// Format 1.0, '<f8', C order, as numpy.save() writes it.
[[nodiscard]] std::string npy_bytes(const NpyArray& array);

/// Formats 1.0 to 3.0 of little-endian doubles, or singles, in C order. Error data_corrupt, which begins with
/// `name`: anything else, or bytes that are not as many as the shape asks for.
[[nodiscard]] Result<NpyArray> parse_npy(std::string_view bytes, const std::string& name);

}  // namespace fusebench::evo_results
