// The verbs of `fusebench eval` about trajectories, with evo's names of everything.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::trajectories {

[[nodiscard]] console::Verb add_eval_ate_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_rpe_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_traj_verb(CLI::App& eval);
[[nodiscard]] console::Verb add_eval_res_verb(CLI::App& eval);

}  // namespace fusebench::cli::trajectories
