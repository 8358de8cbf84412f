// Verbs that show and compare runs.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::results {

[[nodiscard]] console::Verb add_table_verb(CLI::App& app);
[[nodiscard]] console::Verb add_report_verb(CLI::App& app);
[[nodiscard]] console::Verb add_compare_verb(CLI::App& app);

}  // namespace fusebench::cli::results
