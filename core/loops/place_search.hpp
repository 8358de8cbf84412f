// Which older places a new one may be the same as: by what they look like, and by where the path leads.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/loops/place.hpp"

namespace fusebench::loops {

/// Share of the ferns that differ.
[[nodiscard]] double dissimilarity(const Place& a, const Place& b);

/// Of the places before the last one (loops.least_age_s or more), by index, the most similar to it first.
[[nodiscard]] std::vector<std::size_t> similar_places(std::span<const Place> places,
                                                      const config::LoopsConfig& config);

/// Those that see the same as the last one by these poses, in any world: where it is dark, blurred or bare,
/// nothing else tells them. The nearest view first.
[[nodiscard]] std::vector<std::size_t> places_in_view(std::span<const Place> places,
                                                      const std::function<SE3(std::size_t)>& T_world_camera,
                                                      const config::LoopsConfig& config);

}  // namespace fusebench::loops
