// What the text of a row looks like: names, decimal commas, numbers that are missing.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench::io {

/// No field is a number (also none that is missing or infinite), and two or more have a letter.
[[nodiscard]] bool is_line_of_names(std::span<const std::string_view> fields);

/// The names in a line, without '#' or '%' before them, units included: "#ts (ns),tx (m)" has "ts (ns)" and
/// "tx (m)". Names are separated by commas if there are any, else by blanks. Words before a colon, as in
/// "# format: timestamp tx", are no names.
[[nodiscard]] std::vector<std::string> column_names(std::string_view line);

/// Names as TextTable::open() takes them: without units in brackets, blanks and commas, and "column_3" of a
/// column without a name.
[[nodiscard]] std::string as_columns(std::span<const std::string> names);

/// Numbers as "0,55" between blanks or semicolons: at least one, no number with a point but the first (some
/// programs write stamps so), and no comma outside of such numbers. "1, 2" and "1,2,3" have none. Or such
/// numbers between commas: all fields are whole numbers, and one after the first begins as only decimals do
/// ("0,05"). Quotes do not count.
[[nodiscard]] bool has_decimal_commas(std::string_view line);
inline constexpr std::string_view kDecimalCommaHint =
    "write decimal points, for instance by LC_ALL=C before the command that writes the file; where blanks or "
    "semicolons separate the numbers, `sed 's/,/./g; s/;/ /g'` replaces the decimal commas";

/// What programs write for a number that there is not: nothing, nan, null, none, NA, N/A, "nan(ind)",
/// "1.#IND", "1.#QNAN"; any case, with a sign.
[[nodiscard]] bool is_missing(std::string_view field);

/// "inf", "infinity", "1.#INF"; any case, with a sign.
[[nodiscard]] bool is_infinite(std::string_view field);

}  // namespace fusebench::io
