// The specification of a run, and the recording with its window and IMU.
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
#include "eval/record/external/external_program.hpp"

namespace fusebench::run {

/// The inertial samples of a variant with an IMU.
enum class ImuChoice {
  recorded,   ///< the recording's own; an error if there are none
  synthetic,  ///< made from the ground truth, even if the recording has its own
  automatic,  ///< the recording's own, else made from the ground truth
};

/// Frames begin to end - 1, or to the last.
struct FrameWindow {
  std::size_t begin = 0;
  std::optional<std::size_t> end;
};
/// "A:B" to frames A to B-1, "A:" to all from A on, ":B" to the first B. Error usage.
[[nodiscard]] Result<FrameWindow> parse_window(const std::string& text);
[[nodiscard]] std::string to_string(const FrameWindow& window);  ///< "A:B" or "A:"

/// Cuts the recording to the window. Errors: those of select_frames().
[[nodiscard]] Result<void> select_window(recording::Recording& recording, const FrameWindow& window);

/// A recording as it is read with these options, cut to the window if there is one. Errors: those of
/// open_recording() and select_frames().
[[nodiscard]] Result<recording::Recording> open_window(const std::filesystem::path& recording,
                                                       const datasets::OpenOptions& options,
                                                       const std::optional<FrameWindow>& window);

/// The files that a run's folder keeps.
enum class KeptFiles {
  all,
  small,  ///< record, trajectories, frames.csv, nees.csv, log, and trace.json of a profiled run: no model,
          ///< patches, states or pixels
};
[[nodiscard]] std::string_view to_string(KeptFiles kept);  ///< "all", "small"

/// Limits of the command line, suites and stored invocations.
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
  /// The external program that runs instead of a system of this program, or null.
  std::shared_ptr<const external::ExternalProgram> program = {};
  std::optional<FrameWindow> frames;
  int threads = 1;
  int repetition = 1;    ///< a further sample of time, and of a non-deterministic program's results
  int replicate = 0;     ///< above 0: starts at trajectory::noisy_pose(), a program with another seed
  bool prepare = false;  ///< measures the timing that the calibration does not contain (preparation.hpp)
  KeptFiles kept = KeptFiles::all;
  bool profile = false;  ///< also trace.json and the record's histograms of times; no part of the identity
  std::filesystem::path out;
};

/// Whether the run is of the paper's filter and not of another system or program.
[[nodiscard]] bool runs_filter(const RunSpec& spec);

/// The value of {seed} for an external program: different for each repetition and replicate.
[[nodiscard]] int seed_of(const RunSpec& spec);

/// Whether the run first measures constants of the recording's sensors. External programs do not get them.
[[nodiscard]] bool is_prepared(const RunSpec& spec, const recording::Recording& recording);

/// Whether the run needs inertial samples.
[[nodiscard]] bool wants_imu(const RunSpec& spec);

/// A sentence on edited options that the configured system does not use, such as loops.mode of another system
/// than the filter; nullopt if there are none.
[[nodiscard]] std::optional<std::string> options_without_effect(const config::EffectiveConfig& config);

/// Cuts an opened recording to the window of the specification and sets its IMU. Errors: those
/// of select_frames and add_synthetic_imu; usage if the variant needs an IMU and there is none.
[[nodiscard]] Result<recording::Recording> view_for_run(recording::Recording whole, const RunSpec& spec);

/// open_recording() and view_for_run().
[[nodiscard]] Result<recording::Recording> open_for_run(const RunSpec& spec);

}  // namespace fusebench::run
