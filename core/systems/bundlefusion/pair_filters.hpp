// Which matches of two frames agree on one rigid motion, and whether they determine it
// (Dai et al. 2017, Sec. 4.2: key point correspondence filter and surface area filter).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/systems/bundlefusion/matching.hpp"

namespace fusebench::systems::bundlefusion {

/// One place seen by two cameras, in the axes of each (metres).
struct PointPair {
  Vector3d point_a = Vector3d::Zero();
  Vector3d point_b = Vector3d::Zero();
};

/// Matches that agree on a motion.
struct RigidMatches {
  std::vector<KeypointMatch> matches;
  std::vector<PointPair> points;  ///< one a match
  SE3 T_a_b;
};

/// The least-squares motion T_a_b of at least three pairs (Kabsch 1976, Umeyama 1991).
[[nodiscard]] SE3 rigid_fit(std::span<const PointPair> points);

/// Takes matches in their order, none within 5 px of one that is taken, up to 25 of them; after each the
/// motion is fitted again, and the worst matches go until all are within 2 cm of it. Nothing if fewer than
/// five remain, or if they lie so near a line that they leave a rotation open.
[[nodiscard]] std::optional<RigidMatches> filter_by_motion(std::span<const KeypointMatch> matches,
                                                           const Keypoints& a, const Keypoints& b);

/// The area (square metres) of the box around the points in their plane: along their two principal axes.
[[nodiscard]] double box_area_m2(std::span<const Vector3d> points);

/// Whether the points cover 0.032 square metres or more in both frames: less determines a motion badly.
[[nodiscard]] bool covers_enough_area(std::span<const PointPair> points);

}  // namespace fusebench::systems::bundlefusion
