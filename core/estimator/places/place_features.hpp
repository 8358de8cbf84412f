// Features that are recognisable from another viewpoint, and their matching.
//
// ORB (Rublee et al., ICCV 2011): FAST corners over scales, described by 256 comparisons of grey levels that
// rotate with the image. The distance of two descriptors is the number of different bits. Pixel coordinates
// are of level 0, with fractions. Corners are ranked by integers in a fixed order, so results do not depend
// on the number of threads or on earlier calls. The orientation of a descriptor is in floating point, as
// OpenCV computes it. Errors: none; an image without corners has no features.
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
  double scale = 1;  ///< width of a pixel of the corner's level in pixels of level 0: precision of pixel_px
  OrbDescriptor descriptor{};
};

/// Up to config.max_count features, distributed over the image: the strongest of each grid cell, ordered by
/// rows, columns and scales.
[[nodiscard]] std::vector<PlaceFeature> find_place_features(const GreyImage& grey,
                                                            const config::PlaceFeaturesConfig& config);

/// Candidate corners of level 0 only, at about a twentieth of the cost of find_place_features().
[[nodiscard]] std::vector<Vector2d> find_corners(const GreyImage& grey,
                                                 const config::PlaceFeaturesConfig& config);

/// Number of different bits of two descriptors, 0 to 256.
[[nodiscard]] int hamming_distance(const OrbDescriptor& a, const OrbDescriptor& b);

/// Indices of two matching features.
struct FeatureMatch {
  std::size_t query = 0;
  std::size_t known = 0;
};

/// Mutual nearest neighbours by descriptor that are near enough and clearly nearer than the second nearest
/// (Lowe's ratio test), in the order of the query's features.
[[nodiscard]] std::vector<FeatureMatch> match_features(std::span<const PlaceFeature> query,
                                                       std::span<const PlaceFeature> known,
                                                       const config::PlaceFeaturesConfig& config);

/// Number of distinct matches of every `step`-th query feature (step >= 1) to the reference features, with
/// the limits of match_features(), in one direction.
[[nodiscard]] std::size_t count_distinct(std::span<const PlaceFeature> query,
                                         std::span<const PlaceFeature> known, std::size_t step,
                                         const config::PlaceFeaturesConfig& config);

}  // namespace fusebench::places
