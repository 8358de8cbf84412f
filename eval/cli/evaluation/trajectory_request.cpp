#include "eval/cli/evaluation/trajectory_request.hpp"

#include <fmt/format.h>

#include "eval/trajectory_files/stamped_list.hpp"

namespace fusebench::cli::evaluation {

namespace {

Result<void> set_alignment(const TrajectoryOptions& options, trajectory_error::TrajectoryRequest& request) {
  const bool evo = options.evo_align || options.evo_scale || options.evo_origin;
  if (!options.align.empty() && evo)
    return fail(ErrorCode::usage, "--align and evo's -a, -s or --align_origin exclude each other");
  if (options.evo_align && options.evo_origin)
    return fail(ErrorCode::usage, "-a and --align_origin exclude each other");
  if (!options.align.empty()) request.alignment.mode = named(kAlignments, options.align);
  if (options.evo_align)
    request.alignment.mode =
        options.evo_scale ? trajectory_error::AlignmentMode::sim3 : trajectory_error::AlignmentMode::se3;
  if (options.evo_scale && !options.evo_align)
    request.alignment.mode = trajectory_error::AlignmentMode::scale;
  if (options.evo_origin) {
    request.alignment.mode = trajectory_error::AlignmentMode::origin;
    request.alignment.scale_origin = options.evo_scale;
  }
  request.alignment.first = options.n_to_align;
  return {};
}

Result<void> set_association(const TrajectoryOptions& options, trajectory_error::TrajectoryRequest& request) {
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
    return fail(ErrorCode::usage, "--images is for --protocol eth3d, which compares at the stamps of images");
  auto stamps = trajectory_files::read_stamps(options.images);
  if (!stamps) return tl::unexpected(stamps.error());
  association.evaluated_ns = std::move(*stamps);
  return {};
}

Result<void> set_motions(const TrajectoryOptions& options, trajectory_error::TrajectoryRequest& request) {
  const bool asked =
      options.delta || !options.delta_unit.empty() || options.all_pairs || options.pairs_from_reference;
  if (request.motions == trajectory_error::MotionRule::segments) {
    if (!asked) return {};
    return fail(ErrorCode::usage,
                fmt::format("protocol {} compares segments of its own lengths",
                            trajectory_error::to_string(request.protocol)),
                "--delta, --delta_unit, --all_pairs and --pairs_from_reference are for evo and tum");
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

/// "fusebench eval ate tum GT EST" is how evo is called.
Result<void> take_leading_format(TrajectoryOptions& options) {
  if (options.files.size() == 3) {
    if (!options.format.empty())
      return fail(ErrorCode::usage, "the format is given twice, before the files and with --format");
    options.format = options.files.front();
    options.files.erase(options.files.begin());
  }
  return {};
}

Result<trajectory_error::TrajectoryRequest> request_of(const TrajectoryOptions& options,
                                                       trajectory_error::TrajectoryMetric metric) {
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
  request->listing.needed = !options.errors.empty();
  constexpr std::size_t kMostInJson = std::size_t{1} << 20;  // 240 bytes each while the document is made
  if (options.json && options.errors.empty()) request->listing.most = kMostInJson;
  if (!options.motion_filter.empty())
    request->motion_filter =
        trajectory_error::MotionFilter{options.motion_filter[0], radians(options.motion_filter[1])};
  for (const auto& set : {set_alignment(options, *request), set_association(options, *request),
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
    return fail(ErrorCode::usage, "poses without stamps (kitti) cannot be compared by time",
                "`--protocol evo` goes by the number of the pose, with --delta in frames, metres or degrees");
  }
  request.association.rule = trajectory_files::AssociationRule::index;
  return {};
}

}  // namespace fusebench::cli::evaluation
