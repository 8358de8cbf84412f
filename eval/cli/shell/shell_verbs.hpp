// Verbs that write completion scripts and manual pages.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::shell {

/// Both describe the verbs that `app` has when they run.
[[nodiscard]] console::Verb add_completion_verb(CLI::App& app);
/// Hidden; used to build packages.
[[nodiscard]] console::Verb add_manual_verb(CLI::App& app);

}  // namespace fusebench::cli::shell
