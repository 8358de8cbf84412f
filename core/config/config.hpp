// Every option of the estimator, declared once: name, default, range and one sentence (with its source). The
// groups are in core/config/groups, in the order of processing.
// The file reader, --set, range checks, `fusebench config`, docs/configuration.md and the configuration hash
// all derive from the visit() of each struct (see options.hpp). A field without an option does not compile.
#pragma once

#include "core/config/groups/alignment_config.hpp"
#include "core/config/groups/evaluation_config.hpp"
#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/config/groups/loops_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/relocalisation_config.hpp"
#include "core/config/groups/residuals_config.hpp"
#include "core/config/groups/systems_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/config/options.hpp"

namespace fusebench::config {

/// The whole effective configuration of a run.
struct Config {
  SystemConfig system;
  TermsConfig terms;
  DepthConfig depth;
  CompensationConfig compensation;
  MotionConfig motion;
  InitialisationConfig initialisation;
  SelfCalibrationConfig self_calibration;
  PatchConfig patches;
  PhotometricConfig photometric;
  GeometricConfig geometric;
  AlignmentConfig alignment;
  IekfConfig iekf;
  ColorDriftConfig color_drift;
  HealthConfig health;
  RelocalisationConfig relocalisation;
  PlaceFeaturesConfig place_features;
  SegmentsConfig segments;
  LoopsConfig loops;
  TsdfConfig tsdf;
  InfinitamConfig infinitam;
  OpencvOdometryConfig opencv_odometry;
  BundlefusionConfig bundlefusion;
  ElasticfusionConfig elasticfusion;
  EvaluationConfig evaluation;

  static constexpr void visit(auto& self, auto&& v) {
    v.group("system", self.system);
    v.group("terms", self.terms);
    v.group("depth", self.depth);
    v.group("compensation", self.compensation);
    v.group("motion", self.motion);
    v.group("initialisation", self.initialisation);
    v.group("self_calibration", self.self_calibration);
    v.group("patches", self.patches);
    v.group("photometric", self.photometric);
    v.group("geometric", self.geometric);
    v.group("alignment", self.alignment);
    v.group("iekf", self.iekf);
    v.group("color_drift", self.color_drift);
    v.group("health", self.health);
    v.group("relocalisation", self.relocalisation);
    v.group("place_features", self.place_features);
    v.group("segments", self.segments);
    v.group("loops", self.loops);
    v.group("tsdf", self.tsdf);
    v.group("infinitam", self.infinitam);
    v.group("opencv_odometry", self.opencv_odometry);
    v.group("bundlefusion", self.bundlefusion);
    v.group("elasticfusion", self.elasticfusion);
    v.group("evaluation", self.evaluation);
  }
};

static_assert(
    options_cover_all_fields<SystemConfig, TermsConfig, DepthConfig, CompensationConfig, MotionConfig,
                             InitialisationConfig, SelfCalibrationConfig, PatchConfig, PhotometricConfig,
                             GeometricConfig, AlignmentConfig, IekfConfig, ColorDriftConfig, HealthConfig,
                             RelocalisationConfig, PlaceFeaturesConfig, SegmentsConfig, LoopsConfig,
                             TsdfConfig, InfinitamConfig, OpencvOdometryConfig, BundlefusionConfig,
                             ElasticfusionConfig, EvaluationConfig, Config>(),
    "each field of a configuration struct needs its option in visit()");

}  // namespace fusebench::config
