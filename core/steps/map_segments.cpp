#include "core/steps/map_segments.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/estimator/filter/moved_state.hpp"
#include "core/estimator/filter/pose_clones.hpp"

namespace fusebench::core {

void MapSegments::begin(const filter::GaussianState& reckoned_in_map) {
  Segment segment;
  segment.begin = reckoned_in_map.mean;
  segment.begin_covariance = reckoned_in_map.covariance.topLeftCorner<filter::kPoseSize, filter::kPoseSize>();
  segments_.push_back(segment);
  open_ = segments_.size();
}

void MapSegments::join(std::int64_t timestamp_ns, const SE3& T_map_camera, const SE3& T_segment_camera) {
  check(open_ > 0, "a segment is open");
  Segment& joined = segments_[open_ - 1];
  joined.joined_ns = timestamp_ns;
  joined.T_map_camera_at_join = T_map_camera;
  joined.T_camera_segment_at_join = T_segment_camera.inverse();
  open_ = 0;
}

/// An error of the pose at the start of the segment moves the whole segment, so it applies to pose, velocity
/// and gravity in the map.
filter::GaussianState MapSegments::in_map(const filter::GaussianState& in_segment) const {
  check(open_ > 0, "a segment is open");
  const Segment& segment = segments_[open_ - 1];
  filter::GaussianState result = filter::in_first_camera_world(in_segment);
  const filter::FilterState& now = result.mean;
  const Matrix3d R_begin = segment.begin.T_world_imu.rotation_matrix();
  Eigen::Matrix<double, filter::kStateSize, filter::kPoseSize> by_begin =
      Eigen::Matrix<double, filter::kStateSize, filter::kPoseSize>::Zero();
  by_begin.topRows<filter::kPoseSize>() = filter::pose_transport(now.T_world_imu, segment.begin.T_world_imu);
  by_begin.block<3, 3>(filter::kVelocity, 0) = -hat(now.velocity_world_mps) * R_begin;
  by_begin.block<2, 3>(filter::kGravity, 0) =
      -s2_basis(now.gravity_direction_world).transpose() * hat(now.gravity_direction_world) * R_begin;
  result.covariance += by_begin * segment.begin_covariance * by_begin.transpose();
  result.covariance = filter::symmetrised(result.covariance);
  return result;
}

void MapSegments::add(PosedFrame frame) { frames_.push_back(std::move(frame)); }

bool MapSegments::has_joined() const {
  return std::ranges::any_of(
      segments_, [](const Segment& segment) { return segment.T_camera_segment_at_join.has_value(); });
}

std::optional<SE3> MapSegments::T_map_segment(std::size_t segment, const CorrectedPose& corrected) const {
  if (segment == 0) return SE3{};
  const Segment& joined = segments_[segment - 1];
  if (!joined.T_camera_segment_at_join) return std::nullopt;
  const SE3 T_map_camera = corrected ? corrected(joined.joined_ns) : joined.T_map_camera_at_join;
  return T_map_camera * *joined.T_camera_segment_at_join;
}

std::optional<SE3> MapSegments::joined_pose_near(std::int64_t timestamp_ns,
                                                 const CorrectedPose& corrected) const {
  auto nearest = std::ranges::lower_bound(frames_, timestamp_ns, {}, &PosedFrame::timestamp_ns);
  if (nearest == frames_.end() || (nearest != frames_.begin() && timestamp_ns - (nearest - 1)->timestamp_ns <
                                                                     nearest->timestamp_ns - timestamp_ns))
    --nearest;
  if (nearest->segment == 0) return std::nullopt;
  const std::optional<SE3> moves = T_map_segment(nearest->segment, corrected);
  return moves ? std::optional(*moves * nearest->state.T_world_imu) : std::nullopt;
}

std::optional<filter::FilterState> MapSegments::fused_state(std::int64_t timestamp_ns,
                                                            const CorrectedPose& corrected) const {
  const auto frame = std::ranges::lower_bound(frames_, timestamp_ns, {}, &PosedFrame::timestamp_ns);
  if (frame == frames_.end() || frame->timestamp_ns != timestamp_ns || !frame->fused) return std::nullopt;
  const std::optional<SE3> moves = T_map_segment(frame->segment, corrected);
  return moves ? std::optional(filter::moved(frame->state, *moves)) : std::nullopt;
}

Trajectory MapSegments::trajectory(const SE3& T_imu_camera, bool map, const CorrectedPose& corrected) const {
  Trajectory poses;
  for (const PosedFrame& frame : frames_) {
    if (frame.segment == 0 && !map) continue;
    const std::optional<SE3> moves = T_map_segment(frame.segment, corrected);
    if (moves) poses.push_back({frame.timestamp_ns, *moves * (frame.state.T_world_imu * T_imu_camera)});
  }
  return poses;
}

}  // namespace fusebench::core
