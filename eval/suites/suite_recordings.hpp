// The recordings that a suite asks for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/only_filters.hpp"
#include "eval/suites/simulation_request.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::suites {

/// A recording of the suite with what its jobs need to know.
struct PlannedRecording {
  std::filesystem::path folder;
  std::string group;
  std::string split;
  std::vector<std::string> variants;
  std::optional<SimulationRequest> simulation = {};
};

/// Where they are, and which of them.
struct RecordingChoice {
  const std::filesystem::path& data;
  const std::filesystem::path& simulated;  ///< where the suite's simulated ones are, or will be
  const OnlyFilters& only;
};

/// Those that are there, and then the simulated ones. What --only leaves out need not be there. Errors:
/// data_missing (a recording or a trajectory that is not there), configuration (two of one name).
[[nodiscard]] Result<std::vector<PlannedRecording>> planned_recordings(const Suite& suite,
                                                                       const RecordingChoice& choice);

}  // namespace fusebench::suites
