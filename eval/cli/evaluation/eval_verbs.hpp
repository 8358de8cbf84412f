// `fusebench eval` and its metrics.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::evaluation {

[[nodiscard]] console::Verb add_eval_verb(CLI::App& app);

[[nodiscard]] console::Verb add_eval_nees_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_silent_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_mesh_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_aie_verb(CLI::App& eval);

}  // namespace fusebench::cli::evaluation
