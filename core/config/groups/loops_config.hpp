// Options: what is made of places that a camera has come back to.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// What is made of a place that is seen again.
enum class LoopMode { off, detect, final, online };
constexpr auto option_choices(LoopMode) {
  return choices<LoopMode>({{"off", LoopMode::off},
                            {"detect", LoopMode::detect},
                            {"final", LoopMode::final},
                            {"online", LoopMode::online}});
}

/// Loops: the pose graph of places (keyframes of the whole path), and its edges.
struct LoopsConfig {
  LoopMode mode = LoopMode::off;
  /// A fused frame becomes a place at this distance from the last place (metres).
  static constexpr double place_distance_m = 0.25;
  /// A fused frame becomes a place when it has turned by this angle since the last place (degrees).
  static constexpr double place_angle_deg = 15.0;
  int query_every = 10;
  double least_age_s = 10.0;
  int max_features = 400;
  /// Candidates by appearance that are verified, the most similar first.
  static constexpr int max_candidates = 8;
  double max_dissimilarity = 0.7;
  int max_path_candidates = 3;
  /// Least share of the depth pixels of either frame that lie on the surface seen by the other one.
  static constexpr double min_consistent_share = 0.25;
  double max_violating_share = 0.05;
  /// A point lies on the surface within this many standard deviations of the depth noise plus 1 cm.
  static constexpr double depth_sigmas = 3.0;
  /// Dense alignment: largest distance of a point to its plane in the first iterations (metres), a quarter of
  /// it in the last ones.
  static constexpr double dense_gate_m = 0.12;
  /// Dense alignment: least share of the pixels within the gate.
  static constexpr double dense_min_share = 0.1;
  /// Dense alignment: number of independent measurements that a full image counts as; errors of neighbouring
  /// pixels are correlated.
  static constexpr double dense_measurements = 400.0;
  /// Least correlation of the grey levels of a pair that is verified by depth alone.
  static constexpr double min_grey_correlation = 0.6;
  /// Largest standard deviation of the rotation of a pair that is verified by depth alone (degrees, any
  /// axis).
  static constexpr double max_rotation_sigma_deg = 0.25;
  /// The same for its position (metres).
  static constexpr double max_position_sigma_m = 0.01;
  double drift_factor = 3.0;
  /// Least standard deviation of the motion between consecutive places: rotation, by axis (rad).
  static constexpr double path_rotation_sigma_rad = 0.003;
  /// The same for the position (metres).
  static constexpr double path_position_sigma_m = 0.004;
  /// Error of a loop edge beyond that of its features: rotation, by axis (rad).
  static constexpr double loop_rotation_sigma_rad = 0.001;
  /// The same for the position (metres).
  static constexpr double loop_position_sigma_m = 0.002;
  double timing_sigma_s = 0.003;
  /// Error of the direction of gravity that all places have in common, with an IMU (degrees): bias and scale
  /// of the accelerometer.
  static constexpr double gravity_sigma_deg = 0.5;
  double max_chi2 = 22.5;
  /// Limit of the same distance for an edge that agrees with another one. Beyond it no support counts: places
  /// that look alike give edges that agree with each other.
  static constexpr double max_supported_chi2 = 225.0;
  /// Two edges agree if their squared distance is below this (chi-square, six degrees of freedom, 1 %).
  static constexpr double agreeing_chi2 = 16.8;
  /// Largest difference in time of two edges that support each other (seconds).
  static constexpr double agreeing_within_s = 2.0;
  /// Loops with a larger residual after the optimisation are dropped (root mean square over six degrees of
  /// freedom); the rest is optimised again.
  static constexpr double worst_edge_sigmas = 3.0;
  double online_translation_m = 0.01;
  double online_rotation_deg = 0.5;
  int online_every = 100;
  int max_online_corrections = 5;
  double max_pending_s = 5.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice("mode", self.mode,
             "off; detect: loops are detected and listed with the reason of each decision, poses stay "
             "unchanged; final: all poses are optimised at the end, and the model is fused again; online: "
             "also during the recording, when a loop contradicts the poses");
    v.number("query_every", self.query_every, 1, 1000,
             "a fused frame is stored as a place every this many fused frames (or after 0.25 m or 15 "
             "degrees); about 0.2 MB per place at 640x480");
    v.number("least_age_s", self.least_age_s, 0.5, 1000.0,
             "least time between the two places of a loop (seconds); the model contains all younger frames");
    v.number(
        "max_features", self.max_features, 20, 20000,
        "largest number of features of a place, detected at half the image size, but at least 320 pixels");
    v.number("max_dissimilarity", self.max_dissimilarity, 0.05, 1.0,
             "share of the ferns in which two similar places may differ (Glocker et al. 2015)");
    v.number(
        "max_path_candidates", self.max_path_candidates, 0, 100,
        "number of candidates by the current poses, nearest views first, in addition to eight by appearance");
    v.number("max_violating_share", self.max_violating_share, 0.0, 1.0,
             "largest share of the depth of either frame that may be in the free space of the other one");
    v.number("timing_sigma_s", self.timing_sigma_s, 0.0, 0.1,
             "standard deviation of the times of colour, depth and their rows (seconds); the camera motion "
             "during it is added to the error of an edge");
    v.number("max_chi2", self.max_chi2, 1.0, 1000.0,
             "largest squared Mahalanobis distance between a single edge and the current poses (chi-square, "
             "six degrees of freedom; 0.1 %)");
    v.number(
        "online_translation_m", self.online_translation_m, 0.0, 1.0,
        "with mode online, least translation of the current pose for which all poses are corrected (metres)");
    v.number(
        "online_rotation_deg", self.online_rotation_deg, 0.0, 90.0,
        "with mode online, least rotation of the current pose for which all poses are corrected (degrees)");
    v.number("online_every", self.online_every, 1, 100000,
             "with mode online, least number of fused frames between two corrections: each fuses all frames "
             "again");
    v.number("max_online_corrections", self.max_online_corrections, 0, 1000,
             "with mode online, largest number of corrections in a recording");
    v.number("max_pending_s", self.max_pending_s, 0.0, 1000.0,
             "with mode online, time during which surfaces that are older than least_age_s and do not fit "
             "are not overwritten (seconds; 0: they are overwritten at once)");
    v.number("drift_factor", self.drift_factor, 0.1, 100.0,
             "factor on the filter's standard deviation of the drift between places; its NEES on realistic "
             "recordings is 10 to 30");
  }
};

}  // namespace fusebench::config
