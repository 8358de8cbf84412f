// Verbs that write what a shell and man read of this program.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::shell {

/// Both describe the verbs that `app` has when they run.
[[nodiscard]] console::Verb add_completion_verb(CLI::App& app);
/// Hidden: packages are built with it.
[[nodiscard]] console::Verb add_manual_verb(CLI::App& app);

}  // namespace fusebench::cli::shell
