// Verbs that show runs and hold them against each other.
#pragma once

#include "eval/cli/verb.hpp"

namespace fusebench {

[[nodiscard]] Verb add_table_verb(CLI::App& app);
[[nodiscard]] Verb add_report_verb(CLI::App& app);
[[nodiscard]] Verb add_compare_verb(CLI::App& app);

}  // namespace fusebench
