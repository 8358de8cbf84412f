// Which runs of two folders are the same experiment.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::compare {

/// Keys of options by which runs may differ and still be the same experiment; one that ends with a dot stands
/// for all keys that begin so ("patches.").
using IgnoredOptions = std::vector<std::string>;
[[nodiscard]] bool is_ignored(const IgnoredOptions& ignored, std::string_view key);

/// The runs of one experiment on one side.
struct RunSide {
  std::vector<run_files::FoundRun> runs;  ///< of the first replicate; several are repetitions, by folder
  std::vector<run_files::FoundRun> replicates;  ///< all others, by replicate

  /// False of a program from outside that is not declared deterministic: its repetitions are like replicates,
  /// and all but the first run are among them.
  bool repeats_exactly = true;

  [[nodiscard]] bool empty() const { return runs.empty(); }
  [[nodiscard]] const run_files::FoundRun& front() const { return runs.front(); }
  /// Runs of different replicates, the first one included; of what does not repeat exactly, all runs.
  [[nodiscard]] std::size_t replicate_count() const;
  [[nodiscard]] std::vector<const run_files::FoundRun*> all() const;
};

/// The runs of one experiment on both sides.
struct RunPair {
  run_files::RunIdentity experiment;  ///< of experiment_of()
  std::string label;                  ///< "fr1_rpy/full", with what else tells it from the others
  RunSide base;
  RunSide fresh;  ///< of NEW
};

/// The identity that the same run has in every version of the program: without_repetition(), and without the
/// content of the recording and the values of options that were not edited, so that a changed default or
/// image is a difference of one experiment and not another experiment. An option that is edited to its
/// default counts as not edited, and so does an ignored one. Values are TOML text; options are sorted.
[[nodiscard]] run_files::RunIdentity experiment_of(const run_files::FoundRun& run,
                                                   const IgnoredOptions& ignored = {});

/// "iekf.max_iterations=3, tsdf.voxel_m=0.02"; empty without options.
[[nodiscard]] std::string options_text(const run_files::RunIdentity& experiment);

/// Every run is in one pair, of which a side may be empty. A run that failed before its recording was open
/// does not know its frames: it goes to the only pair of its recording, variant and options, if there is one.
/// So does a run over other images of as many or as few frames. By recording, then variant in the order of
/// all_variants().
[[nodiscard]] std::vector<RunPair> pair_runs(std::vector<run_files::FoundRun> base,
                                             std::vector<run_files::FoundRun> fresh,
                                             const IgnoredOptions& ignored = {});

/// Sentences about runs without a counterpart: which options alone, or which variants alone, tell runs of
/// BASE from runs of NEW, and how these can be compared. At most one of each kind.
[[nodiscard]] std::vector<std::string> unpaired_notes(std::span<const RunPair> pairs);

}  // namespace fusebench::compare
