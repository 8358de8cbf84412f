// Calibration and ground truth: frames warped onto each other, and the misreading that would explain them
// better.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/inspection/checks.hpp"
#include "datasets/inspection/measures/order_statistics.hpp"
#include "datasets/inspection/misreadings.hpp"
#include "datasets/inspection/warp_pairs.hpp"

namespace fusebench::inspection {

namespace {

// A misreading is named if it lowers the residuals to this share, in most pairs. Fitted parameters always
// gain a little.
constexpr double kClearFactor = 0.75;
constexpr double kMinShareOfPairs = 0.7;
constexpr double kCorrectionFactor = 0.88;
constexpr int kRounds = 3;
constexpr double kOtherImageSize = 0.1;  // logarithm: less is an error of the focal length
// True poses leave a small part of the residuals of no motion at all; poses of something else leave about as
// much. The test is not significant where the ground truth itself hardly moves: turn plus baseline over
// depth.
constexpr double kStaticFactor = 1.1;
constexpr double kMinMotion_rad = radians(3);
// A camera that stands still is explained by any poses, depth scale, focal length and clock alike.
constexpr double kStill_rad = radians(0.3);

bool clear(const Comparison& c, double factor) { return c.factor < factor && c.wins >= kMinShareOfPairs; }

void measure_pairs(const recording::Recording& recording, const WarpTest& test,
                   ReprojectionMeasurement& out) {
  const auto residuals = test.residuals({});
  const std::int64_t gap_ns = truth_gap_ns(recording);
  std::vector<double> depth_m, depth_share, intensity;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!residuals[i]) continue;
    const measures::WarpPair& pair = test.pairs()[i];
    const auto from = trajectory::interpolate_pose(recording.ground_truth, pair.from_color_ns, gap_ns);
    const auto to = trajectory::interpolate_pose(recording.ground_truth, pair.to_color_ns, gap_ns);
    const SE3 motion = from->inverse() * *to;
    out.pairs.push_back({pair.from, pair.to, rotation_angle_rad(motion.rotation, Quaterniond::Identity()),
                         motion.translation.norm(), residuals[i]->depth_m, residuals[i]->depth_share,
                         residuals[i]->intensity_grey, residuals[i]->overlap});
    depth_m.push_back(residuals[i]->depth_m);
    depth_share.push_back(residuals[i]->depth_share);
    intensity.push_back(residuals[i]->intensity_grey);
  }
  out.depth_residual_m = measures::median(std::move(depth_m));
  out.depth_residual_share = measures::median(std::move(depth_share));
  out.intensity_residual_grey = measures::median(std::move(intensity));
}

std::string better_text(const Comparison& c) {
  return fmt::format("lowers the residuals of warped frames to {:.0f} % (better in {:.0f} % of pairs)",
                     100 * c.factor, 100 * c.wins);
}

/// What was found better in one round, and the reading with it.
struct Improvement {
  HypothesisResult result;
  Comparison comparison;
  measures::Reading reading;
  std::string reason = {};  ///< of a discrete misreading, with its hint
  std::string hint = {};
  bool must_beat_still = false;
};

// A later alternative must be better by this factor than an earlier, simpler one.
constexpr double kPreference = 0.97;

/// The discrete misreadings from the reading `base`, the best one of each code.
std::vector<Improvement> try_misreadings(const recording::Recording& recording, const WarpTest& test,
                                         const measures::Reading& base) {
  std::vector<Improvement> result;
  const auto residuals = test.residuals(base);
  for (const Misreading& misreading : misreadings(recording.rig.camera)) {
    measures::Reading reading = base;
    misreading.apply(reading);
    const Comparison c = test.screen(residuals, reading);
    Improvement tried{{misreading.code, misreading.name, 0, c.factor, c.wins},
                      c,
                      std::move(reading),
                      misreading.reason,
                      misreading.hint,
                      misreading.must_beat_still};
    const auto same_code = std::ranges::find_if(
        result, [&](const Improvement& other) { return other.result.code == misreading.code; });
    if (same_code == result.end()) {
      result.push_back(std::move(tried));
    } else if (c.factor < kPreference * same_code->comparison.factor) {
      *same_code = std::move(tried);
    }
  }
  return result;
}

/// The fitted parameters from the reading `base`.
std::vector<Improvement> try_parameters(const WarpTest& test, const measures::Reading& base) {
  std::vector<Improvement> result;
  const auto add = [&](const char* code, const char* name, const FittedParameter& fitted,
                       bool must_beat_still, const auto& change) {
    measures::Reading reading = base;
    change(reading);
    const Comparison& c = fitted.comparison;
    result.push_back(
        {{code, name, fitted.value, c.factor, c.wins}, c, std::move(reading), "", "", must_beat_still});
  };
  using measures::Reading;
  const FittedParameter depth = fit_depth_scale(test, base);
  add("depth-scale", "scaled depth", depth, false, [&](Reading& r) { r.depth_scale *= depth.value; });
  const FittedParameter focal = fit_focal_scale(test, base);
  add("focal-length", "scaled focal length", focal, false, [&](Reading& r) { r.focal_scale *= focal.value; });
  const FittedParameter image = fit_image_scale(test, base);
  add("image-size", "scaled intrinsics", image, false, [&](Reading& r) { r.image_scale *= image.value; });
  const FittedParameter truth = fit_truth_shift(test, base);
  add("truth-time-offset", "ground truth shifted in time", truth, true,
      [&](Reading& r) { r.truth_shift_ns += std::llround(1e9 * truth.value); });
  const FittedParameter delay = fit_depth_shift(test, base);
  add("depth-time-offset", "depth shifted in time", delay, true,
      [&](Reading& r) { r.depth_shift_ns += std::llround(1e9 * delay.value); });
  return result;
}

std::string image_size_text(double factor, const PinholeCamera& camera) {
  return fmt::format("{:.0f}x{:.0f}", camera.width_px / factor, camera.height_px / factor);
}

Finding finding_of_time(const std::string& code, double value_s, double frame_s, const std::string& better) {
  if (code == "depth-time-offset")
    return {
        code, Severity::error,
        fmt::format("depth images were taken {:.0f} ms {} than their stamps and delay_s: shifting them {}",
                    1e3 * std::abs(value_s), value_s > 0 ? "later" : "earlier", better),
        fmt::format("add {:+.3f} to delay_s in [depth] of calibration.toml, or correct the stamps of depth",
                    value_s)};
  const bool row = std::abs(std::abs(value_s / frame_s) - 1) < 0.15;
  return {code, Severity::error,
          fmt::format("the ground truth's stamps are {:.1f} ms {} than the images'{}: shifting them {}",
                      1e3 * std::abs(value_s), value_s > 0 ? "later" : "earlier", row ? ", one frame" : "",
                      better),
          row ? "match poses to images by their index, not by the number of the row"
              : fmt::format("add {:+.4f} s to the stamps of the ground truth", -value_s)};
}

Finding finding_of(const Improvement& found, const recording::Recording& recording, double frame_s) {
  const double value = found.result.value;
  const std::string better = better_text(found.comparison);
  Finding f{found.result.code, Severity::error, "", ""};
  if (f.code == "depth-scale") {
    f.message = fmt::format("depth is {:.3f} times too {}: scaling it by {:.3f} {}",
                            value < 1 ? 1 / value : value, value < 1 ? "large" : "small", value, better);
    f.hint = fmt::format(
        "multiply units_per_metre in [depth] of calibration.toml by {:.4g} (5000 for 1000 is 5)", 1 / value);
  } else if (f.code == "focal-length") {
    f.message = fmt::format("the focal length is {:.3f} of the true one: scaling fx and fy by {:.3f} {}",
                            1 / value, value, better);
    f.hint = "check fx_px and fy_px, and the size of the images for which they were calibrated";
  } else if (f.code == "image-size") {
    f.message = fmt::format(
        "the intrinsics are those of images of about {} pixels, and the images have {}: scaling "
        "fx, fy, cx and cy by {:.3f} {}",
        image_size_text(value, recording.rig.camera), image_size_text(1, recording.rig.camera), value,
        better);
    f.hint = fmt::format("multiply fx_px, fy_px, cx_px and cy_px by {:.4g}", value);
  } else if (found.reason.empty()) {
    return finding_of_time(f.code, value, frame_s, better);
  } else {
    f.message = found.reason + " " + better;
    f.hint = found.hint;
  }
  return f;
}

/// Whether, and how severely, an improvement is reported.
std::optional<Severity> severity_of(const Improvement& found, double frame_s) {
  const std::string& code = found.result.code;
  const double value = found.result.value;
  if (code == "depth-scale" || code == "focal-length") {
    const double off = std::abs(std::log(value));
    const double error_off = code == "depth-scale" ? 0.10 : 0.05;
    if (off > error_off && clear(found.comparison, kClearFactor)) return Severity::error;
    if (off > 0.02 && clear(found.comparison, kCorrectionFactor)) return Severity::warning;
    return std::nullopt;
  }
  if (code == "image-size") {
    if (std::abs(std::log(value)) > kOtherImageSize && clear(found.comparison, kClearFactor))
      return Severity::error;
    return std::nullopt;
  }
  // Smaller delays are measured before a run.
  if (code == "depth-time-offset") {
    if (std::abs(value) > frame_s && clear(found.comparison, kClearFactor)) return Severity::error;
    return std::nullopt;
  }
  if (code == "truth-time-offset") {
    const double off_s = std::abs(value);
    if (off_s > std::min(0.015, 0.5 * frame_s) && clear(found.comparison, kClearFactor))
      return Severity::error;
    if (off_s > 0.004 && clear(found.comparison, kCorrectionFactor)) return Severity::warning;
    return std::nullopt;
  }
  if (clear(found.comparison, kClearFactor)) return Severity::error;
  return std::nullopt;
}

/// Whether the poses of a reading explain the images clearly better than no motion at all.
bool beats_still(const WarpTest& test, const measures::Reading& reading) {
  measures::Reading still = reading;
  still.pose = [](const SE3&) { return SE3{}; };
  return clear(test.compare(test.residuals(still), reading), kClearFactor);
}

/// The best explanation first; then, with it, the next one: several faults may be there at once.
void search_misreadings(const recording::Recording& recording, const WarpTest& test,
                        ReprojectionMeasurement& measured, Inspection& out) {
  const double frame_s = std::max(1e-3, out.color_stamps.median_interval_s);
  measures::Reading reading;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Improvement> tried = try_misreadings(recording, test, reading);
    std::ranges::move(try_parameters(test, reading), std::back_inserter(tried));
    if (round == 0) {
      for (const Improvement& t : tried) measured.hypotheses.push_back(t.result);
    }
    const Improvement* best = nullptr;
    for (const Improvement& t : tried) {
      if (!severity_of(t, frame_s) || out.has(t.result.code)) continue;
      if (best != nullptr && t.comparison.factor >= kPreference * best->comparison.factor) continue;
      if (t.must_beat_still && !beats_still(test, t.reading)) continue;
      best = &t;
    }
    if (best == nullptr) return;
    const Finding finding = finding_of(*best, recording, frame_s);
    out.add(finding.code, *severity_of(*best, frame_s), finding.message, finding.hint);
    reading = best->reading;
  }
}

/// Whether something was found that makes the ground truth disagree with the images.
bool inconsistency_is_explained(const Inspection& out) {
  return std::ranges::any_of(out.findings, [](const Finding& f) {
    return f.severity == Severity::error &&
           (f.code.starts_with("truth-") || f.code == "depth-scale" || f.code == "depth-along-ray" ||
            f.code == "depth-time-offset" || f.code == "focal-length" || f.code == "image-size");
  });
}

/// Image motion of the median pair according to the ground truth.
double median_motion_rad(const ReprojectionMeasurement& measured, double depth_m) {
  std::vector<double> motion_rad;
  for (const ReprojectionPair& pair : measured.pairs)
    motion_rad.push_back(pair.rotation_rad + pair.translation_m / depth_m);
  return measures::median(std::move(motion_rad));
}

/// Depth out of the range of rooms is no finding where the ground truth explains the images with it, and
/// clearly worse with depth that is four times smaller or larger. Pure rotations do not depend on depth.
void drop_confirmed_depth_range(const WarpTest& test, const ReprojectionMeasurement& measured,
                                Inspection& out) {
  constexpr double kOther = 4;
  constexpr double kClearlyWorse = 1 / kClearFactor;
  constexpr double kSameScale = 0.1;
  if (!out.has("depth-range") || out.has("depth-scale")) return;
  const auto fitted = std::ranges::find(measured.hypotheses, "depth-scale", &HypothesisResult::code);
  if (fitted == measured.hypotheses.end() || std::abs(std::log(fitted->value)) > kSameScale) return;
  const auto residuals = test.residuals({});
  for (const double scale : {kOther, 1 / kOther}) {
    measures::Reading reading;
    reading.depth_scale = scale;
    if (test.compare(residuals, reading).factor < kClearlyWorse) return;
  }
  std::erase_if(out.findings, [](const Finding& finding) { return finding.code == "depth-range"; });
}

void report_inconsistency(const ReprojectionMeasurement& measured, Inspection& out) {
  if (inconsistency_is_explained(out) || !times_are_plausible(out)) return;
  if (measured.static_factor > kStaticFactor) return;
  if (median_motion_rad(measured, out.depth.median_m) < kMinMotion_rad) return;
  out.add("truth-inconsistent", Severity::error,
          fmt::format("the ground truth explains the images no better than no motion at all: warped frames "
                      "differ {:.1f} times as much, and none of the tested misreadings explains it",
                      1 / measured.static_factor),
          "check that the ground truth is that of the colour camera, of this recording and of its clock");
}

}  // namespace

void check_reprojection(const recording::Recording& recording, const Workers& workers,
                        const InspectOptions& options, Inspection& out) {
  if (recording.rig.camera.fx_px <= 0 || recording.rig.camera.fy_px <= 0) {
    out.add("focal-length", Severity::error,
            fmt::format("fx = {}, fy = {} (allowed: above 0)", recording.rig.camera.fx_px,
                        recording.rig.camera.fy_px),
            "images are stored top-down: use a positive fy_px and reflect the poses");
  }
  if (!out.truth || out.has("truth-time-unit") || out.has("truth-out-of-order") || out.depth.median_m <= 0)
    return;
  const WarpTest test(
      recording,
      load_pairs(recording, choose_pairs(recording, out.depth.median_m, options.pair_samples), workers),
      workers);
  ReprojectionMeasurement measured;
  measure_pairs(recording, test, measured);
  if (measured.pairs.empty()) {
    out.add(
        "reprojection-untested", Severity::note,
        "no pair of frames with ground truth sees the same place from two: the calibration is not tested");
    return;
  }
  measures::Reading still;
  still.pose = [](const SE3&) { return SE3{}; };
  measured.static_factor = test.compare(test.residuals({}), still).factor;
  if (const double motion_rad = median_motion_rad(measured, out.depth.median_m); motion_rad < kStill_rad) {
    out.add("reprojection-untested", Severity::note,
            fmt::format("by the ground truth the camera hardly moves between the frames that are compared "
                        "({:.1f} deg of view): "
                        "poses, calibration and stamps are not tested by the images",
                        degrees(motion_rad)),
            "with --frames A:B choose a part in which it moves");
  } else {
    search_misreadings(recording, test, measured, out);
    drop_confirmed_depth_range(test, measured, out);
    report_inconsistency(measured, out);
  }
  out.reprojection = std::move(measured);
}

}  // namespace fusebench::inspection
