// Motions of a body over half a second, in its own axes. They depend neither on the frame of a trajectory nor
// on the drift before them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::reference_clock {

/// Length of a motion. Hand-held motion changes its direction about as often; a longer one has more drift.
inline constexpr std::int64_t kMotion_ns = 500'000'000;
/// Half of the interval over which the rate of a motion is taken. Over a shorter one the noise of poses
/// dominates.
inline constexpr std::int64_t kRateStep_ns = 100'000'000;

/// A motion M(t) = T_world_body(t)^-1 T_world_body(t + 0.5 s) of the estimate, with those before and after
/// it.
struct EstimatedMotion {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  SE3 motion;
  SE3 before;         ///< the motion that begins 0.1 s earlier, or more
  SE3 after;          ///< the motion that begins 0.1 s later, or more
  double span_s = 0;  ///< from the begin of `before` to the begin of `after`
};

/// The motions of a trajectory that have neighbours: from each pose to the one whose stamp is nearest to 0.5
/// s later (0.25 to 0.75 s). Neighbours begin 0.1 to 0.6 s apart. Of more than `most` poses every second,
/// third, ... begins a motion. Motions of 1e6 m and more are left out. Stamps must not decrease.
[[nodiscard]] std::vector<EstimatedMotion> estimated_motions(const Trajectory& estimate, std::size_t most);

/// The motion of the reference from begin_ns to end_ns; nothing where it is not known (gaps above 0.1 s), or
/// is 1e6 m and more.
[[nodiscard]] std::optional<SE3> reference_motion(const Trajectory& reference, std::int64_t begin_ns,
                                                  std::int64_t end_ns);

struct ReferenceMotion {
  SE3 motion;
  Vector6d rate;  ///< derivative by a delay of both ends, in the tangent of pose_minus(): rad/s, m/s
};

/// The same with its rate, from the motions 0.1 s before and after.
[[nodiscard]] std::optional<ReferenceMotion> reference_motion_with_rate(const Trajectory& reference,
                                                                        std::int64_t begin_ns,
                                                                        std::int64_t end_ns);

}  // namespace fusebench::reference_clock
