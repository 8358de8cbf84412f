// A set of runs: which of them belong together, and labels that distinguish them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::run_files {

/// Lists have one element for each run, in the order of the runs.
class RunSet {
 public:
  explicit RunSet(std::vector<RunIdentity> runs) : runs_(std::move(runs)) {}
  explicit RunSet(std::span<const FoundRun> runs);

  [[nodiscard]] const std::vector<RunIdentity>& runs() const { return runs_; }

  /// The edited options of each run that not all runs share, as "tsdf.voxel_m=0.01 depth.max_m=4"; empty
  /// where there are none. Runs that did not write their options, and those of other programs, do not count
  /// in what is shared.
  [[nodiscard]] std::vector<std::string> differing_options() const;

  /// The edited options that all runs share, in the same form.
  [[nodiscard]] std::string shared_options() const;

  /// "frames 0:100" of a run that processed a part of its recording, empty of a run of the whole recording.
  /// Where records do not contain the frames of the whole recording, windows that begin at frame 0 and end
  /// last are the whole recording. A run whose frames are unknown belongs to the whole recording if it begins
  /// at frame 0 and another run is of the whole recording, else to the first window that begins at its first
  /// frame or later.
  [[nodiscard]] std::vector<std::string> window_labels() const;

  /// The IMU of each run. For a run that did not open its recording, that of the runs of its variant over the
  /// same recording, or else over all recordings; empty where these differ.
  [[nodiscard]] std::vector<std::string> imus() const;

  /// The variant of each run with differing_options().
  [[nodiscard]] std::vector<std::string> methods() const;

  /// methods(), with the IMU where runs of the variant differ in it: equal for
  /// runs that may be averaged.
  [[nodiscard]] std::vector<std::string> configuration_labels() const;

  /// What distinguishes each run from the others: differing_options(); window_labels(); "repetition 2",
  /// "replicate 3" and the IMU where runs of its variant over its recording differ in them; and the name of
  /// its folder where two runs are equal in all of these.
  [[nodiscard]] std::vector<std::string> distinctions() const;

  /// The variant of each run with its distinction: "full tsdf.voxel_m=0.01 repetition 2".
  [[nodiscard]] std::vector<std::string> labels() const;

  /// Indices of the runs that differ in their replicate only (without_replicate()), by replicate; a run
  /// without replicates is a group of its own. In the order of each group's first run. A replicate that
  /// occurs twice, as of imported trajectories, begins a new group.
  [[nodiscard]] std::vector<std::vector<std::size_t>> replicate_groups() const;

 private:
  std::vector<RunIdentity> runs_;
};

}  // namespace fusebench::run_files
