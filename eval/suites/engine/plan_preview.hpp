// What a plan would do, before it is done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::engine {

/// Of a run that nothing is known of.
inline constexpr double kGuessPerFrame_s = 0.05;

enum class JobState {
  finished,  ///< is there, ok or lost
  failed,    ///< is there as failed: would be tried again
  waiting,   ///< not there
  unknown,   ///< its recording is not there yet, or cannot be opened
};

struct PlannedRun {
  std::string name;  ///< to_string() of the job
  JobState state = JobState::waiting;
  std::string note;   ///< why the state is unknown
  double time_s = 0;  ///< that it will take: that of finished runs like it, or a guess from its frames
};

struct PlanPreview {
  std::vector<PlannedRun> runs;
  std::size_t finished = 0;
  std::size_t failed = 0;
  std::size_t waiting = 0;
  std::size_t unknown = 0;
  std::size_t guessed = 0;  ///< of those to do: without a finished run like it
  double time_s = 0;        ///< of what is to do, one after the other
};

/// Opens the recordings that are there, and looks at the runs in the plan's folder; writes nothing.
[[nodiscard]] PlanPreview preview_of(const BatchPlan& plan);

/// A table of the runs, what is excluded and why, and a summary with the time at so many at once.
[[nodiscard]] std::string to_text(const PlanPreview& preview, const BatchPlan& plan, int at_once);
[[nodiscard]] std::string to_json(const PlanPreview& preview, const BatchPlan& plan, int at_once);

}  // namespace fusebench::engine
