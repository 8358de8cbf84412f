// Options: the system that runs, and the options of each system other than the paper's.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// The method as a whole.
enum class SystemMethod { filter, infinitam, opencv_odometry, bundlefusion, elasticfusion };
constexpr auto option_choices(SystemMethod) {
  return choices<SystemMethod>({{"filter", SystemMethod::filter},
                                {"infinitam", SystemMethod::infinitam},
                                {"opencv_odometry", SystemMethod::opencv_odometry},
                                {"bundlefusion", SystemMethod::bundlefusion},
                                {"elasticfusion", SystemMethod::elasticfusion}});
}

/// The system that runs.
struct SystemConfig {
  SystemMethod method = SystemMethod::filter;
  double replicate_noise = 1e-6;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice(
        "method", self.method,
        "the system that runs: the paper's filter (all groups without the name of a system); InfiniTAM "
        "(Kaehler et al. 2015), OpenCV's frame-to-frame odometries or BundleFusion (Dai et al. 2017), with "
        "the depth and tsdf options; or ElasticFusion (Whelan et al. 2015), with depth.min_m and max_m");
    v.number("replicate_noise", self.replicate_noise, 0.0, 0.01,
             "standard deviation of the seeded noise on the initial pose of replicate k > 0 (--replicates), "
             "in metres and radians");
  }
};

/// Which of its trackers InfiniTAM uses.
enum class InfinitamTracker { extended, icp };
constexpr auto option_choices(InfinitamTracker) {
  return choices<InfinitamTracker>(
      {{"extended", InfinitamTracker::extended}, {"icp", InfinitamTracker::icp}});
}

/// InfiniTAM's reaction to a frame that its quality measure classifies as a failure.
enum class InfinitamFailure { ignore, stop_fusion, relocalise };
constexpr auto option_choices(InfinitamFailure) {
  return choices<InfinitamFailure>({{"ignore", InfinitamFailure::ignore},
                                    {"stop_fusion", InfinitamFailure::stop_fusion},
                                    {"relocalise", InfinitamFailure::relocalise}});
}

/// Whether the known defects of a published program are kept.
enum class PeerDefects { fixed, as_published };
constexpr auto option_choices(PeerDefects) {
  return choices<PeerDefects>({{"fixed", PeerDefects::fixed}, {"as_published", PeerDefects::as_published}});
}

/// InfiniTAM v3: the tracker's schedule, gates and weights. Defaults are the program's.
struct InfinitamConfig {
  InfinitamTracker tracker = InfinitamTracker::extended;
  bool use_color = false;
  int rotation_levels = 2;
  int full_levels = 2;
  int iterations_coarse = 20;
  int iterations_fine = 50;
  double gate_coarse = 0.1;
  double gate_fine = 0.004;
  /// The bound of the squared distance of the extended tracker is this many times the gate.
  static constexpr double gate_factor = 8.0;
  double min_step = 1e-4;
  /// After a hundred frames the extended tracker does not use surfaces of this weight or less.
  static constexpr int frames_to_skip = 20;
  /// After a hundred frames a match of the extended tracker weighs in proportion to the weight of the surface
  /// above that, up to 1 at this weight.
  static constexpr int frames_to_weight = 50;
  /// Factor on the residuals of intensity.
  static constexpr double color_weight = 0.3;
  /// Width of Tukey's norm of the coarsest level (intensities from 0 to 1).
  static constexpr double color_gate_coarse = 0.175;
  /// Width of Tukey's norm of the finest level.
  static constexpr double color_gate_fine = 0.005;
  /// Pixels whose gradient is smaller in x or y are not used (intensity per pixel).
  static constexpr double min_color_gradient = 0.01;
  /// A frame is good if this share of its depth pixels has a match on the finest level; a plain gate in place
  /// of the program's trained classifier.
  static constexpr double good_inlier_share = 0.5;
  /// Below this share a frame has failed; between the two it is poor and not fused.
  static constexpr double failed_inlier_share = 0.2;
  InfinitamFailure on_failure = InfinitamFailure::ignore;
  PeerDefects defects = PeerDefects::fixed;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice("tracker", self.tracker,
             "extended: robust weights by distance and confidence; icp: KinectFusion's tracker");
    v.flag("use_color", self.use_color,
           "the extended tracker also aligns intensities with the previous frame");
    v.number("rotation_levels", self.rotation_levels, 0, 6,
             "coarsest levels of the depth pyramid, which only rotate");
    v.number("full_levels", self.full_levels, 1, 6, "finer levels, which move in all six directions");
    v.number("iterations_coarse", self.iterations_coarse, 1, 200,
             "most iterations of the coarsest level; levels between are interpolated");
    v.number("iterations_fine", self.iterations_fine, 1, 200, "most iterations of the finest level");
    v.number("gate_coarse", self.gate_coarse, 1e-6, 10.0,
             "of the coarsest level: width of Huber's norm (metres; extended), and bound of the squared "
             "distance of a match (square metres), with gate_factor; levels between are interpolated");
    v.number("gate_fine", self.gate_fine, 1e-6, 10.0, "the same of the finest level");
    v.number("min_step", self.min_step, 0.0, 1.0, "a level ends when a step is smaller (radians and metres)");
    v.choice("on_failure", self.on_failure,
             "reaction to bad tracking: none (the program's default), bad frames are not fused, or the pose "
             "is searched among stored frames (Glocker et al. 2015)");
    v.choice("defects", self.defects,
             "as_published: the relocaliser's tests read only the top left quarter of its image");
  }
};

/// OpenCV's odometries (module rgbd).
enum class OdometryMethod { rgbd, icp, rgbd_icp, fast_icp };
constexpr auto option_choices(OdometryMethod) {
  return choices<OdometryMethod>({{"rgbd", OdometryMethod::rgbd},
                                  {"icp", OdometryMethod::icp},
                                  {"rgbd_icp", OdometryMethod::rgbd_icp},
                                  {"fast_icp", OdometryMethod::fast_icp}});
}

/// OpenCV's odometries from frame to frame, with the library's own settings.
struct OpencvOdometryConfig {
  OdometryMethod method = OdometryMethod::rgbd_icp;

  static constexpr void visit(auto& self, auto&& v) {
    v.choice("method", self.method,
             "colour (Steinbruecker et al. 2011), depth, both, or depth as KinectFusion has it");
  }
};

/// BundleFusion: weights of its adjustments, and selection of keypoints. Defaults are the program's, except
/// for dense_far_m.
struct BundlefusionConfig {
  /// Keypoints of a frame, at most, the strongest first.
  static constexpr int max_keypoints = 1024;
  double min_keypoint_scale_px = 3.0;
  /// Depth below this is not used to find poses (metres); depth.min_m is the model's.
  static constexpr double keypoint_min_depth_m = 0.1;
  /// Depth above this is not used to find poses (metres); depth.max_m is the model's.
  static constexpr double keypoint_max_depth_m = 4.0;
  /// Weight of squared distances of matched keypoints.
  static constexpr double sparse_weight = 1.0;
  /// Weight of squared distances of points from planes within a chunk of frames; 0: not compared.
  static constexpr double dense_weight = 2.0;
  /// The same among all chunks at the end.
  static constexpr double final_dense_weight = 15.0;
  double dense_far_m = 4.0;
  double max_residual_m = 0.08;

  static constexpr void visit(auto& self, auto&& v) {
    v.number(
        "dense_far_m", self.dense_far_m, 0.1, 100.0,
        "depth at which its weight (1 - z / dense_far_m)^2.5 reaches 0 (metres). The authors changed this "
        "function in the source for each published sequence; here one setting is used for all recordings");
    v.number(
        "min_keypoint_scale_px", self.min_keypoint_scale_px, 0.0, 100.0,
        "standard deviation of the Gaussian at which a keypoint is found (pixels); finer ones are not used");
    v.number("max_residual_m", self.max_residual_m, 0.001, 10.0,
             "the worst pair of chunks is dropped if its keypoints are further apart along an axis (metres)");
  }
};

/// Which loops ElasticFusion closes.
enum class ElasticfusionLoops { none, local, all };
constexpr auto option_choices(ElasticfusionLoops) {
  return choices<ElasticfusionLoops>({{"none", ElasticfusionLoops::none},
                                      {"local", ElasticfusionLoops::local},
                                      {"all", ElasticfusionLoops::all}});
}

/// ElasticFusion: tracking, surfels and loops. Defaults are the article's or, where it has none, the
/// program's.
struct ElasticfusionConfig {
  /// Factor on distances from planes (metres) beside differences of intensity (grey levels, each divided by
  /// their deviation and its own size).
  static constexpr double icp_weight = 10.0;
  bool rotation_start = true;
  double stable_confidence = 10.0;
  int time_window = 200;
  ElasticfusionLoops loops = ElasticfusionLoops::all;
  /// Fewest matched pixels of a local loop, for an image of 640x480 (the program: 40000).
  static constexpr double loop_min_inliers = 35000.0;
  /// Most of the root of the summed squared distances of a local loop by the number of matches, for 640x480
  /// (the program: 4e-5).
  static constexpr double loop_max_error_m = 5e-5;
  /// Most of any diagonal entry of the inverse normal equations of a local loop, for 640x480.
  static constexpr double loop_max_variance = 1e-5;
  bool relocalise = false;
  bool use_imu = false;
  PeerDefects defects = PeerDefects::fixed;

  static constexpr void visit(auto& self, auto&& v) {
    v.flag("rotation_start", self.rotation_start,
           "tracking starts from the rotation between the last two small images");
    v.number("stable_confidence", self.stable_confidence, 0.0, 1000.0,
             "surfels with more confidence are stable: tracking uses them, and they are never removed");
    v.number(
        "time_window", self.time_window, 1, 1000000,
        "surfels without an update for this many frames are inactive: tracking and fusion do not use them");
    v.choice("loops", self.loops,
             "none; local: the active model is registered to the inactive one in view; all: places that "
             "ferns recognise as well");
    v.flag("relocalise", self.relocalise,
           "a frame with a bad fit is lost and not fused, and its pose is searched by ferns");
    v.flag("use_imu", self.use_imu,
           "tracking with the inertial term of Laidlow et al. 2017 and its prediction");
    v.choice(
        "defects", self.defects,
        "as_published keeps five errors of the program: intensities are weighted by the number of pixels "
        "instead of their deviation and compared at whole pixels, planes have a tenth of their weight, blue "
        "has red's weight, and holes of a view that is registered for a loop are black; fixed: without them");
  }
};

}  // namespace fusebench::config
