// Verbs that list variants, options and results.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli {

[[nodiscard]] console::Verb add_list_verb(CLI::App& app);
[[nodiscard]] console::Verb add_config_verb(CLI::App& app);

}  // namespace fusebench::cli
