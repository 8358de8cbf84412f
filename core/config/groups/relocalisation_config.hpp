// Options: keyframes and features for the relocalisation of a lost camera, and map segments.
#pragma once

namespace fusebench::config {

/// Selection of keyframes, and acceptance of a relocalised pose.
struct RelocalisationConfig {
  double keyframe_distance_m = 0.3;
  double keyframe_angle_deg = 20.0;
  int max_keyframes = 60;
  /// Share of the spacing of keyframes around a frame with too few landmarks within which no other frame is
  /// tried, unless it is sharper: finding landmarks takes some 10 ms.
  static constexpr double featureless_reach = 0.3;
  /// Share of the spacing of keyframes within which a sharp frame may replace a blurred keyframe, since it
  /// shows the same.
  static constexpr double replacement_reach = 0.5;
  /// Motion blur above which a keyframe may be replaced (pixels).
  static constexpr double blurred_px = 2.0;
  /// Largest blur of the frame that replaces it, relative to its blur.
  static constexpr double sharper_factor = 0.5;
  /// Least number of landmarks of a keyframe: more than twice the inliers that a pose needs, so that an
  /// overlap of half an image suffices.
  static constexpr int min_landmarks = 60;
  /// A frame with this many corners with depth has enough landmarks without looking for them.
  static constexpr int plenty_of_corners = 120;
  /// A feature is no landmark if the depth of a neighbouring pixel differs by more than this share: it may
  /// lie on either surface.
  static constexpr double landmark_edge_jump = 0.05;
  /// Keyframes for which a pose is computed, those with the most matches first.
  static constexpr int max_candidates = 16;
  int min_inliers = 25;
  /// Least share of inliers among the matches: repeating wallpaper made 28 of 84 matches agree on a wrong
  /// pose in simulations.
  static constexpr double min_inlier_share = 0.3;
  /// Rows and columns of the grid in which the spread of the inliers is counted.
  static constexpr int spread_cells_per_side = 4;
  /// Least number of cells of that grid with an inlier: more than one quarter of the image has.
  static constexpr int min_spread_cells = 5;
  /// Largest standard deviation of the position relative to the distance of the landmarks: 3 cm at 2 m.
  static constexpr double max_relative_position_sigma = 0.015;
  /// Variance of a found pose relative to that by the scatter of its inliers: corners of a blurred image, or
  /// of one seen from aside, are off together.
  static constexpr double shared_error_factor = 3.0;
  /// Standard deviation of the rotation of a keyframe against the model, which drifts after the keyframe was
  /// fused (rad): half a voxel at 1 m.
  static constexpr double keyframe_rotation_sigma_rad = 0.005;
  /// The same for its position (metres): half a voxel.
  static constexpr double keyframe_position_sigma_m = 0.005;
  /// A place is a candidate beside the best one with this share of its inliers (of the depth that agrees,
  /// where depth alone was used). Wrong doors of simulated corridors had 0.6 to 1.1 times the inliers of each
  /// other.
  static constexpr double ambiguous_support = 0.5;
  double lookalike_density = 1e-6;
  double min_odds = 100.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("keyframe_distance_m", self.keyframe_distance_m, 0.001, 100.0,
             "distance between keyframes (metres); 1 to 3 m from the scene, half this distance changes the "
             "viewing angle by about 5 degrees, to which descriptors are insensitive");
    v.number("keyframe_angle_deg", self.keyframe_angle_deg, 0.1, 180.0,
             "angle between the optical axes of keyframes at one place (degrees): a third of the usual field "
             "of view, "
             "so that neighbours overlap");
    v.number(
        "max_keyframes", self.max_keyframes, 1, 10000,
        "largest number of keyframes: with more, one of the two nearest to each other is dropped. Each takes "
        "1 MB at 640x480, and a search compares with all of them");
    v.number("min_inliers", self.min_inliers, 6, RelocalisationConfig::min_landmarks,
             "least number of inliers of a pose by features: 1.5 times the maximum (16) of keyframes of "
             "another room in simulations");
    v.number("lookalike_density", self.lookalike_density, 0.0, 1e6,
             "density of places outside the map that look like one inside, per cubic metre and cubic radian "
             "(79 in total): 1e-6 is one in 13,000 m3, a large floor of a building. It limits the "
             "uncertainty of dead reckoning at which a place is accepted");
    v.number("min_odds", self.min_odds, 1.0, 1e12,
             "a place is accepted if it is this many times as probable as all ambiguous candidates, inside "
             "and outside the map");
  }
};

/// Features for place recognition (ORB; Rublee et al. 2011) and their matching.
struct PlaceFeaturesConfig {
  int max_count = 800;
  /// Threshold of FAST corners (grey levels): low, since the image of a lost camera is often blurred. The
  /// strongest corners come first.
  static constexpr int fast_threshold = 8;
  /// Scales on which features are found (ORB-SLAM: 8).
  static constexpr int levels = 8;
  /// Ratio of consecutive scales (Rublee et al. 2011 and ORB-SLAM: 1.2).
  static constexpr double level_factor = 1.2;
  /// Corners that are detected for each one taken, so that one textured object does not take all of them.
  static constexpr int detected_per_taken = 8;
  /// Columns of the grid over which features are spread: cells of 80 pixels at 640x480.
  static constexpr int grid_columns = 8;
  /// Rows of that grid.
  static constexpr int grid_rows = 6;
  /// Largest Hamming distance of two descriptors that match: 20 to 60 of 256 bits for the same point, 128 +-
  /// 20 for different ones.
  static constexpr int max_descriptor_bits = 64;
  /// Largest ratio of the distances of the nearest and the second nearest descriptor (percent; Lowe 2004,
  /// Fig. 11: 80).
  static constexpr int max_ratio_percent = 80;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_count", self.max_count, RelocalisationConfig::min_landmarks, 20000,
             "largest number of features of an image (ORB-SLAM: 1000 at this resolution); the time of "
             "matching grows with its square");
  }
};

/// Start of a map segment, and the rate at which it is matched with the map.
struct SegmentsConfig {
  double begin_after_s = 0.5;
  int search_every = 5;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("begin_after_s", self.begin_after_s, 0.0, 1e6,
             "a camera that is lost for this long (seconds) is tracked in a separate map segment, which is "
             "joined to the map when a place of it is recognised; 0: never. Requires terms.relocalisation");
    v.number("search_every", self.search_every, 1, 1000,
             "one of this many frames of a segment is searched in the map; a search takes as long as "
             "tracking a frame");
  }
};

}  // namespace fusebench::config
