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

struct PlannedRecordings {
  std::vector<PlannedRecording> present;  ///< existing recordings, then the simulated ones
  std::vector<std::string> absent;        ///< "NAME: SOURCE" of absent recordings that have a source
};

/// Recordings that --only leaves out need not exist. Errors: usage (a filter that names no recording),
/// data_missing (a recording without a source, or a
/// trajectory, does not exist; or all recordings are absent), configuration (two of one name).
[[nodiscard]] Result<PlannedRecordings> planned_recordings(const Suite& suite, const RecordingChoice& choice);

}  // namespace fusebench::suites
