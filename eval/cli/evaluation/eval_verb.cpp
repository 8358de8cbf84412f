#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "eval/cli/evaluation/eval_verbs.hpp"
#include "eval/cli/trajectories/trajectory_verbs.hpp"

namespace fusebench::cli::evaluation {

console::Verb add_eval_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "eval", "Evaluates a trajectory or a mesh of any system against its reference, by a named protocol");
  verb->require_subcommand(1);
  const auto metrics = std::make_shared<std::vector<console::Verb>>();
  metrics->push_back(trajectories::add_eval_ate_verb(*verb));
  metrics->push_back(trajectories::add_eval_rpe_verb(*verb));
  metrics->push_back(trajectories::add_eval_traj_verb(*verb));
  metrics->push_back(trajectories::add_eval_res_verb(*verb));
  metrics->push_back(add_eval_nees_verb(*verb));
  metrics->push_back(add_eval_silent_verb(*verb));
  metrics->push_back(add_eval_mesh_verb(*verb));
  metrics->push_back(add_eval_aie_verb(*verb));
  return {verb, [metrics]() -> Result<int> {
            for (const console::Verb& metric : *metrics) {
              if (metric.app->parsed()) return metric.run();
            }
            return fail(ErrorCode::usage, "no metric is given", "`fusebench eval --help` lists them");
          }};
}

}  // namespace fusebench::cli::evaluation
