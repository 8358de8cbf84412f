#include "core/relocalisation/place_features.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <opencv2/features2d.hpp>
#include <tuple>

namespace fusebench::relocalisation {

namespace {

// Descriptors of the same thing differ in 20 to 60 of 256 bits, those of different things in 128 +- 20.
constexpr int kMaxDistance = 64;
// In percent, so that the test is one of integers. 80 is Lowe's (IJCV 2004, Fig. 11).
constexpr int kMaxRatio_percent = 80;
// Low, as a lost image is often a blurred one; the strongest corners are taken first all the same.
constexpr int kFastThreshold = 8;
constexpr int kLevels = 8;
constexpr float kLevelFactor = 1.2F;
// Side of what a descriptor looks at, in pixels of its level.
constexpr int kPatch_px = 31;
// As in ORB-SLAM: a descriptor may look out of the image by some pixels, where it sees a mirror image. Coarse
// levels would have few corners otherwise.
constexpr int kEdge_px = 19;
// Detected for one taken: the strongest corners of a whole image may all lie on one striped cushion.
constexpr int kSurplus = 8;
constexpr int kGridColumns = 8;
constexpr int kGridRows = 6;

// OpenCV has no read-only view; nothing writes through this one.
cv::Mat view_of(const GreyImage& grey) {
  return {grey.height, grey.width, CV_8UC1, const_cast<std::uint8_t*>(grey.data.data())};
}

int cell_of(const cv::KeyPoint& corner, const GreyImage& grey) {
  const int column = static_cast<int>(corner.pt.x) * kGridColumns / grey.width;
  const int row = static_cast<int>(corner.pt.y) * kGridRows / grey.height;
  return row * kGridColumns + column;
}

/// First the share of each cell, then the strongest of the rest.
std::vector<cv::KeyPoint> spread(std::vector<cv::KeyPoint> corners, const GreyImage& grey, int max_count) {
  // A total order: the result must not depend on the detector's own.
  std::sort(corners.begin(), corners.end(), [](const cv::KeyPoint& a, const cv::KeyPoint& b) {
    return std::make_tuple(-a.response, a.octave, a.pt.y, a.pt.x) <
           std::make_tuple(-b.response, b.octave, b.pt.y, b.pt.x);
  });
  constexpr int kCells = kGridColumns * kGridRows;
  std::array<int, kCells> in_cell{};
  std::vector<cv::KeyPoint> taken;
  std::vector<cv::KeyPoint> rest;
  for (const cv::KeyPoint& corner : corners) {
    int& count = in_cell[static_cast<std::size_t>(cell_of(corner, grey))];
    const bool has_room = count < max_count / kCells;
    (has_room ? taken : rest).push_back(corner);
    count += has_room ? 1 : 0;
  }
  const auto room = static_cast<std::size_t>(std::max(0, max_count)) - taken.size();
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

/// The nearest and how far the two nearest are.
struct Nearest {
  std::size_t index = 0;
  int first = std::numeric_limits<int>::max();
  int second = std::numeric_limits<int>::max();

  void see(std::size_t candidate, int distance) {
    if (distance < first) {
      second = first;
      first = distance;
      index = candidate;
    } else {
      second = std::min(second, distance);
    }
  }
  [[nodiscard]] bool distinct() const {
    return first <= kMaxDistance && 100LL * first < static_cast<long long>(kMaxRatio_percent) * second;
  }
};

}  // namespace

std::vector<PlaceFeature> find_place_features(const GreyImage& grey, int max_count) {
  if (grey.width <= 2 * kPatch_px || grey.height <= 2 * kPatch_px) return {};
  const cv::Mat view = view_of(grey);
  // The score of FAST is an integer, that of Harris is not.
  const auto orb = cv::ORB::create(kSurplus * max_count, kLevelFactor, kLevels, kEdge_px, 0, 2,
                                   cv::ORB::FAST_SCORE, kPatch_px, kFastThreshold);
  std::vector<cv::KeyPoint> corners;
  orb->detect(view, corners);
  corners = spread(std::move(corners), grey, max_count);
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

std::vector<Vector2d> find_corners(const GreyImage& grey) {
  if (grey.width <= 2 * kPatch_px || grey.height <= 2 * kPatch_px) return {};
  const cv::Rect inside(kEdge_px, kEdge_px, grey.width - 2 * kEdge_px, grey.height - 2 * kEdge_px);
  std::vector<cv::KeyPoint> corners;
  cv::FAST(view_of(grey)(inside), corners, kFastThreshold, true);
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
                                         std::span<const PlaceFeature> known) {
  std::vector<Nearest> of_known(known.size());
  std::vector<Nearest> of_query(query.size());
  for (std::size_t q = 0; q < query.size(); ++q) {
    for (std::size_t k = 0; k < known.size(); ++k) {
      const int distance = hamming_distance(query[q].descriptor, known[k].descriptor);
      of_query[q].see(k, distance);
      of_known[k].see(q, distance);
    }
  }
  std::vector<FeatureMatch> matches;
  for (std::size_t q = 0; q < query.size(); ++q) {
    const Nearest& nearest = of_query[q];
    if (!known.empty() && nearest.distinct() && of_known[nearest.index].index == q)
      matches.push_back({q, nearest.index});
  }
  return matches;
}

}  // namespace fusebench::relocalisation
