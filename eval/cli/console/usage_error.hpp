// What is wrong with a command line, in the words of the command line: the flag that is not understood, and
// the nearest one that is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace fusebench::cli::console {

/// The error of arguments (without the program's name) that `program` did not take: the first verb or flag
/// that it does not know, else what the parser complains of.
[[nodiscard]] Error usage_error(const CLI::App& program, const std::vector<std::string>& arguments,
                                const CLI::ParseError& complaint);

/// The first verb or flag of arguments (without the program's name) that `program` does not know. The parser
/// itself does not complain of them where help is asked for.
[[nodiscard]] std::optional<Error> unknown_words(const CLI::App& program,
                                                 const std::vector<std::string>& arguments);

}  // namespace fusebench::cli::console
