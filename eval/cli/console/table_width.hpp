// How wide the text tables of a verb may be: what does not fit is folded (eval/text/folded_table.hpp).
#pragma once

#include <cstddef>
#include <optional>

namespace CLI {
class App;
}

namespace fusebench::cli::console {

/// --width
void add_width_option(CLI::App& verb, std::optional<std::size_t>& width);

/// Characters of a line; 0: any number. Without --width, those of the terminal that standard output is: as it
/// says itself, else as COLUMNS says, else 100. Any number where that is none, and of a format that was asked
/// for by its name: who names Markdown is going to copy it.
[[nodiscard]] std::size_t table_width(const std::optional<std::size_t>& asked, bool format_was_named = false);

}  // namespace fusebench::cli::console
