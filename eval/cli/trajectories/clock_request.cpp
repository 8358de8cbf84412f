#include "eval/cli/trajectories/clock_request.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "core/base/trajectory/trajectory.hpp"
#include "eval/metrics/trajectory_files/stamps.hpp"

namespace fusebench::cli::trajectories {

void add_clock_option(CLI::App& verb, bool& fit_time_offset, const char* what_it_does) {
  verb.add_flag("--fit-time-offset,--fit_time_offset", fit_time_offset, what_it_does);
}

Result<reference_clock::ReferenceClock> fit_clock(const Sides& sides,
                                                  const trajectory_error::TrajectoryRequest& request,
                                                  trajectory_error::TrajectoryEvaluation& evaluation) {
  if (!sides.have_stamps())
    return fail(ErrorCode::usage, "--fit-time-offset: the trajectories have no stamps (kitti)");
  const trajectory_files::AssociationOptions& association = request.association;
  Trajectory reference = sides.reference.poses;
  std::erase_if(reference, [&](const StampedPose& pose) {
    const double time_s = trajectory_files::stamp_seconds(pose.timestamp_ns);
    return time_s < association.start_s || time_s > association.end_s;
  });
  auto clock = reference_clock::fitted_reference_clock(
      reference, trajectory::with_clock_offset(sides.estimate.poses,
                                               trajectory_files::nanoseconds(association.offset_s)));
  if (!clock) return clock;
  trajectory_error::TrajectoryRequest shifted = request;
  shifted.association.offset_s += clock->offset.offset_s;
  shifted.keep_poses = false;
  auto fitted = trajectory_error::evaluate(sides.reference.poses, sides.estimate.poses, shifted);
  if (!fitted) return tl::unexpected(fitted.error());
  for (trajectory_error::ErrorSeries& series : fitted->series) {
    series.relation += "_clock_fitted";
    evaluation.series.push_back(std::move(series));
  }
  return clock;
}

}  // namespace fusebench::cli::trajectories
