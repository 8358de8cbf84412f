// Places seen before: a small store of fused frames by which a tracker that is lost finds its pose again.
//
// A kept frame has landmarks: ORB features (core/places) with the depth of each, found when a place is
// first looked for. The features of a later image are matched against those of every kept frame; three points
// give the pose in RANSAC, all inliers refine it (as the relocalisation of ORB-SLAM2, Mur-Artal and Tardos,
// T-RO 2017, but without a vocabulary: for some tens of frames comparing all descriptors is fast enough).
//
// Frames and units: poses map camera to world; metres, pixels of level 0. The same offers and the same image
// give the same bytes, whatever the number of threads. Errors: none; a place that is not found is no value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/ferns/fern_code.hpp"
#include "core/places/landmarks.hpp"
#include "core/places/small_images.hpp"
#include "core/relocalisation/packed_depth.hpp"

namespace fusebench::relocalisation {

/// A fused frame that can be found again.
struct Keyframe {
  std::int64_t timestamp_ns = 0;
  SE3 T_world_camera;
  GreyImage grey;
  double blur_px = 0;  ///< as it was offered
  PackedDepth depth;   ///< as it was offered, to cut patches again
  // When they were first asked for: most trackers are never lost.
  std::optional<places::Landmarks> landmarks;
  std::optional<places::SmallImages> small;
  ferns::FernCode depth_code{};  ///< of these
};

/// A pose found by matching, or by depth: then without inliers, matches and rms.
struct FoundPlace {
  SE3 T_world_camera;
  std::size_t keyframe = 0;  ///< index of the one that it was found by; valid until the next offer
  double support = 0;        ///< inliers, or the share of depth that agrees: comparable within one search
  int inliers = 0;           ///< matches that agree with the pose
  int matches = 0;           ///< all matches with that keyframe
  double rms_px = 0;         ///< of the inliers, at the scale of each
  /// Of rotation (on the right, rad) and position (world, metres) against the keyframe, whose own error comes
  /// on top. Of few inliers, rotation and position are strongly correlated: together they fit the image
  /// better than each alone.
  Matrix6d covariance = Matrix6d::Zero();
};

/// The store.
class Keyframes {
 public:
  /// The configuration must outlive it.
  Keyframes(const PinholeCamera& camera, const config::Config& config) : camera_(camera), config_(config) {}

  /// Keeps the frame if no kept one shows the place from near, or a much more blurred one does, whose place
  /// it takes, and if it has enough corners or landmarks with depth (> 0). Says whether it did. If the store
  /// is full, one of the two that are nearest to each other makes room. Offer what was fused at a pose to be
  /// trusted; images have the size of the camera's. blur_px: how far the image moved while it was exposed.
  bool offer(const GreyImage& grey, const DepthImage& depth_m, const SE3& T_world_camera,
             std::int64_t timestamp_ns, double blur_px = 0);

  /// The pose of an image by the kept frame with which most of it agrees, and by those others with which
  /// nearly as much does (RelocalisationConfig::rival_support): best first, each certain; none if nothing is.
  /// The first time finds the landmarks of every kept frame, which takes some 10 ms each at 640x480: as long
  /// as offering them would have taken, but all in one frame.
  [[nodiscard]] std::vector<FoundPlace> find(const GreyImage& grey);

  /// The pose of an image by its depth alone, where blur, darkness or a bare wall leave no features, verified
  /// as loops are (core/places/place_verification.hpp): best first, each certain. First by the kept frames
  /// that see the most of it by the prediction, aligned from there (off by about reach_m); if none is the
  /// place, by those whose depth looks most like it, aligned as if the camera were where they were taken
  /// from.
  [[nodiscard]] std::vector<FoundPlace> find_by_depth(const places::SmallImages& query,
                                                      const SE3& T_world_camera_predicted, double reach_m);

  /// The place that find() has found of that image, refined by depth; nothing if the depth of either frame
  /// contradicts that of the other. Of a right place it may: while the camera turns fast, up to a third of
  /// the depth seems to be in free space, since the prediction that the read-out is compensated by is wrong.
  [[nodiscard]] std::optional<FoundPlace> refined_by_depth(const FoundPlace& found,
                                                           const places::SmallImages& query);

  /// The pose of each kept frame becomes that of the function, by its stamp.
  void move(const std::function<SE3(std::int64_t timestamp_ns)>& T_world_camera_at);

  /// Keeps those of another store as well, whose world is at that pose in this one. If the store is full, one
  /// of the two that are nearest to each other makes room.
  void adopt(const Keyframes& other, const SE3& T_world_other);

  [[nodiscard]] std::size_t size() const { return kept_.size(); }
  [[nodiscard]] const Keyframe& operator[](std::size_t index) const { return kept_[index]; }

 private:
  /// A keyframe, and where the camera is taken to be against it.
  struct AlignmentCandidate {
    std::size_t keyframe = 0;
    SE3 T_keyframe_camera;
  };
  /// With too few features to be kept.
  struct FeaturelessFrame {
    SE3 T_world_camera;
    double blur_px = 0;
  };
  [[nodiscard]] double separation(const SE3& a, const SE3& b) const;
  [[nodiscard]] bool is_sharper(double blur_px, double blur_before_px) const;
  void drop_most_crowded();
  void complete(Keyframe& keyframe) const;
  /// Finds the landmarks of keyframes that have none yet.
  void complete_landmarks();
  /// Indices of the keyframes (at most max_candidates) that match most of a sample of the features.
  [[nodiscard]] std::vector<std::size_t> most_matched(std::span<const places::PlaceFeature> query) const;
  [[nodiscard]] std::vector<AlignmentCandidate> seen_by_prediction(const places::SmallImages& query,
                                                                   const SE3& T_world_camera) const;
  [[nodiscard]] std::vector<AlignmentCandidate> most_similar(const places::SmallImages& query) const;
  [[nodiscard]] std::vector<FoundPlace> aligned(const places::SmallImages& query,
                                                const std::vector<AlignmentCandidate>& candidates,
                                                double reach_m) const;

  PinholeCamera camera_;
  const config::Config& config_;
  std::vector<Keyframe> kept_;                   ///< in the order of their offers
  std::optional<FeaturelessFrame> featureless_;  ///< the last one
};

}  // namespace fusebench::relocalisation
