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
  double rival_support = 0.5;
  double lookalike_density = 1e-6;
  double min_odds = 100.0;

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
    v.number("rival_support", self.rival_support, 0.0, 1.0,
             "a place is a candidate beside the best if it has this share of its inliers (of the depth that "
             "agrees, where there are no features). In simulated corridors wrong doors had 0.6 to 1.1 times the "
             "inliers of each other");
    v.number("lookalike_density", self.lookalike_density, 0.0, 1e6,
             "places outside of the map that look like one inside, per cubic metre and cubic radian (of which "
             "there are 79): 1e-6 is one in 13,000 m3, a large floor of a building. It bounds how uncertain dead "
             "reckoning may be when a place is believed");
    v.number("min_odds", self.min_odds, 1.0, 1e12,
             "a place is believed if it is this many times as probable as all others that look like it, known or "
             "not");
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
