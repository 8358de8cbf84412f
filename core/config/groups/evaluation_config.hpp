// Options: what of a run is measured, and how. No estimate depends on them.
#pragma once

#include "core/config/groups/option_choices.hpp"

namespace fusebench::config {

/// By which clock the reference's stamps are read.
enum class ReferenceTimeOffset { none, fitted };
constexpr auto option_choices(ReferenceTimeOffset) {
  return choices<ReferenceTimeOffset>(
      {{"none", ReferenceTimeOffset::none}, {"fitted", ReferenceTimeOffset::fitted}});
}

/// When a pose that the estimator claims is wrong (docs/metrics.md, undetected failures), and which intensity
/// errors are recorded; and when a run that went to its end has nothing to say.
struct EvaluationConfig {
  double silent_interval_s = 1.0;
  double silent_translation_m = 0.05;
  double silent_rotation_deg = 3.0;
  bool intensity_readings = false;
  bool pose_intensity = false;
  double min_tracked_share = 0.25;
  ReferenceTimeOffset reference_time_offset = ReferenceTimeOffset::none;

  static constexpr void visit(auto& self, auto&& v) {
    v.number("silent_interval_s", self.silent_interval_s, 0.01, 1000.0,
             "undetected failures: interval over which the motion of the estimate is compared with the "
             "ground truth (seconds)");
    v.number("silent_translation_m", self.silent_translation_m, 1e-4, 100.0,
             "a frame is an undetected failure if the error of that motion is larger than this");
    v.number("silent_rotation_deg", self.silent_rotation_deg, 0.01, 180.0,
             "or if it is rotated by more than this");
    v.flag("intensity_readings", self.intensity_readings,
           "also computes the intensity error by definitions other than AIE (docs/metrics.md)");
    v.flag("pose_intensity", self.pose_intensity,
           "also computes the intensity error of the poses alone, which is defined for every system "
           "(docs/metrics.md); reads the images a second time");
    v.number("min_tracked_share", self.min_tracked_share, 0.0, 1.0,
             "a run that tracks a smaller share of its frames has status lost, even if iekf.max_lost_frames "
             "did not end it");
    v.choice("reference_time_offset", self.reference_time_offset,
             "stamps of the ground truth for ATE, RPE and undetected failures: as recorded, or shifted by "
             "the fitted offset of its clock if the motion makes it observable (docs/metrics.md, reference "
             "clock); records contain both results");
  }
};

}  // namespace fusebench::config
