// Edges of the pose graph and their acceptance. A loop is accepted if it agrees with the current poses within
// their drift, if it agrees with another verified loop close in time, or if it is a self-relocalisation.
// Appearance alone is not sufficient.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/loops/place.hpp"
#include "core/estimator/places/loops/pose_graph.hpp"

namespace fusebench::loops {

inline constexpr std::string_view kFoundItself = "the lost tracker found itself by it";

/// Diagonal covariance with equal errors along all axes.
[[nodiscard]] Matrix6d covariance_by_axis(double rotation_sigma_rad, double position_sigma_m);

/// The nearest positive semi-definite covariance: negative eigenvalues set to 0.
[[nodiscard]] Matrix6d not_negative(const Matrix6d& covariance);

/// Edge from place a to the later place b by the estimates of the filter, with the drift between them.
[[nodiscard]] GraphEdge path_edge(std::span<const Place> places, std::size_t a, std::size_t b,
                                  const config::LoopsConfig& config);

/// Edge of a verified pair.
[[nodiscard]] GraphEdge loop_edge(std::span<const Place> places, const LoopCandidate& candidate,
                                  const config::LoopsConfig& config);

/// Sets, for each verified candidate, its squared distance to the current poses (chi2), whether it is
/// accepted, and the reason.
void decide(std::span<const Place> places, const config::LoopsConfig& config,
            std::vector<LoopCandidate>& candidates);

}  // namespace fusebench::loops
