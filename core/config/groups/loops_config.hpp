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
  double place_distance_m = 0.25;
  double place_angle_deg = 15.0;
  int query_every = 10;
  double least_age_s = 10.0;
  int max_features = 400;
  int max_candidates = 8;
  double max_dissimilarity = 0.7;
  int max_path_candidates = 3;
  double min_consistent_share = 0.25;
  double max_violating_share = 0.05;
  double depth_sigmas = 3.0;
  double dense_gate_m = 0.12;
  double dense_min_share = 0.1;
  double dense_measurements = 400.0;
  double min_grey_correlation = 0.6;
  double max_rotation_sigma_deg = 0.25;
  double max_position_sigma_m = 0.01;
  double drift_factor = 3.0;
  double path_rotation_sigma_rad = 0.003;
  double path_position_sigma_m = 0.004;
  double loop_rotation_sigma_rad = 0.001;
  double loop_position_sigma_m = 0.002;
  double timing_sigma_s = 0.003;
  double gravity_sigma_deg = 0.5;
  double max_chi2 = 22.5;
  double max_supported_chi2 = 225.0;
  double agreeing_chi2 = 16.8;
  double agreeing_within_s = 2.0;
  double worst_edge_sigmas = 3.0;
  double online_translation_m = 0.01;
  double online_rotation_deg = 0.5;
  int online_every = 100;
  int max_online_corrections = 5;
  double max_pending_s = 5.0;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice(
        "mode", self.mode,
        "off (relocalisation by depth is verified by max_dissimilarity and min_consistent_share to "
        "max_position_sigma_m all the same); detect: places that are seen again are logged, with why each "
        "was taken or refused, and "
        "change nothing; final: at the end all poses are optimised once, and the model is fused again; "
        "online: the same while the recording runs as well, whenever a loop says that the poses are wrong");
    v.number("place_distance_m", self.place_distance_m, 0.02, 5.0,
             "a fused frame becomes a place if the last place is farther away than this, or");
    v.number("place_angle_deg", self.place_angle_deg, 1.0, 90.0, "turned by more than this, or");
    v.number("query_every", self.query_every, 1, 1000,
             "after so many fused frames: each place is compared with the older ones, and kept (about 0.2 MB "
             "each at 640x480)");
    v.number("least_age_s", self.least_age_s, 0.5, 1000.0,
             "with those that were seen at least so long ago (the model itself holds what is younger)");
    v.number("max_features", self.max_features, 20, 20000,
             "at most so many features a place, of the image at half its size (not below 320 pixels): depth "
             "refines what they say, and motion blur leaves no finer ones");
    v.number("max_candidates", self.max_candidates, 1, 100, "the most similar so many of them are verified");
    v.number("max_dissimilarity", self.max_dissimilarity, 0.05, 1.0,
             "share of the ferns that may differ (Glocker et al. 2015)");
    v.number("max_path_candidates", self.max_path_candidates, 0, 100,
             "and so many more that see the same by the poses so far, those with the nearest view first");
    v.number("min_consistent_share", self.min_consistent_share, 0.01, 1.0,
             "of the depth of either frame at least this share lies on the surface that the other one sees");
    v.number("max_violating_share", self.max_violating_share, 0.0, 1.0,
             "and at most this share before it, where the other one saw free space");
    v.number("depth_sigmas", self.depth_sigmas, 1.0, 20.0,
             "on the surface: within so many standard deviations of the depth noise, and 1 cm more");
    v.number("dense_gate_m", self.dense_gate_m, 0.01, 1.0,
             "the pose of a pair is refined by points of one on planes of the other, at a quarter of the "
             "size: those that are nearer than this (metres) at first, and than a quarter of it at the end");
    v.number("dense_min_share", self.dense_min_share, 0.01, 1.0,
             "by no smaller a share of the pixels than this");
    v.number("dense_measurements", self.dense_measurements, 1.0, 20000.0,
             "an image full of them tells as much as so many independent ones: errors of neighbouring depths "
             "are common");
    v.number("min_grey_correlation", self.min_grey_correlation, -1.0, 1.0,
             "a pair that features do not verify is verified by depth, starting where the path leads: where "
             "the depth fits, the intensities of both have to correlate at least so well, and");
    v.number("max_rotation_sigma_deg", self.max_rotation_sigma_deg, 0.01, 10.0,
             "the pose has to be known to this along every axis: rotation (degrees)");
    v.number("max_position_sigma_m", self.max_position_sigma_m, 0.001, 1.0, "and position (metres)");
    v.number("drift_factor", self.drift_factor, 0.1, 100.0,
             "drift between places is this much larger than the filter claims (standard deviations): its "
             "claims on realistic recordings have an NEES of 10 to 30");
    v.number("path_rotation_sigma_rad", self.path_rotation_sigma_rad, 1e-5, 0.1,
             "and the motion from a place to the next one is at least so uncertain, by axis: rotation (rad)");
    v.number("path_position_sigma_m", self.path_position_sigma_m, 1e-5, 0.1, "and position (metres)");
    v.number("loop_rotation_sigma_rad", self.loop_rotation_sigma_rad, 1e-5, 0.1,
             "what a loop's features do not say of its error, by axis: rotation (rad)");
    v.number("loop_position_sigma_m", self.loop_position_sigma_m, 1e-5, 0.1, "and position (metres)");
    v.number(
        "timing_sigma_s", self.timing_sigma_s, 0.0, 0.1,
        "and what the camera moved within this time (seconds): instants of colour and depth, and of rows, "
        "are known no better");
    v.number("gravity_sigma_deg", self.gravity_sigma_deg, 0.01, 45.0,
             "error of the direction of gravity of all places together, with an IMU: its errors (bias and "
             "scale of the accelerometer) are common to them");
    v.number(
        "max_chi2", self.max_chi2, 1.0, 1000.0,
        "an edge whose squared distance to the poses so far, by their drift and its own error, is larger "
        "(six degrees of freedom; 0.1 %) is not taken alone");
    v.number(
        "max_supported_chi2", self.max_supported_chi2, 1.0, 1e6,
        "up to this, ten times as much, it is taken with another one that it agrees with; beyond, nothing "
        "supports it: rooms that are alike support each other");
    v.number("agreeing_chi2", self.agreeing_chi2, 1.0, 1000.0, "agrees: as well as this (1 %)");
    v.number("agreeing_within_s", self.agreeing_within_s, 0.1, 100.0, "and that is so near in time");
    v.number("worst_edge_sigmas", self.worst_edge_sigmas, 1.0, 100.0,
             "after the optimisation edges with a larger residual (root mean square over six degrees of "
             "freedom) are dropped, and all is optimised again until none is left");
    v.number("online_translation_m", self.online_translation_m, 0.0, 1.0,
             "with mode online poses are corrected if the current one moves by more than this (metres) or");
    v.number("online_rotation_deg", self.online_rotation_deg, 0.0, 90.0, "turns by more than this,");
    v.number("online_every", self.online_every, 1, 100000,
             "no sooner than so many fused frames after the last attempt, since all frames so far are fused "
             "again each time, and");
    v.number("max_online_corrections", self.max_online_corrections, 0, 1000,
             "at most so often in a recording");
    v.number(
        "max_pending_s", self.max_pending_s, 0.0, 1000.0,
        "as long as such a correction may come, surfaces that were seen least_age_s ago and do not fit are "
        "not fused over for so many seconds (0: they are at once)");
  }
};

}  // namespace fusebench::config
