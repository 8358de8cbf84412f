// Which runs of two folders are the same experiment.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/run_files/found_runs.hpp"

namespace fusebench::compare {

/// What was asked of a run. Options count only if somebody set them (in a file or by --set): a default that
/// has changed since must not make another experiment of it, or the change would go unseen.
struct RunKey {
  std::string recording;
  std::string variant;
  std::size_t first_frame = 0;
  std::size_t frames = 0;
  std::string imu;      ///< "none", "recorded", "synthetic IMU"
  std::string options;  ///< "iekf.max_iterations=3, tsdf.voxel_m=0.02"; empty if nothing was set

  friend bool operator==(const RunKey&, const RunKey&) = default;
};

/// The runs of one experiment on one side.
struct RunSide {
  std::vector<run_files::FoundRun> runs;  ///< of the first replicate; several are repetitions, by folder
  std::vector<run_files::FoundRun> replicates;  ///< all others, by replicate

  [[nodiscard]] bool empty() const { return runs.empty(); }
  [[nodiscard]] const run_files::FoundRun& front() const { return runs.front(); }
  /// Runs of different replicates, the first one included.
  [[nodiscard]] std::size_t replicate_count() const;
  [[nodiscard]] std::vector<const run_files::FoundRun*> all() const;
};

/// The runs of one experiment on both sides.
struct RunPair {
  RunKey key;
  std::string label;  ///< "fr1_rpy/full", with what else tells it from the others
  RunSide base;
  RunSide fresh;  ///< of NEW
};

[[nodiscard]] RunKey key_of(const record::RunRecord& record);

/// Every run is in one pair, of which a side may be empty. A run that failed before its recording was open
/// does not know its frames: it goes to the only pair of its recording, variant and options, if there is one.
/// A run whose record is damaged does not know its options either: it goes to that of its folder's name
/// first. So does a run over other images of as many or as few frames. By recording, then variant in the
/// order of all_variants().
[[nodiscard]] std::vector<RunPair> pair_runs(const std::vector<run_files::FoundRun>& base,
                                             const std::vector<run_files::FoundRun>& fresh);

}  // namespace fusebench::compare
