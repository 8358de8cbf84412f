// What the filter and the verified pairs say of the motion between places, and which loops are accepted:
// those that agree with the poses so far within their drift, or with another verified loop near to them in
// time, and those by which a lost tracker found itself.
// Appearance alone moves nothing.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/loops/place.hpp"
#include "core/loops/pose_graph.hpp"

namespace fusebench::loops {

inline constexpr std::string_view kFoundItself = "the lost tracker found itself by it";

/// Independent errors of equal size along each axis.
[[nodiscard]] Matrix6d covariance_by_axis(double rotation_sigma_rad, double position_sigma_m);

/// The covariance without what is negative in it.
[[nodiscard]] Matrix6d not_negative(const Matrix6d& covariance);

/// What the filter says of the motion from place a to the later place b, with the drift that came on in
/// between.
[[nodiscard]] GraphEdge path_edge(std::span<const Place> places, std::size_t a, std::size_t b,
                                  const config::LoopsConfig& config);

/// Of a verified pair.
[[nodiscard]] GraphEdge loop_edge(std::span<const Place> places, const LoopCandidate& candidate,
                                  const config::LoopsConfig& config);

/// Of each verified candidate: how far it is from the poses so far (chi2), whether it is accepted, and why.
void decide(std::span<const Place> places, const config::LoopsConfig& config,
            std::vector<LoopCandidate>& candidates);

}  // namespace fusebench::loops
