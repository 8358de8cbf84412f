#include "eval/run/loop_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/loops/loop_tables.hpp"
#include "eval/loop_error/loop_error.hpp"

namespace fusebench::run {

namespace {

std::string counts_line(const loops::LoopClosure& closure) {
  const auto accepted = std::ranges::count_if(closure.candidates(), &loops::LoopCandidate::accepted);
  return fmt::format("loops: {} places, {} candidates, {} accepted, poses corrected {} times on the way\n",
                     closure.places().size(), closure.candidates().size(), accepted,
                     closure.online_corrections());
}

}  // namespace

LoopResults loop_results(const loops::LoopClosure* closure, const Trajectory& truth,
                         const PinholeCamera& camera, const config::DepthConfig& depth,
                         const config::LoopsConfig& loops) {
  if (closure == nullptr) return {};
  LoopResults results{
      loops::candidate_table(*closure), loops::place_table(*closure), counts_line(*closure), {}};
  if (truth.empty()) return results;
  results.error = record::Outcome<loop_error::LoopError>::from(
      loop_error::loop_error(*closure, truth, camera, depth, loops));
  return results;
}

}  // namespace fusebench::run
