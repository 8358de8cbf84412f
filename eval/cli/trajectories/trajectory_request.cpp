#include "eval/cli/trajectories/trajectory_request.hpp"

#include <fmt/format.h>

#include "eval/cli/trajectories/evo_spelling.hpp"
#include "eval/metrics/trajectory_files/stamped_list.hpp"

namespace fusebench::cli::trajectories {

namespace {

Result<void> set_association(const TrajectoryOptions& options, trajectory_error::TrajectoryRequest& request,
                             std::vector<std::string>& warnings) {
  trajectory_files::AssociationOptions& association = request.association;
  if (options.interpolate) {
    constexpr double kUsualGap_s = 0.1;
    association.rule = trajectory_files::AssociationRule::interpolated;
    association.max_difference_s = kUsualGap_s;
  }
  if (options.t_max_diff) association.max_difference_s = *options.t_max_diff;
  association.offset_s = options.t_offset;
  if (options.t_start) association.start_s = *options.t_start;
  if (options.t_end) association.end_s = *options.t_end;
  if (options.images.empty()) return {};
  if (request.protocol != trajectory_error::Protocol::eth3d)
    return fail(ErrorCode::usage, "--images requires --protocol eth3d");
  auto stamps = trajectory_files::read_stamps(options.images, warnings);
  if (!stamps) return tl::unexpected(stamps.error());
  association.evaluated_ns = std::move(*stamps);
  return {};
}

Result<void> set_motions(const TrajectoryOptions& options, trajectory_error::TrajectoryRequest& request) {
  const bool asked =
      options.delta || !options.delta_unit.empty() || options.all_pairs || options.pairs_from_reference;
  if (request.motions == trajectory_error::MotionRule::segments) {
    if (!asked) return {};
    return fail(
        ErrorCode::usage,
        fmt::format("protocol {} uses segments of fixed lengths",
                    trajectory_error::to_string(request.protocol)),
        "--delta, --delta_unit, --all_pairs and --pairs_from_reference require --protocol evo or tum");
  }
  if (!options.delta_unit.empty()) {
    const auto unit = trajectory_error::parse_delta_unit(options.delta_unit);
    if (!unit) return tl::unexpected(unit.error());
    request.delta.unit = *unit;
  }
  if (options.delta) request.delta.value = *options.delta;
  if (options.all_pairs)
    request.motions = request.protocol == trajectory_error::Protocol::tum
                          ? trajectory_error::MotionRule::each_to_each
                          : trajectory_error::MotionRule::all;
  request.delta_tolerance = options.delta_tol;
  request.from_reference = options.pairs_from_reference;
  return {};
}

}  // namespace

Result<void> take_two_files(TrajectoryOptions& options) {
  if (auto taken = take_leading_format(options.files, options.format); !taken) return taken;
  const std::size_t count = options.files.size();
  if (count == 2) return {};
  std::error_code ignored;
  if (count == 3 && !std::filesystem::is_regular_file(options.files.front(), ignored))
    return trajectory_files::parse_trajectory_format(options.files.front()).map([](auto) {});
  return fail(
      ErrorCode::usage,
      fmt::format("two files are required, GT and EST; {} {} given", count, count == 1 ? "is" : "are"),
      "an optional format comes first: tum, kitti, euroc, log or openvins");
}

Result<trajectory_error::TrajectoryRequest> request_of(const TrajectoryOptions& options,
                                                       trajectory_error::TrajectoryMetric metric,
                                                       std::vector<std::string>& warnings) {
  if (options.all_errors && !options.json)
    return fail(ErrorCode::usage, "--all_errors requires --json",
                "--errors FILE.csv writes each error with its stamp");
  const auto protocol = trajectory_error::parse_protocol(options.protocol);
  if (!protocol) return tl::unexpected(protocol.error());
  auto request = trajectory_error::request_for(*protocol, metric);
  if (!request) return request;
  const auto relation = trajectory_error::parse_pose_relation(options.relation);
  if (!relation) return tl::unexpected(relation.error());
  request->relation = *relation;
  request->plane = named(kPlanes, options.plane);
  request->downsample = options.downsample;
  request->fit_offset = options.fit_offset;
  request->keep_poses = !options.save_results.empty() || options.plot.asked();
  request->listing.needed = request->keep_poses || !options.errors.empty() || options.all_errors;
  constexpr std::size_t kMostInJson = std::size_t{1} << 20;  // 240 bytes each while the document is made
  if (options.all_errors) request->listing.most = kMostInJson;
  if (!options.motion_filter.empty())
    request->motion_filter =
        trajectory_error::MotionFilter{options.motion_filter[0], radians(options.motion_filter[1])};
  const auto alignment = aligned_by(options.alignment, request->alignment);
  if (!alignment) return tl::unexpected(alignment.error());
  request->alignment = *alignment;
  for (const auto& set : {set_association(options, *request, warnings),
                          metric == trajectory_error::TrajectoryMetric::rpe ? set_motions(options, *request)
                                                                            : Result<void>{}}) {
    if (!set) return tl::unexpected(set.error());
  }
  return request;
}

Result<void> suit_stamps(const Sides& sides, trajectory_error::TrajectoryRequest& request) {
  const bool reference = sides.reference.has_stamps();
  const bool estimate = sides.estimate.has_stamps();
  if (reference != estimate) {
    return fail(ErrorCode::usage,
                fmt::format("the {} has no stamps (kitti), the {} has", reference ? "estimate" : "reference",
                            reference ? "reference" : "estimate"),
                "use two trajectories with stamps, or two without");
  }
  if (reference) {
    if (request.association.rule == trajectory_files::AssociationRule::index)
      request.association.rule = trajectory_files::AssociationRule::nearest;
    return {};
  }
  const bool by_time = request.metric == trajectory_error::TrajectoryMetric::rpe &&
                       (request.motions == trajectory_error::MotionRule::fixed_delta ||
                        request.delta.unit == trajectory_error::DeltaUnit::seconds);
  if (by_time || request.association.rule == trajectory_files::AssociationRule::held ||
      request.association.rule == trajectory_files::AssociationRule::interpolated) {
    return fail(
        ErrorCode::usage, "poses without stamps (kitti) cannot be compared by time",
        "`--protocol evo` associates poses by their index, with --delta in frames, metres or degrees");
  }
  request.association.rule = sides.rule_without_stamps();
  return {};
}

}  // namespace fusebench::cli::trajectories
