// The metrics of `fusebench eval`.
#pragma once

#include "eval/cli/verbs.hpp"

namespace fusebench {

[[nodiscard]] Verb add_eval_ate_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_rpe_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_nees_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_mesh_verb(CLI::App& eval);

}  // namespace fusebench
