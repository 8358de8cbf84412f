// What the text of a row looks like: names, decimal commas, numbers that are missing.
#pragma once

#include <span>
#include <string_view>

namespace fusebench::io {

/// No field is a number ("nan" and "inf" are numbers here), and two or more have a letter.
[[nodiscard]] bool is_line_of_names(std::span<const std::string_view> fields);

/// Numbers as "0,55" between blanks or semicolons: at least one, no number with a point but the first (some
/// programs write stamps so), and no comma outside of such numbers. "1, 2" and "1,2,3" have none.
[[nodiscard]] bool has_decimal_commas(std::string_view line);
inline constexpr std::string_view kDecimalCommaHint =
    "numbers have a decimal comma: write decimal points, for instance by `sed 's/,/./g'`";

/// "nan" in the spellings of C, C++, Python and MATLAB: any case, with a sign, and "nan(ind)".
[[nodiscard]] bool is_nan(std::string_view field);

}  // namespace fusebench::io
