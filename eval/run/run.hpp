// One specification in, one record and one folder out. The only place that knows recordings, estimator and
// metrics.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "datasets/open_recording.hpp"
#include "eval/record/record.hpp"
#include "eval/run_files/found_runs.hpp"

namespace fusebench::run {

/// Which IMU a variant that needs one gets.
enum class ImuChoice {
  recorded,   ///< the recording's own; without one, the run is refused
  synthetic,  ///< one made from the ground truth, even if the recording has its own
  automatic,  ///< the recording's own, and where there is none, one made from the ground truth
};

/// Frames begin to end - 1.
struct FrameWindow {
  std::size_t begin = 0;
  std::size_t end = 0;
};
/// "A:B" to frames A to B-1. Error usage.
[[nodiscard]] Result<FrameWindow> parse_window(const std::string& text);

/// Which files a run's folder keeps. In large sweeps the others would fill the disk.
enum class KeptFiles {
  all,
  small,  ///< record, trajectories, frames.csv, nees.csv, log, and trace.json of a profiled run: no model,
          ///< patches, states or pixels
};
[[nodiscard]] std::string_view to_string(KeptFiles kept);  ///< "all", "small"

struct RunSpec {
  std::filesystem::path recording;
  datasets::OpenOptions open;
  ImuChoice imu = ImuChoice::recorded;
  std::string variant;
  config::EffectiveConfig config;  ///< the variant's, with all edits
  std::optional<FrameWindow> frames;
  int threads = 1;
  int repetition = 1;  ///< the results are the same, the time is another sample
  KeptFiles kept = KeptFiles::all;
  bool profile = false;  ///< also trace.json and the record's histograms of times; no part of the identity
  std::filesystem::path out;
};

/// An opened recording with its place among the results; nothing is written yet.
struct PreparedRun {
  RunSpec spec;
  recording::Recording recording;  ///< the window, with the IMU that the run will use
  std::string run_id;              ///< run_identity()
  std::filesystem::path folder;    ///< <out>/<recording>/<variant>/<hash8>, with "-rN" for repetition N > 1
};

/// 32 hex digits: identifies the values of the configuration, the content of the recording and its window,
/// the camera, the IMU with the way it was made (seed, sensor, fit), and the version of the estimator
/// (BuildInfo::estimator). Runs of one identity have the same results.
[[nodiscard]] std::string run_identity(const config::Config& config, const recording::Recording& recording);

/// The recording as a run of that specification sees it: opened, cut to the window, with its IMU. Errors:
/// those of open_recording, select_frames and add_synthetic_imu; usage if the variant needs an IMU and there
/// is none.
[[nodiscard]] Result<recording::Recording> open_for_run(const RunSpec& spec);

/// What engines ask of a run that is there.
struct RecordHead {
  record::RunStatus status = record::RunStatus::failed;
  std::string reason;
  std::string run_id;  ///< empty if the record does not say it, or cannot be read
  run_files::RunState state = run_files::RunState::whole;  ///< failed if it is not whole
  std::vector<std::string> missing{};                      ///< recorded files that are not there
};
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
[[nodiscard]] record::RunRecord record_of_question(const PreparedRun& run);

struct RunControl {
  std::function<void(std::size_t frame, std::size_t total)> progress = {};  ///< after each frame
  const std::atomic<bool>* stop =
      nullptr;  ///< checked at each frame; true ends the run and leaves nothing behind
  /// Bad data met on the way (a damaged image) makes a record with status failed, as a suite needs it, which
  /// goes on. Otherwise it is an error of the run like any bad data met on opening, and nothing is left
  /// behind.
  bool bad_data_is_recorded = true;
};

/// Runs it and puts its folder in place. A run that is lost or fails on the way is a record with that status
/// and its reason, and its folder holds what there is. Errors: io if the folder cannot be written, run_failed
/// if it was stopped, data_missing and data_corrupt if bad data is not recorded; nothing is left behind then.
[[nodiscard]] Result<record::RunRecord> execute_run(const PreparedRun& run, const RunControl& control = {});

}  // namespace fusebench::run
