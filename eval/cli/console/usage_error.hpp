// Errors of a command line: the unsupported flag or verb, and the nearest supported one.
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

/// The error of arguments (without the program's name) that `program` rejected: the first unsupported verb or
/// flag, else the parser's error.
[[nodiscard]] Error usage_error(const CLI::App& program, const std::vector<std::string>& arguments,
                                const CLI::ParseError& complaint);

/// The first verb or flag of arguments (without the program's name) that `program` does not have. The parser
/// does not report these if help is requested.
[[nodiscard]] std::optional<Error> unknown_words(const CLI::App& program,
                                                 const std::vector<std::string>& arguments);

}  // namespace fusebench::cli::console
