// Keyframes: a small store of fused frames for the relocalisation of a lost tracker.
//
// A keyframe has landmarks: ORB features (core/estimator/places) with depth, computed at the first search.
// The features of a query image are matched with those of the keyframes. P3P in RANSAC gives the pose, and
// all inliers refine it (as the relocalisation of ORB-SLAM2, Mur-Artal and Tardos, T-RO 2017, but without a
// vocabulary: with some tens of keyframes, matching all descriptors is fast enough).
//
// Poses are T_world_camera; metres, pixels of level 0. Results do not depend on the number of threads.
// Errors: none; without a match the result is empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/ferns/fern_code.hpp"
#include "core/estimator/places/landmarks.hpp"
#include "core/estimator/places/relocalisation/packed_depth.hpp"
#include "core/estimator/places/small_images.hpp"

namespace fusebench::relocalisation {

/// A fused frame for relocalisation.
struct Keyframe {
  std::int64_t timestamp_ns = 0;
  SE3 T_world_camera;
  GreyImage grey;
  double blur_px = 0;  ///< as given to offer()
  PackedDepth depth;   ///< as given to offer(), for cutting patches
  // Computed at the first search, since most trackers are never lost.
  std::optional<places::Landmarks> landmarks;
  std::optional<places::SmallImages> small;
  ferns::FernCode depth_code{};  ///< code of small->depth_m
};

/// A relocalised pose by features, or by depth (then without inliers, matches and rms).
struct FoundPlace {
  SE3 T_world_camera;
  std::size_t keyframe = 0;  ///< index of the matched keyframe; valid until the next offer()
  double support = 0;        ///< inliers, or share of consistent depth: comparable within one search
  int inliers = 0;           ///< matches that agree with the pose
  int matches = 0;           ///< all matches with that keyframe
  double rms_px = 0;         ///< of the inliers, at the scale of each
  /// Covariance of rotation (on the right, rad) and position (world, metres) relative to the keyframe,
  /// without the error of the keyframe itself. With few inliers, rotation and position are strongly
  /// correlated.
  Matrix6d covariance = Matrix6d::Zero();
};

/// The store of keyframes.
class Keyframes {
 public:
  /// The configuration must outlive it.
  Keyframes(const PinholeCamera& camera, const config::Config& config) : camera_(camera), config_(config) {}

  /// Keeps the frame if it has enough corners or landmarks with depth (> 0) and no keyframe shows the place
  /// from nearby. Replaces a nearby keyframe that is much more blurred. Returns whether it was kept. If the
  /// store is full, one of the two nearest keyframes is removed. Offer only frames fused at an accepted pose.
  /// Images have the size of the camera. blur_px: image motion during the exposure.
  bool offer(const GreyImage& grey, const DepthImage& depth_m, const SE3& T_world_camera,
             std::int64_t timestamp_ns, double blur_px = 0);

  /// Poses of an image relative to the keyframe with the largest support and to others with comparable
  /// support (ambiguous candidates: RelocalisationConfig::ambiguous_support): best first, each certain; empty
  /// if none is. The first call computes the landmarks of all keyframes: about 10 ms each at 640x480.
  [[nodiscard]] std::vector<FoundPlace> find(const GreyImage& grey);

  /// Poses of an image by depth alone, for images without features (blur, darkness, a bare wall), verified as
  /// loops are (core/estimator/places/place_verification.hpp): best first, each certain. First tries the
  /// keyframes with the largest overlap by the prediction, aligned from there (error about reach_m). If none
  /// matches, tries those with the most similar depth, aligned from their own poses.
  [[nodiscard]] std::vector<FoundPlace> find_by_depth(const places::SmallImages& query,
                                                      const SE3& T_world_camera_predicted, double reach_m);

  /// Refines a result of find() for that image by depth; nothing if the depth of one frame contradicts that
  /// of the other. A correct place can fail: in fast rotation, up to a third of the depth appears in free
  /// space, since the predicted motion of the compensation is wrong.
  [[nodiscard]] std::optional<FoundPlace> refined_by_depth(const FoundPlace& found,
                                                           const places::SmallImages& query);

  /// Sets the pose of each keyframe to T_world_camera_at(its stamp).
  void move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at);

  /// Adds the keyframes of another store, whose world frame has the pose T_world_other in this one. If the
  /// store is full, one of the two nearest keyframes is removed.
  void adopt(const Keyframes& other, const SE3& T_world_other);

  [[nodiscard]] std::size_t size() const { return kept_.size(); }
  [[nodiscard]] const Keyframe& operator[](std::size_t index) const { return kept_[index]; }

 private:
  /// A keyframe and the initial pose of the camera for the alignment.
  struct AlignmentCandidate {
    std::size_t keyframe = 0;
    SE3 T_keyframe_camera;
  };
  /// A frame with too few features to be kept.
  struct FeaturelessFrame {
    SE3 T_world_camera;
    double blur_px = 0;
  };
  [[nodiscard]] double separation(const SE3& a, const SE3& b) const;
  [[nodiscard]] bool is_sharper(double blur_px, double blur_before_px) const;
  void drop_most_crowded();
  void complete(Keyframe& keyframe) const;
  /// Computes missing landmarks of keyframes.
  void complete_landmarks();
  /// Indices of the keyframes (at most max_candidates) with the most matches to a sample of the features.
  [[nodiscard]] std::vector<std::size_t> most_matched(std::span<const places::PlaceFeature> query) const;
  [[nodiscard]] std::vector<AlignmentCandidate> seen_by_prediction(const places::SmallImages& query,
                                                                   const SE3& T_world_camera) const;
  [[nodiscard]] std::vector<AlignmentCandidate> most_similar(const places::SmallImages& query) const;
  [[nodiscard]] std::vector<FoundPlace> aligned(const places::SmallImages& query,
                                                const std::vector<AlignmentCandidate>& candidates,
                                                double reach_m) const;

  PinholeCamera camera_;
  const config::Config& config_;
  std::vector<Keyframe> kept_;                   ///< in the order of offer()
  std::optional<FeaturelessFrame> featureless_;  ///< the last one
};

}  // namespace fusebench::relocalisation
