// What tells the runs of one folder apart, in words for people.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "eval/run_files/found_runs.hpp"

namespace fusebench::run_files {

/// Whether an option of that origin was edited by somebody (a file, --set, a suite, a sweep), and is not what
/// the program or the variant says.
[[nodiscard]] bool is_edit(std::string_view origin);

/// What was asked of a run.
struct RunTraits {
  std::string recording;
  std::string variant;
  std::vector<std::pair<std::string, std::string>> edits;  ///< key and value text of edited options
  bool options_known = false;  ///< of a run of this program that wrote all of its options
  std::size_t first_frame = 0;
  std::size_t frames = 0;  ///< 0: not known
  int repetition = 1;
  int replicate = 0;
  std::string imu;     ///< "none", "recorded", "synthetic IMU"; empty: it never opened the recording
  std::string folder;  ///< its name
};
[[nodiscard]] RunTraits traits_of(const FoundRun& run);

/// The edits of each run that not all runs share, as "tsdf.voxel_m=0.01 depth.max_m=4"; empty where there are
/// none. A run that never wrote its options, and one of another program, has no say in what is shared.
[[nodiscard]] std::vector<std::string> differing_edits(std::span<const RunTraits> runs);

/// The edits that all of several runs share, in the same form.
[[nodiscard]] std::string shared_edits(std::span<const RunTraits> runs);

/// "frames 0:100" of each run where other frames of its recording were run as well; empty where not. A run
/// that does not know its frames belongs to the first window that begins where it does or later.
[[nodiscard]] std::vector<std::string> window_labels(std::span<const RunTraits> runs);

/// The IMU that each run used. One that never opened its recording has that of the runs of its variant, those
/// over its recording before others; empty where they differ.
[[nodiscard]] std::vector<std::string> imus_of_methods(std::span<const RunTraits> runs);

/// The variant of each run with differing_edits(), and with its IMU where runs of the variant differ in it:
/// the same for runs that may be averaged.
[[nodiscard]] std::vector<std::string> configuration_labels(std::span<const RunTraits> runs);

/// What tells each run from the others: differing_edits(); "frames 0:100" where other frames of its recording
/// were run as well; "repetition 2", "replicate 3" and the IMU where runs of its variant over its recording
/// differ in them; and at last the name of its folder, where nothing of that is different.
[[nodiscard]] std::vector<std::string> distinctions(std::span<const RunTraits> runs);

/// The variant of each run with its distinction: "full tsdf.voxel_m=0.01 repetition 2".
[[nodiscard]] std::vector<std::string> run_labels(std::span<const RunTraits> runs);

/// traits_of() of all.
[[nodiscard]] std::vector<RunTraits> traits_of(std::span<const FoundRun> runs);

}  // namespace fusebench::run_files
