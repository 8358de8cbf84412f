// Verbs that say what there is.
#pragma once

#include "eval/cli/verb.hpp"

namespace fusebench {

[[nodiscard]] Verb add_list_verb(CLI::App& app);
[[nodiscard]] Verb add_config_verb(CLI::App& app);

}  // namespace fusebench
