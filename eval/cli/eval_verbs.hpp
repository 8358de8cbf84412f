// `fusebench eval` and its metrics.
#pragma once

#include "eval/cli/verb.hpp"

namespace fusebench {

[[nodiscard]] Verb add_eval_verb(CLI::App& app);

[[nodiscard]] Verb add_eval_ate_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_rpe_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_nees_verb(CLI::App& eval);
[[nodiscard]] Verb add_eval_mesh_verb(CLI::App& eval);

}  // namespace fusebench
