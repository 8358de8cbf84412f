// What a run's files say over time, ready to be drawn.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "eval/record/run_files/filter_tables.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/frame_table.hpp"
#include "eval/record/run_files/loop_table.hpp"

namespace fusebench::run_charts {

/// Where a tracked frame was, and where it should have been.
struct ComparedPose {
  std::int64_t timestamp_ns = 0;
  SE3 T_truth_camera;                ///< of the estimate, aligned as for the ATE
  std::optional<SE3> T_truth_truth;  ///< of the ground truth, associated as for the ATE; none without a pair
  double error_m = 0;                ///< distance of both, if it is
};

struct RunSeries {
  const run_files::FoundRun* run = nullptr;
  std::string label;       ///< the variant, with the run's name if there are several
  std::size_t colour = 1;  ///< of its curves, of the style's: one for a variant on all of a page
  std::vector<run_files::FrameTableRow> frames;  ///< none of an imported run
  std::int64_t start_ns = 0;                     ///< of the first image, which is time 0 of every chart
  std::vector<ComparedPose> poses;
  std::vector<ComparedPose> final_poses;  ///< as the system revised them at the end; none if it did not
  std::vector<run_files::CandidateRow> candidates;  ///< of loops; none of a run that did not look for them
  std::vector<run_files::PlaceRow> places;
  std::vector<run_files::NeesTableRow> nees;  ///< of simulated recordings, whose states are known
  Trajectory truth;                           ///< empty: not known
  SE3 T_first_world;  ///< the first of the poses that the model is of: models are shown in its frame
  std::vector<std::string> warnings;

  [[nodiscard]] double time_s(std::int64_t timestamp_ns) const {
    return seconds_between(start_ns, timestamp_ns);
  }
};

/// Reads the tables and trajectories of a run; what is not there or not readable stays empty, with a warning
/// where it should be there.
[[nodiscard]] RunSeries series_of(const run_files::FoundRun& run, std::string label);

/// Gives each series the colour that its variant has on every page; no two variants have the same.
void colour_by_variant(std::span<RunSeries> series);

}  // namespace fusebench::run_charts
