// Segments of a recording that are tracked separately from the map. Not in the paper.
//
// A lost camera that sees nothing of the map may still be tracked from image to image. Such a part of the
// recording is a segment: it begins at the dead-reckoned pose and has its own model, patches and keyframes.
// When a place of the map is recognised in it, the segment is joined: the poses of that frame in the map and
// in the segment give the transform of the segment. Segments that are never joined stay separate.
//
// Segment 0 is the map. All poses are in the map frame, as far as dead reckoning can give them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "core/estimator/filter/filter_state.hpp"

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
  /// Begins a segment at this dead-reckoned state of the map.
  void begin(const filter::GaussianState& reckoned_in_map);
  /// Ends the open segment without joining it.
  void close() { open_ = 0; }
  /// Ends the open segment and joins it to the map: both poses are those of the camera at timestamp_ns.
  void join(std::int64_t timestamp_ns, const SE3& T_map_camera, const SE3& T_segment_camera);

  /// Number of the open segment; 0: the map.
  [[nodiscard]] std::size_t open() const { return open_; }
  /// Converts an estimate of the open segment to the map. Its uncertainty includes the drift in the segment
  /// and the uncertainty at the start of the segment.
  [[nodiscard]] filter::GaussianState in_map(const filter::GaussianState& in_segment) const;

  void add(PosedFrame frame);
  [[nodiscard]] bool has_joined() const;

  /// Corrected pose of the map's frame with that stamp.
  using CorrectedPose = std::function<SE3(std::int64_t timestamp_ns)>;
  /// State in the map at which a frame was fused; nothing if it was not fused or if its segment was not
  /// joined. `corrected`: poses of the frames of joins; empty if no poses were corrected.
  [[nodiscard]] std::optional<filter::FilterState> fused_state(std::int64_t timestamp_ns,
                                                               const CorrectedPose& corrected) const;
  /// Camera poses in the map, by time: frames of joined segments and, if `map`, those of the map.
  [[nodiscard]] Trajectory trajectory(const SE3& T_imu_camera, bool map,
                                      const CorrectedPose& corrected) const;
  /// Pose of the IMU in the map at the frame nearest in time, if that frame is in a joined segment.
  [[nodiscard]] std::optional<SE3> joined_pose_near(std::int64_t timestamp_ns,
                                                    const CorrectedPose& corrected) const;

 private:
  struct Segment {
    filter::FilterState begin;
    Matrix6d begin_covariance = Matrix6d::Zero();  ///< of the start pose in the map, in its tangent
    std::optional<SE3> T_camera_segment_at_join;   ///< empty until joined
    std::int64_t joined_ns = 0;
    SE3 T_map_camera_at_join;
  };
  [[nodiscard]] std::optional<SE3> T_map_segment(std::size_t segment, const CorrectedPose& corrected) const;

  std::vector<Segment> segments_;  ///< segments_[0] is number 1
  std::size_t open_ = 0;
  std::vector<PosedFrame> frames_;  ///< ordered by time
};

}  // namespace fusebench::core
