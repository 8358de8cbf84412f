// The folder of a run by its identity, and the run that it contains.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/run/run_specification.hpp"

namespace fusebench::run {

/// An opened recording with the run's folder, which is not created yet.
struct PreparedRun {
  RunSpec spec;
  recording::Recording recording;  ///< the window, with the IMU that the run will use
  std::string run_id;              ///< run_identity()
  std::filesystem::path folder;    ///< <out>/<recording>/<variant>/<hash8>, with "-rN" for repetition N > 1
};

/// 32 hex digits: identifies the values of the configuration, the content of the recording and its window,
/// the camera, the IMU with the way it was made (seed, sensor, fit), and the version of the estimator
/// (BuildInfo::estimator) or the external program. Runs of one identity have the same results.
[[nodiscard]] std::string run_identity(const RunSpec& spec, const recording::Recording& recording);

/// The summary of an existing run for engines.
struct RecordHead {
  record::RunStatus status = record::RunStatus::failed;
  std::string reason;
  std::string run_id;                                      ///< empty if missing or unreadable
  run_files::RunState state = run_files::RunState::whole;  ///< failed if it is not whole
  std::vector<std::string> missing{};                      ///< recorded files that do not exist
  bool has_model = false;                                  ///< the run reconstructed something
};
[[nodiscard]] RecordHead head_of(const run_files::FoundRun& run);
/// Reads the record and checks the sizes of the files. nullopt if the folder has no record.
[[nodiscard]] std::optional<RecordHead> record_head(const std::filesystem::path& folder);

/// Identities of planned runs by their folders.
using TakenFolders = std::map<std::filesystem::path, std::string>;

/// The folder of the identity, with more digits if another identity has it on disk or in `taken`.
[[nodiscard]] PreparedRun place_run(RunSpec spec, recording::Recording recording,
                                    const TakenFolders& taken = {});

/// open_for_run() and place_run(), after checking the relations between options (error configuration).
[[nodiscard]] Result<PreparedRun> prepare_run(RunSpec spec);

/// The record before the run: specification, recording and program; status failed.
[[nodiscard]] record::RunRecord requested_record(const PreparedRun& run);

}  // namespace fusebench::run
