#include "eval/run/loop_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/loops/loop_tables.hpp"

namespace fusebench::run {

namespace {

std::string counts_line(const loops::LoopClosure& closure) {
  const auto accepted = std::ranges::count_if(closure.candidates(), &loops::LoopCandidate::accepted);
  return fmt::format("loops: {} places, {} candidates, {} accepted, poses corrected {} times on the way\n",
                     closure.places().size(), closure.candidates().size(), accepted,
                     closure.online_corrections());
}

}  // namespace

LoopResults loop_results(const PreparedRun& run, const loops::LoopClosure* closure, const Trajectory& truth) {
  if (closure == nullptr) return {};
  LoopResults results{
      loops::candidate_table(*closure), loops::place_table(*closure), counts_line(*closure), {}};
  if (truth.empty()) return results;
  results.error = record::Outcome<loop_error::LoopError>::from(
      loop_error::loop_error(*closure, truth, run.recording.rig.camera, run.spec.config.values));
  return results;
}

}  // namespace fusebench::run
