// The runs of a reproduction, each once however many readings it serves.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/reproduction/table1_protocol.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::reproduction {

/// The two runs that a reading compares on a recording.
struct ComparedRuns {
  std::size_t reading = 0;  ///< of the protocol
  std::string group;
  std::string recording;
  std::size_t dm = 0;  ///< number of the job
  std::size_t ours = 0;
};

struct Table1Plan {
  std::vector<engine::BatchJob> jobs;  ///< by recording, so that each one's images are read in a row
  std::vector<ComparedRuns> compared;
  std::vector<std::string> absent;  ///< "fr1_desk: no such folder ...": what could not be planned
};

/// Which runs of a reproduction are made.
struct Table1Extent {
  std::vector<std::string> readings;  ///< by name; empty: all
  /// The factorial over all recordings, and not only over the first one of each column.
  bool factorial_everywhere = false;
};

/// `options`: its `sets` are for all runs. Recordings and trajectories that are not there are left out.
/// Errors: those of plan_batch() for everything else; usage for a reading that is none.
[[nodiscard]] Result<Table1Plan> plan_table1(const Table1Protocol& protocol, const suites::Suite& recordings,
                                             const engine::BatchOptions& options, const Table1Extent& extent);

}  // namespace fusebench::reproduction
