#include "eval/run/loop_results.hpp"

#include "core/loops/loop_tables.hpp"

namespace fusebench::run {

LoopResults loop_results(const PreparedRun& run, const loops::LoopClosure* closure, const Trajectory& truth) {
  if (closure == nullptr) return {};
  LoopResults results{loops::candidate_table(*closure), loops::place_table(*closure), {}};
  if (truth.empty()) return results;
  results.error = record::Outcome<loop_error::LoopError>::from(
      loop_error::loop_error(*closure, truth, run.recording.rig.camera, run.spec.config.values));
  return results;
}

}  // namespace fusebench::run
