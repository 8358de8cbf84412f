// Records for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eval/record/record.hpp"

namespace fusebench::testing {

/// A record in which every number is different and awkward.
inline record::RunRecord sample_record() {
  using namespace metrics;
  using namespace trajectory_error;
  using namespace mesh_error;
  using namespace record;

  RunRecord record;
  record.status = RunStatus::ok;
  record.reason.clear();
  record.recording = {"fr1 \"rpy\"",
                      "tum",
                      "simulated",
                      240,
                      3,
                      7.9671,
                      "00ff",
                      "synthetic IMU",
                      "seed 1",
                      "pseudo ground truth",
                      {"stamps made \"regular\"", "warning: a gap"}};
  record.recording.whole_frames = 700;
  record.recording.start_ns = 1'305'031'229'528'748'000;
  record.variant = "full";
  record.config = {{"iekf.max_iterations", std::int64_t{8}, "--set"},
                   {"depth.max_m", 1.0, "default"},
                   {"terms.prior", std::string("imu"), "default"},
                   {"terms.visibility_test", false, "variant dm"}};
  record.config_hash = "0123456789abcdef";
  AteResult ate;
  ate.pairs = 239;
  ate.possible = 240;
  ate.coverage = 239.0 / 240.0;
  ate.max_difference_s = 0.02;
  ate.alignment = {"se3", {so3_exp({0.1, 0.2, 0.3}), {1.0 / 3.0, 2.0, 3.0}}};
  const std::vector<double> errors = {0.1, 0.2, 1.0 / 3.0};
  ate.stats = statistics(errors);
  record.metrics.ate = {ate, {}};
  RpeResult rpe;
  rpe.delta = 1;
  rpe.unit = DeltaUnit::frames;
  rpe.translation = rpe.rotation = statistics(errors);
  record.metrics.rpe_frame = {rpe, {}};
  record.metrics.rpe_second = {std::nullopt, "shorter than 1 s"};
  IntensityAccumulator intensity;
  intensity.add_frame(
      std::vector<IntensityResidual>{{1, 2.5F, false}, {2, 3.75F, false}});  // nothing accepted
  record.metrics.aie = {intensity.result(), {}};
  NeesResult nees;
  nees.part = kStateParts[1];
  nees.possible = 239;
  nees.stats = statistics(errors);
  nees.last = 0.7;
  record.metrics.nees[1] = {nees, {}};
  record.metrics.nees[2] = {std::nullopt, "no truth of it"};
  loop_error::LoopError loops;
  loops.places = 180;
  loops.sharp = {79, 78};
  loops.blurred = {45, 43};
  loops.verified = 122;
  loops.accepted = 121;
  loops.false_verified = 2;
  loops.false_accepted = 1;
  loops.median_translation_m = 1.0 / 300;
  loops.median_rotation_rad = 1.0 / 700;
  loops.nees_rotation = 0.9;
  loops.nees_position = 1.1;
  loops.oracle_ate_m = 1.0 / 90;
  record.loops = {loops, {}};
  RecordedMesh mesh;
  mesh.truth_sampling = {MeshSamples::vertices, 12, 3};
  mesh.truth_samples = 40;
  mesh.truth_observed = 30;
  mesh.views = 2;
  mesh.max_depth_m = 4.5;
  mesh.poses.alignment = {"poses", {so3_exp({0.2, 0.1, -0.3}), {1, 2, 3}}};
  mesh.poses.accuracy = {statistics(errors), 0.3, 0.32};
  mesh.poses.thresholds = {{0.01, 0.25, 0.75, 0.375}};
  mesh.first_camera.chamfer_m = 0.125;
  record.metrics.mesh = {mesh, {}};
  ResidualSummary residuals;
  residuals.chi2_photometric = 0.9;
  residuals.patches_tracked = 81.5;
  residuals.frames = 237;
  record.metrics.residuals = {residuals, {}};
  record.frames = {240, 238, 2};
  record.model = {1000, 2000, 30};
  record.timing = {1.5, 2.5, 123456789, 160.0, {{"decode", 1.25}, {"update", 3.5}}};
  record.provenance = {"0.1.0", "abc-dirty", "GNU 12.2.0", "-O3", "an estimator", "a cpu", 2, "a host"};
  return record;
}

/// sample_record() with what only some runs have.
inline record::RunRecord complete_record() {
  using namespace metrics;
  using namespace trajectory_error;
  using namespace record;

  RunRecord record = sample_record();
  FittedOffset fitted;
  fitted.stats = record.metrics.ate.value->stats;
  record.metrics.ate_fitted = {fitted, {}};
  record.metrics.rpe_second = record.metrics.rpe_frame;
  record.metrics.intensity_readings = {IntensityReadings{}, {}};
  record.metrics.mesh.value->first_camera.thresholds = record.metrics.mesh.value->poses.thresholds;
  record.metrics.mesh.value->poses.completeness = record.metrics.mesh.value->poses.accuracy;
  record.metrics.mesh.value->positions = record.metrics.mesh.value->first_camera;
  record.metrics.silent = {RecordedSilentFailures{}, {}};
  record.metrics.pose_intensity = {RecordedPoseIntensity{}, {}};
  const reference_clock::ClockedErrors clocked = {0.04, 0.02, 0.03, 12};
  record.metrics.reference_clock = {
      reference_clock::ReferenceClock{{0.066, 0.002, 100}, false, clocked, clocked}, {}};
  for (Outcome<NeesResult>& nees : record.metrics.nees) nees = record.metrics.nees[1];
  record.final_metrics = record.metrics;
  record.recording.camera = {calibration::CalibratedCamera{}, 5000};
  record.program = {"text", "1.2", 3};
  record.sensors = {{"imu_time_offset_s", 0.01, 0.002}};
  record.files = {{"mesh.ply", 12, "ff"}};
  record.timing.files = {{"frames.csv", 7, "aa"}};
  record.timing.histograms = {{"update", histogram_of({3, 4, 4.5, 20})}};
  return record;
}

}  // namespace fusebench::testing
