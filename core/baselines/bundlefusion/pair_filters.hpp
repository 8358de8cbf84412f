// Selects the matches of two frames that agree on one rigid motion and determine it (Dai et al. 2017, Sec.
// 4.2: key point correspondence filter and surface area filter).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/baselines/bundlefusion/matching.hpp"

namespace fusebench::baselines::bundlefusion {

/// A point in the axes of two cameras (metres).
struct PointPair {
  Vector3d point_a = Vector3d::Zero();
  Vector3d point_b = Vector3d::Zero();
};

/// Matches that agree on a motion.
struct RigidMatches {
  std::vector<KeypointMatch> matches;
  std::vector<PointPair> points;  ///< one for each match
  SE3 T_a_b;
};

/// The least-squares motion T_a_b of at least three pairs (Kabsch 1976, Umeyama 1991).
[[nodiscard]] SE3 rigid_fit(std::span<const PointPair> points);

/// Adds matches in their order, at least 5 px from those already taken, up to 25. After each, fits the motion
/// and removes the worst matches until all are within 2 cm. Nothing if fewer than five remain, or if they are
/// nearly collinear.
[[nodiscard]] std::optional<RigidMatches> filter_by_motion(std::span<const KeypointMatch> matches,
                                                           const Keypoints& a, const Keypoints& b);

/// Area (square metres) of the bounding box of the points in their plane, along their two principal axes.
[[nodiscard]] double box_area_m2(std::span<const Vector3d> points);

/// True if the points cover at least 0.032 square metres in both frames; a smaller area determines the motion
/// badly.
[[nodiscard]] bool covers_enough_area(std::span<const PointPair> points);

}  // namespace fusebench::baselines::bundlefusion
