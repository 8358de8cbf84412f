// Selects older places that may be the same as a new one, by appearance and by position.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/loops/place.hpp"

namespace fusebench::loops {

/// Share of the ferns that differ.
[[nodiscard]] double dissimilarity(const Place& a, const Place& b);

/// Indices of the places that are at least loops.least_age_s older than the last one, in the order of
/// similarity to it.
[[nodiscard]] std::vector<std::size_t> similar_places(std::span<const Place> places,
                                                      const config::LoopsConfig& config);

/// Indices of places whose view overlaps that of the last one by the given poses (any frame), nearest first.
/// Needed where dark, blurred or textureless images prevent a search by appearance.
[[nodiscard]] std::vector<std::size_t> places_in_view(std::span<const Place> places,
                                                      const std::function<SE3(std::size_t)>& T_world_camera,
                                                      const config::LoopsConfig& config);

}  // namespace fusebench::loops
