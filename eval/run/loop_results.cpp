#include "eval/run/loop_results.hpp"

#include "core/loops/loop_tables.hpp"
#include "eval/record/record_origin.hpp"

namespace fusebench::run {

LoopResults loop_results(const PreparedRun& run, const loops::LoopClosure* closure) {
  if (closure == nullptr) return {};
  LoopResults results{loops::candidate_table(*closure), loops::place_table(*closure), {}};
  const Trajectory truth = record::true_trajectory(run.recording, record::frame_stamps(run.recording));
  if (truth.empty()) return results;
  results.error = record::Outcome<loop_error::LoopError>::from(
      loop_error::loop_error(*closure, truth, run.recording.rig.camera, run.spec.config.values));
  return results;
}

}  // namespace fusebench::run
