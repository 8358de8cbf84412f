// Where the results of a run lie, and what is there already.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/run_files/found_runs.hpp"

namespace fusebench::run {

/// An opened recording with its place among the results; nothing is written yet.
struct PreparedRun {
  RunSpec spec;
  recording::Recording recording;  ///< the window, with the IMU that the run will use
  std::string run_id;              ///< run_identity()
  std::filesystem::path folder;    ///< <out>/<recording>/<variant>/<hash8>, with "-rN" for repetition N > 1
};

/// 32 hex digits: identifies the values of the configuration, the content of the recording and its window,
/// the camera, the IMU with the way it was made (seed, sensor, fit), and the version of the estimator
/// (BuildInfo::estimator), or in its place the external program. Runs of one identity have the same results.
[[nodiscard]] std::string run_identity(const RunSpec& spec, const recording::Recording& recording);

/// What engines ask of a run that is there.
struct RecordHead {
  record::RunStatus status = record::RunStatus::failed;
  std::string reason;
  std::string run_id;  ///< empty if the record does not say it, or cannot be read
  run_files::RunState state = run_files::RunState::whole;  ///< failed if it is not whole
  std::vector<std::string> missing{};                      ///< recorded files that are not there
  bool has_model = false;                                  ///< the run reconstructed something
};
[[nodiscard]] RecordHead head_of(const run_files::FoundRun& run);
/// Reads the whole record and looks at the sizes of the files. Nothing if there is no record in the folder.
[[nodiscard]] std::optional<RecordHead> record_head(const std::filesystem::path& folder);

/// Folders of runs that are planned, with their identities.
using TakenFolders = std::map<std::filesystem::path, std::string>;

/// Its place: that of its identity, with more digits if those are taken by another one, there or in `taken`.
[[nodiscard]] PreparedRun place_run(RunSpec spec, recording::Recording recording,
                                    const TakenFolders& taken = {});

/// open_for_run() and place_run(), after checking the relations between options (error configuration).
[[nodiscard]] Result<PreparedRun> prepare_run(RunSpec spec);

/// The record before anything has come out: what is asked, and what will make it. Status failed.
[[nodiscard]] record::RunRecord requested_record(const PreparedRun& run);

}  // namespace fusebench::run
