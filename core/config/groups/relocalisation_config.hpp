// Options: places that are found again by a camera that is lost, and the features that they are known by.
#pragma once

namespace fusebench::config {

/// Which frames are kept to be found again by, and when a found pose is believed.
struct RelocalisationConfig {
  double keyframe_distance_m = 0.3;
  double keyframe_angle_deg = 20.0;
  int max_keyframes = 60;
  double featureless_reach = 0.3;
  double replacement_reach = 0.5;
  double blurred_px = 2.0;
  double sharper_factor = 0.5;
  int min_landmarks = 60;
  int plenty_of_corners = 120;
  double landmark_edge_jump = 0.05;
  int max_candidates = 16;
  int min_inliers = 25;
  double min_inlier_share = 0.3;
  int spread_cells_per_side = 4;
  int min_spread_cells = 5;
  double max_relative_position_sigma = 0.015;
  double shared_error_factor = 3.0;
  double keyframe_rotation_sigma_rad = 0.005;
  double keyframe_position_sigma_m = 0.005;
  double max_innovation = 225.0;
  double max_position_innovation = 9.0;
  double max_supported_innovation = 2250.0;
  double max_supported_rotation_deg = 30.0;
  double max_unsupported_position_sigma_m = 0.5;
  int agreeing_frames = 5;
  double agreeing_within_s = 0.5;
  double rival_support = 0.5;
  double rival_separation = 2.0;
  double rivals_within_s = 10.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("keyframe_distance_m", self.keyframe_distance_m, 0.001, 100.0,
             "a fused frame is kept as a keyframe if none is nearer (metres): things in a room are 1 to 3 m "
             "away, and a camera half as far aside sees them turned by some 5 degrees, which descriptors "
             "hardly notice");
    v.number(
        "keyframe_angle_deg", self.keyframe_angle_deg, 0.1, 180.0,
        "or if the optical axes of all that are nearer differ by more (degrees); a third of the field of "
        "view of usual cameras, so that neighbours overlap");
    v.number(
        "max_keyframes", self.max_keyframes, 1, 10000,
        "with more keyframes, one of the two nearest to each other goes; each takes 1 MB at 640x480, and "
        "a search compares with all of them");
    v.number("featureless_reach", self.featureless_reach, 0.0, 1.0,
             "within this share of the keyframes' spacing around a frame with too few landmarks no other is "
             "tried, since finding landmarks takes some 10 ms, unless it is sharper as below");
    v.number(
        "replacement_reach", self.replacement_reach, 0.0, 1.0,
        "within this share of the spacing a sharp frame may replace a blurred keyframe: it must show the "
        "same");
    v.number(
        "blurred_px", self.blurred_px, 0.0, 100.0,
        "a keyframe with a longer motion blur may be replaced (pixels): beyond, corners move and soften");
    v.number("sharper_factor", self.sharper_factor, 0.0, 1.0,
             "by a frame with less than this share of its blur, so that a replacement is worth the change");
    v.number(
        "min_landmarks", self.min_landmarks, 1, 100000,
        "a frame with fewer landmarks is not kept; more than twice relocalisation.min_inliers, so that an "
        "overlap with half of an image still suffices");
    v.number(
        "plenty_of_corners", self.plenty_of_corners, 1, 100000,
        "a frame with so many corners of full resolution with depth has enough landmarks, which are then "
        "found when they are first needed; twice relocalisation.min_landmarks");
    v.number(
        "landmark_edge_jump", self.landmark_edge_jump, 0.001, 1.0,
        "a feature whose depth differs from a neighbouring pixel's by more than this share is no "
        "landmark: it may lie on either surface; wider than depth.edge_jump, which gated the depth before");
    v.number("max_candidates", self.max_candidates, 1, 10000,
             "a pose is computed for so many keyframes, those with the most matches; the right one is not "
             "behind as many wrong ones, and of two places that look alike some keyframe of either is among "
             "them");
    v.number(
        "min_inliers", self.min_inliers, 6, 100000,
        "a pose with fewer inliers is not certain; 1.5 times what keyframes of another room gave at most "
        "in simulations (16)");
    v.number(
        "min_inlier_share", self.min_inlier_share, 0.0, 1.0,
        "nor one with a smaller share of the matches: repeating wall paper let 28 of 84 matches agree on "
        "a wrong pose in simulations, another room fewer than 6 of 40 most often");
    v.number("spread_cells_per_side", self.spread_cells_per_side, 1, 64,
             "the spread of the inliers is counted in cells of a grid with this many rows and columns");
    v.number("min_spread_cells", self.min_spread_cells, 1, 4096,
             "nor one whose inliers lie in fewer cells of that grid: more than the 4 of one quarter of the "
             "image, which constrains a pose badly");
    v.number(
        "max_relative_position_sigma", self.max_relative_position_sigma, 1e-6, 10.0,
        "nor one with a larger standard deviation of the position, as a share of the distance of what is "
        "seen; 3 cm at 2 m, well within the reach of tracking (geometric.max_distance_m)");
    v.number("shared_error_factor", self.shared_error_factor, 0.01, 1000.0,
             "the squared errors of found poses are larger than the scatter of their inliers says by this "
             "factor, since corners are off together where an image is blurred or seen from aside; found in "
             "simulated recordings");
    v.number("keyframe_rotation_sigma_rad", self.keyframe_rotation_sigma_rad, 0.0, 1.0,
             "the pose of a keyframe against the model is known so well, since the model drifts after the "
             "keyframe was fused (rad); half a voxel at 1 m");
    v.number("keyframe_position_sigma_m", self.keyframe_position_sigma_m, 0.0, 1.0,
             "the same for its position (metres); half a voxel");
    v.number(
        "max_innovation", self.max_innovation, 0.1, 1e12,
        "a found pose is refused if its squared distance from the prediction, in variances and per degree "
        "of freedom, is larger (repeating texture gives false poses); 225 are five standard deviations, each "
        "three times what the filter claims, as of drift (loops.drift_factor)");
    v.number(
        "max_position_innovation", self.max_position_innovation, 0.1, 1e12,
        "and the same of its position alone, of which a lost tracker claims its error better than of its "
        "rotation: in simulated recordings right places had up to 4, after 0.6 to 50 s, and doors and "
        "pictures 3 to 6 m aside that repeat 14 and more; 9 are three standard deviations, root mean square "
        "of the axes");
    v.number("max_supported_innovation", self.max_supported_innovation, 0.1, 1e12,
             "up to so much, where its position alone is within max_position_innovation, it is "
             "believed all the same if several frames in a row agree on it, the last verified by depth as "
             "loops are: a filter that was wrong before it was lost claims too little of its error in "
             "rotation; ten times as much, as of loops (loops.max_supported_chi2)");
    v.number("max_supported_rotation_deg", self.max_supported_rotation_deg, 0.1, 180.0,
             "but not beyond such a rotation: paths drift by up to 5 % of what the camera turns, which is 18 "
             "degrees in a lap of a room. After many seconds of dead reckoning the position rules nothing "
             "out, and the pictures and doors of a corridor repeat");
    v.number("max_unsupported_position_sigma_m", self.max_unsupported_position_sigma_m, 0.0, 1e6,
             "such support is needed by every place where dead reckoning knows the position no better than "
             "this (metres, one standard deviation): pictures and doors repeat every few metres");
    v.number("agreeing_frames", self.agreeing_frames, 2, 1000,
             "so many frames have to agree, each with the one before within loops.agreeing_chi2");
    v.number("agreeing_within_s", self.agreeing_within_s, 0.01, 10.0,
             "which is no longer ago than this (seconds)");
    v.number("rival_support", self.rival_support, 0.0, 1.0,
             "another place is a rival of the best if it has this share of its inliers (of the depth that "
             "agrees, where there are no features): of two that the prediction allows none is believed. In "
             "simulated corridors wrong doors had 0.6 to 1.1 times the inliers of each other");
    v.number("rival_separation", self.rival_separation, 0.1, 1000.0,
             "and is so far away, in units of the keyframes' spacing: less is drift between two visits of "
             "one place");
    v.number("rivals_within_s", self.rivals_within_s, 0.0, 1e6,
             "after two rivals, for this long (seconds), a place near them is believed only within half "
             "their distance of the prediction, and if three standard deviations of that are less as well: "
             "the camera may stand before a third, which it never saw");
  }
};

/// Corners by which places are recognised (ORB; Rublee et al. 2011), and which two are the same.
struct PlaceFeaturesConfig {
  int max_count = 800;
  int fast_threshold = 8;
  int levels = 8;
  double level_factor = 1.2;
  int detected_per_taken = 8;
  int grid_columns = 8;
  int grid_rows = 6;
  int max_descriptor_bits = 64;
  int max_ratio_percent = 80;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("max_count", self.max_count, 1, 20000,
             "at most this many features an image (ORB-SLAM takes 1000 at this resolution); matching takes "
             "time with the square");
    v.number(
        "fast_threshold", self.fast_threshold, 1, 200,
        "FAST corner threshold (grey levels); low, as a lost image is often a blurred one; the strongest "
        "corners are taken first all the same");
    v.number("levels", self.levels, 1, 16, "scales on which features are found (as in ORB-SLAM)");
    v.number("level_factor", self.level_factor, 1.05, 4.0,
             "from one scale to the next (Rublee et al. 2011 and ORB-SLAM: 1.2)");
    v.number("detected_per_taken", self.detected_per_taken, 1, 100,
             "so many corners are detected for one that is taken: the strongest of a whole image may all lie "
             "on one striped cushion");
    v.number("grid_columns", self.grid_columns, 1, 64,
             "features are spread over a grid with this many columns; cells of 80 px at 640x480");
    v.number("grid_rows", self.grid_rows, 1, 64, "and this many rows; square cells at 4:3");
    v.number(
        "max_descriptor_bits", self.max_descriptor_bits, 0, 256,
        "two descriptors with more different bits do not match: those of one thing differ in 20 to 60 of "
        "256 bits, those of different things in 128 +- 20");
    v.number("max_ratio_percent", self.max_ratio_percent, 1, 100,
             "the nearest must be below this share of the bits of the second nearest (percent; Lowe 2004, "
             "Fig. 11: 80)");
  }
};

/// The pose from matched points (RANSAC and its refinement).
struct PlacePoseConfig {
  double inlier_gate_px = 3.0;
  int max_draws = 440;
  double failure_probability = 0.001;
  int refinement_rounds = 3;
  int steps_per_round = 5;
  double huber_px = 1.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.number(
        "inlier_gate_px", self.inlier_gate_px, 0.1, 100.0,
        "a point is an inlier if it is seen nearer to where the pose puts it (pixels of the level it was "
        "found on); three standard deviations of a corner that is found to a pixel");
    v.number("max_draws", self.max_draws, 1, 1000000,
             "draws of three points at most: log(0.001) / log(1 - 0.25^3), which finds three inliers among a "
             "quarter of inliers with 99.9 %");
    v.number(
        "failure_probability", self.failure_probability, 1e-9, 0.5,
        "drawing ends when three inliers were missed with no more than this probability, given the share "
        "of inliers found so far");
    v.number("refinement_rounds", self.refinement_rounds, 1, 100,
             "the pose is refined by its inliers, which are then found again, so often: the right points of "
             "three noisy ones are not all");
    v.number("steps_per_round", self.steps_per_round, 1, 100,
             "Gauss-Newton steps of each round; from a pose that is right to some pixels it converges "
             "quadratically, so in fewer");
    v.number("huber_px", self.huber_px, 0.01, 1e6,
             "residuals beyond this lose weight (Huber 1964; pixels of the level): one standard deviation of "
             "a corner, as matches have outliers");
  }
};

}  // namespace fusebench::config
