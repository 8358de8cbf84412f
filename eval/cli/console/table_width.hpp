// The width of text tables; wider ones are folded (eval/text/folded_table.hpp).
#pragma once

#include <cstddef>
#include <optional>

namespace CLI {
class App;
}

namespace fusebench::cli::console {

/// --width
void add_width_option(CLI::App& verb, std::optional<std::size_t>& width);

/// Characters of a line; 0: any number. Without --width: of a terminal its own width, else COLUMNS,
/// else 100; 0 if standard output is no terminal, or if the format was given (Markdown is usually copied).
[[nodiscard]] std::size_t table_width(const std::optional<std::size_t>& asked, bool format_was_named = false);

}  // namespace fusebench::cli::console
