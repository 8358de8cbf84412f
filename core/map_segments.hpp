// Stretches of a recording that are tracked apart from the map. Not in the paper.
//
// A camera that is lost and sees nothing that is in the map may still be tracked from one image to the next.
// Such a stretch is a *segment*: it starts at the dead-reckoned pose and has a model, patches and keyframes
// of its own. When a place of the map is recognised in it, the segment is joined: the pose of that frame in
// the map and in the segment tell how all of the segment moves. What is never joined stays apart.
//
// Segment 0 is the map. All poses are in the world of the map as far as dead reckoning knows it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "core/filter/filter_state.hpp"

namespace fusebench::core {

/// A frame with a pose, as it was estimated.
struct PosedFrame {
  std::int64_t timestamp_ns = 0;
  std::size_t segment = 0;
  bool fused = false;
  filter::FilterState state;
};

class MapSegments {
 public:
  /// A segment begins at this dead-reckoned state of the map.
  void begin(const filter::GaussianState& reckoned_in_map);
  /// The open segment ends; it stays apart.
  void close() { open_ = 0; }
  /// The open segment ends and is joined to the map: the camera is at both poses.
  void join(std::int64_t timestamp_ns, const SE3& T_map_camera, const SE3& T_segment_camera);

  /// Number of the segment that frames are tracked in; 0: the map.
  [[nodiscard]] std::size_t open() const { return open_; }
  /// An estimate in the open segment as one in the map: with its drift in the segment, and with what was
  /// unknown of the segment's beginning.
  [[nodiscard]] filter::GaussianState in_map(const filter::GaussianState& in_segment) const;

  void add(PosedFrame frame);
  [[nodiscard]] bool has_joined() const;

  /// Where the map's own frame of a stamp is now, if the map was corrected.
  using CorrectedPose = std::function<SE3(std::int64_t timestamp_ns)>;
  /// In the map, the state that a frame was fused at; nothing if it was not, or its segment was not joined.
  /// `corrected` is of the frames of joins; empty: poses are as they were.
  [[nodiscard]] std::optional<filter::FilterState> fused_state(std::int64_t timestamp_ns,
                                                               const CorrectedPose& corrected) const;
  /// Of the camera in the map: frames of joined segments and, with `map`, of the map itself, in order.
  [[nodiscard]] Trajectory trajectory(const SE3& T_imu_camera, bool map,
                                      const CorrectedPose& corrected) const;
  /// Of the IMU in the map, at the frame nearest in time, if that is of a joined segment.
  [[nodiscard]] std::optional<SE3> joined_pose_near(std::int64_t timestamp_ns,
                                                    const CorrectedPose& corrected) const;

 private:
  struct Segment {
    filter::FilterState begin;
    Matrix6d begin_covariance = Matrix6d::Zero();  ///< of that pose in the map, in its tangent
    std::optional<SE3> T_camera_segment_at_join;   ///< if it was joined
    std::int64_t joined_ns = 0;
    SE3 T_map_camera_at_join;
  };
  [[nodiscard]] std::optional<SE3> T_map_segment(std::size_t segment, const CorrectedPose& corrected) const;

  std::vector<Segment> segments_;  ///< number 1 first
  std::size_t open_ = 0;
  std::vector<PosedFrame> frames_;  ///< in the order of time
};

}  // namespace fusebench::core
