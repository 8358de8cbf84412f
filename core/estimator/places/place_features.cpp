#include "core/estimator/places/place_features.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <opencv2/features2d.hpp>
#include <tuple>

#include "core/config/groups/relocalisation_config.hpp"

namespace fusebench::places {

namespace {

// Side of the area of a descriptor, in pixels of its level: the comparisons of ORB were trained on patches of
// this size (Rublee et al. 2011, Sec. 4.3).
constexpr int kPatch_px = 31;
// As in ORB-SLAM (EDGE_THRESHOLD): a descriptor may extend beyond the border by some pixels, where the image
// is mirrored. Coarse levels would have few corners otherwise.
constexpr int kEdge_px = 19;

// OpenCV has no read-only view; the data is never written.
cv::Mat view_of(const GreyImage& grey) {
  return {grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data.data())};
}

std::size_t cell_of(const cv::KeyPoint& corner, const GreyImage& grey,
                    const config::PlaceFeaturesConfig& config) {
  const int column = static_cast<int>(corner.pt.x) * config.grid_columns / grey.width;
  const int row = static_cast<int>(corner.pt.y) * config.grid_rows / grey.height;
  return static_cast<std::size_t>(row * config.grid_columns + column);
}

/// First the share of each cell, then the strongest remaining corners.
std::vector<cv::KeyPoint> spread(std::vector<cv::KeyPoint> corners, const GreyImage& grey,
                                 const config::PlaceFeaturesConfig& config) {
  // Total order, so that the result does not depend on the order of the detector.
  std::sort(corners.begin(), corners.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::make_tuple(-a.response, a.octave, a.pt.y, a.pt.x) <
           std::make_tuple(-b.response, b.octave, b.pt.y, b.pt.x);
  });
  const int cells = config.grid_columns * config.grid_rows;
  std::vector<int> in_cell(static_cast<std::size_t>(cells));
  std::vector<cv::KeyPoint> taken;
  std::vector<cv::KeyPoint> rest;
  for (const cv::KeyPoint& corner : corners) {
    int& count = in_cell[cell_of(corner, grey, config)];
    const bool has_room = count < config.max_count / cells;
    (has_room ? taken : rest).push_back(corner);
    count += has_room ? 1 : 0;
  }
  const auto room = static_cast<std::size_t>(config.max_count) - taken.size();
  rest.resize(std::min(rest.size(), room));
  taken.insert(taken.end(), rest.begin(), rest.end());
  return taken;
}

PlaceFeature feature_of(const cv::KeyPoint& corner, const std::uint8_t* descriptor) {
  PlaceFeature feature;
  feature.pixel_px = {static_cast<double>(corner.pt.x), static_cast<double>(corner.pt.y)};
  feature.scale = static_cast<double>(corner.size) / kPatch_px;
  std::memcpy(feature.descriptor.data(), descriptor, sizeof(OrbDescriptor));
  return feature;
}

/// The nearest reference feature of a query feature and the distances of the two nearest (bits).
struct Nearest {
  std::size_t index = 0;
  int first = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();

  /// The ratio is in percent, so the test uses integers.
  [[nodiscard]] bool distinct(const config::PlaceFeaturesConfig& config) const {
    return first <= config.max_descriptor_bits &&
           100LL * first < static_cast<long long>(config.max_ratio_percent) * second;
  }
};

/// The first one of equal distances.
Nearest nearest_to(const OrbDescriptor& descriptor, std::span<const PlaceFeature> features) {
  Nearest nearest;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int distance = hamming_distance(descriptor, features[i].descriptor);
    if (distance >= nearest.second) continue;
    if (distance < nearest.first) {
      nearest = {i, distance, nearest.first};
    } else {
      nearest.second = distance;
    }
  }
  return nearest;
}

}  // namespace

std::vector<PlaceFeature> find_place_features(const GreyImage& grey,
                                              const config::PlaceFeaturesConfig& config) {
  if (grey.width <= 2 * kPatch_px || grey.height <= 2 * kPatch_px) return {};
  const cv::Mat view = view_of(grey);
  // The FAST score is an integer; the Harris score is not.
  const auto orb =
      cv::ORB::create(config.detected_per_taken * config.max_count, static_cast<float>(config.level_factor),
                      config.levels, kEdge_px, 0, 2, cv::ORB::FAST_SCORE, kPatch_px, config.fast_threshold);
  std::vector<cv::KeyPoint> corners;
  orb->detect(view, corners);
  corners = spread(std::move(corners), grey, config);
  cv::Mat descriptors;
  orb->compute(view, corners, descriptors);

  std::vector<PlaceFeature> features;
  features.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    features.push_back(feature_of(corners[i], descriptors.ptr<std::uint8_t>(static_cast<int>(i))));
  std::sort(features.begin(), features.end(), [](const PlaceFeature& a, const PlaceFeature& b) {
    return std::make_tuple(a.pixel_px.y(), a.pixel_px.x(), a.scale, a.descriptor) <
           std::make_tuple(b.pixel_px.y(), b.pixel_px.x(), b.scale, b.descriptor);
  });
  return features;
}

std::vector<Vector2d> find_corners(const GreyImage& grey, const config::PlaceFeaturesConfig& config) {
  if (grey.width <= 2 * kPatch_px || grey.height <= 2 * kPatch_px) return {};
  const cv::Rect inside(kEdge_px, kEdge_px, grey.width - 2 * kEdge_px, grey.height - 2 * kEdge_px);
  std::vector<cv::KeyPoint> corners;
  cv::FAST(view_of(grey)(inside), corners, config.fast_threshold, true);
  std::vector<Vector2d> corners_px;
  corners_px.reserve(corners.size());
  for (const cv::KeyPoint& corner : corners) {
    corners_px.emplace_back(static_cast<double>(corner.pt.x) + kEdge_px,
                            static_cast<double>(corner.pt.y) + kEdge_px);
  }
  return corners_px;
}

int hamming_distance(const OrbDescriptor& a, const OrbDescriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance += std::popcount(a[i] ^ b[i]);
  return distance;
}

std::vector<FeatureMatch> match_features(std::span<const PlaceFeature> query,
                                         std::span<const PlaceFeature> known,
                                         const config::PlaceFeaturesConfig& config) {
  std::vector<FeatureMatch> matches;
  for (std::size_t q = 0; q < query.size(); ++q) {
    const Nearest nearest = nearest_to(query[q].descriptor, known);
    if (nearest.distinct(config) && nearest_to(known[nearest.index].descriptor, query).index == q)
      matches.push_back({q, nearest.index});
  }
  return matches;
}

std::size_t count_distinct(std::span<const PlaceFeature> query, std::span<const PlaceFeature> known,
                           std::size_t step, const config::PlaceFeaturesConfig& config) {
  std::size_t count = 0;
  for (std::size_t q = 0; q < query.size(); q += step)
    if (nearest_to(query[q].descriptor, known).distinct(config)) ++count;
  return count;
}

}  // namespace fusebench::places
