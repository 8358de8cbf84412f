// Corners that can be recognised from another place, and which of two images show the same.
//
// ORB (Rublee et al., ICCV 2011): FAST corners over scales, described by 256 comparisons of grey levels that
// turn with the image; two descriptors are as different as they have different bits. Pixels are of level 0,
// to a fraction. Corners are ranked by integers and in a fixed order, so that neither the number of threads
// nor an earlier call shows in a result; the turn of a descriptor is floating point, as OpenCV computes it.
// Errors: none; an image with nothing to see has no features.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::places {

using OrbDescriptor = std::array<std::uint64_t, 4>;

struct PlaceFeature {
  Vector2d pixel_px = Vector2d::Zero();
  double scale = 1;  ///< pixels of level 0 that a pixel of the corner's level is wide: how exact pixel_px is
  OrbDescriptor descriptor{};
};

/// Up to config.max_count features, spread over the image: the strongest of each cell of a grid, in the order
/// of rows, columns and scales.
[[nodiscard]] std::vector<PlaceFeature> find_place_features(const GreyImage& grey,
                                                            const config::PlaceFeaturesConfig& config);

/// Corners of level 0 alone that could be features: some twentieth of the work of finding those.
[[nodiscard]] std::vector<Vector2d> find_corners(const GreyImage& grey,
                                                 const config::PlaceFeaturesConfig& config);

/// Different bits of two descriptors, 0 to 256.
[[nodiscard]] int hamming_distance(const OrbDescriptor& a, const OrbDescriptor& b);

/// Indices of two features that show the same thing.
struct FeatureMatch {
  std::size_t query = 0;
  std::size_t known = 0;
};

/// Features that are each other's nearest by descriptor, near enough, and clearly nearer than the second
/// nearest (Lowe's ratio test), in the order of the query's features.
[[nodiscard]] std::vector<FeatureMatch> match_features(std::span<const PlaceFeature> query,
                                                       std::span<const PlaceFeature> known,
                                                       const config::PlaceFeaturesConfig& config);

/// Number of every `step`-th query feature (step >= 1) that has a distinct nearest known feature: by the
/// limits of match_features(), but in one direction.
[[nodiscard]] std::size_t count_distinct(std::span<const PlaceFeature> query,
                                         std::span<const PlaceFeature> known, std::size_t step,
                                         const config::PlaceFeaturesConfig& config);

}  // namespace fusebench::places
