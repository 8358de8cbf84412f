// Manual pages (man) of the program and its verbs, from their help texts.
#pragma once

#include <string>
#include <string_view>

#include "eval/cli/shell/verb_description.hpp"

namespace fusebench::cli::shell {

/// "fusebench-eval-ate": the name of a verb's page.
[[nodiscard]] std::string manual_name(const VerbDescription& verb);

/// In the language of man(7), for section 1. `version` is printed in the footer; `program` is the
/// top-level verb. Pages have no date, so that they are reproducible.
[[nodiscard]] std::string manual_page(const VerbDescription& verb, const VerbDescription& program,
                                      std::string_view version);

}  // namespace fusebench::cli::shell
