// What one run is asked to do, and the recording as it sees it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "datasets/open_recording.hpp"
#include "eval/external/external_program.hpp"

namespace fusebench::run {

/// Which IMU a variant that needs one gets.
enum class ImuChoice {
  recorded,   ///< the recording's own; without one, the run is refused
  synthetic,  ///< one made from the ground truth, even if the recording has its own
  automatic,  ///< the recording's own, and where there is none, one made from the ground truth
};

/// Frames begin to end - 1, or to the last.
struct FrameWindow {
  std::size_t begin = 0;
  std::optional<std::size_t> end;
};
/// "A:B" to frames A to B-1, "A:" to all from A on. Error usage.
[[nodiscard]] Result<FrameWindow> parse_window(const std::string& text);
[[nodiscard]] std::string to_string(const FrameWindow& window);  ///< "A:B" or "A:"

/// Cuts the recording to the window. Errors: those of select_frames().
[[nodiscard]] Result<void> select_window(recording::Recording& recording, const FrameWindow& window);

/// A recording as it is read with these options, cut to the window if there is one. Errors: those of
/// open_recording() and select_frames().
[[nodiscard]] Result<recording::Recording> open_window(const std::filesystem::path& recording,
                                                       const datasets::OpenOptions& options,
                                                       const std::optional<FrameWindow>& window);

/// Which files a run's folder keeps. In large sweeps the others would fill the disk.
enum class KeptFiles {
  all,
  small,  ///< record, trajectories, frames.csv, nees.csv, log, and trace.json of a profiled run: no model,
          ///< patches, states or pixels
};
[[nodiscard]] std::string_view to_string(KeptFiles kept);  ///< "all", "small"

/// What the command line, suites and kept invocations take.
inline constexpr int kMostThreads = 1024;  ///< of a run
inline constexpr int kMostAtOnce = 1024;   ///< runs
inline constexpr int kMostRepetitions = 1000;
inline constexpr int kMostReplicates = 1000;

struct RunSpec {
  std::filesystem::path recording;
  datasets::OpenOptions open;
  ImuChoice imu = ImuChoice::recorded;
  std::string variant;             ///< or the name of the program
  config::EffectiveConfig config;  ///< the variant's, with all edits; a program's evaluation by defaults
  /// What runs in place of a system of this program.
  std::shared_ptr<const external::ExternalProgram> program = {};
  std::optional<FrameWindow> frames;
  int threads = 1;
  int repetition = 1;  ///< the time is another sample; so are a program's results, unless it is deterministic
  int replicate = 0;   ///< above 0: begins at trajectory::noisy_pose(); of a program it is another seed
  bool prepare = false;  ///< first measure what the calibration leaves open (preparation.hpp)
  KeptFiles kept = KeptFiles::all;
  bool profile = false;  ///< also trace.json and the record's histograms of times; no part of the identity
  std::filesystem::path out;
};

/// Whether the run is of the paper's filter and not of another system or program.
[[nodiscard]] bool runs_filter(const RunSpec& spec);

/// What {seed} of an external program stands for: another number for each repetition and replicate.
[[nodiscard]] int seed_of(const RunSpec& spec);

/// Whether the run first measures constants of the recording's sensors. External programs do not get them.
[[nodiscard]] bool is_prepared(const RunSpec& spec, const recording::Recording& recording);

/// Whether the run needs inertial samples.
[[nodiscard]] bool wants_imu(const RunSpec& spec);

/// A sentence on edited options that the configuration's system is known not to have, as loops.mode of one
/// that is not the filter; nothing if there are none.
[[nodiscard]] std::optional<std::string> options_without_effect(const config::EffectiveConfig& config);

/// An opened recording as a run of that specification sees it: cut to the window, with its IMU. Errors: those
/// of select_frames and add_synthetic_imu; usage if the variant needs an IMU and there is none.
[[nodiscard]] Result<recording::Recording> view_for_run(recording::Recording whole, const RunSpec& spec);

/// open_recording() and view_for_run().
[[nodiscard]] Result<recording::Recording> open_for_run(const RunSpec& spec);

}  // namespace fusebench::run
