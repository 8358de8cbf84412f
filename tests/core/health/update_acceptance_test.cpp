#include "core/health/update_acceptance.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/config/groups/patches_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench {

using namespace config;
using namespace patches;
using namespace measurement;
using namespace health;

namespace {

/// The groups of options that these tests need.
struct AcceptanceOptions {
  TermsConfig terms;
  IekfConfig iekf;
  HealthConfig health;
};

FrameReport report_with(int accepted, double chi2_photometric) {
  FrameReport report;
  report.patches = 40;
  report.patches_accepted = accepted;
  report.chi2_photometric = chi2_photometric;
  return report;
}

TEST(UpdateAcceptance, TooFewPatchesAreNeverBelieved) {
  const AcceptanceOptions config;
  const std::string reason =
      rejection_reason(report_with(config.iekf.min_patches - 1, 1), config.terms, config.iekf, config.health);
  EXPECT_NE(reason.find("4 of 40 patches were usable (iekf.min_patches = 5)"), std::string::npos) << reason;
  EXPECT_EQ(
      rejection_reason(report_with(config.iekf.min_patches, 1), config.terms, config.iekf, config.health),
      "");
}

TEST(UpdateAcceptance, PatchesThatAreNotRecognisedAreNotBelieved) {
  AcceptanceOptions config;
  FrameReport report = report_with(30, 1);
  report.correlation = 0.29;
  EXPECT_NE(rejection_reason(report, config.terms, config.iekf, config.health).find("correlation is 0.29"),
            std::string::npos);
  report.correlation = 0.31;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
  config.health.min_correlation = 0.4;
  EXPECT_NE(rejection_reason(report, config.terms, config.iekf, config.health), "");
  config.terms.photometric_weight = 0;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
}

TEST(UpdateAcceptance, APoseThatMostIntensitiesContradictIsNotBelieved) {
  const AcceptanceOptions config;
  FrameReport report = report_with(30, 1);
  report.patches_tracked = 36;
  report.patches_contradicting = 18;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
  report.patches_contradicting = 19;
  EXPECT_NE(
      rejection_reason(report, config.terms, config.iekf, config.health).find("19 of 36 tracked patches"),
      std::string::npos);
}

TEST(UpdateAcceptance, DoesNotDependOnRelocalisation) {
  AcceptanceOptions config;
  config.terms.relocalisation = false;
  FrameReport contradicted = report_with(30, 1);
  contradicted.patches_tracked = 36;
  contradicted.patches_contradicting = 19;
  EXPECT_NE(rejection_reason(contradicted, config.terms, config.iekf, config.health), "");
  FrameReport uncertain = report_with(30, 1);
  uncertain.certainty.position_sigma_m = 2 * config.health.max_position_sigma_m;
  EXPECT_NE(rejection_reason(uncertain, config.terms, config.iekf, config.health), "");
}

TEST(UpdateAcceptance, HowLongAnOcclusionIsKeptOutIsAnOption) {
  FrameReport report;
  report.status = FrameStatus::tracked;
  report.health = FrameHealth::occluded;
  for (const int frames : {0, 3}) {
    const HealthConfig config{.max_occluded_frames = frames};
    OcclusionGate gate;
    for (int frame = 1; frame <= frames; ++frame) EXPECT_FALSE(gate.admits(report, config)) << frame;
    EXPECT_TRUE(gate.admits(report, config)) << frames;
  }
}

TEST(UpdateAcceptance, OnlyAcceptedPatchesOfSmallErrorSurvive) {
  PatchConfig config;
  std::vector<Patch> patches(3);
  patches[2].age = 7;
  std::vector<PatchOutcome> outcomes(3);
  for (PatchOutcome& outcome : outcomes) outcome.accepted = true;
  outcomes[0].accepted = false;
  outcomes[1].mean_error_grey = config.max_mean_error + 1;
  outcomes[2].centre_px = {12, 34};
  std::vector<TrackedCentre> survivors(5);
  find_survivors(patches, outcomes, config, survivors);
  ASSERT_EQ(survivors.size(), 1U);
  EXPECT_EQ(survivors[0].pixel_px, Vector2d(12, 34));
  EXPECT_EQ(survivors[0].age, 8);
}

TEST(UpdateAcceptance, OnlyPatchesThatKeepTheirShapeAreKept) {
  PatchConfig config;
  const std::vector<Patch> patches(3);
  std::vector<PatchOutcome> outcomes(3);
  for (PatchOutcome& outcome : outcomes) outcome.accepted = true;
  outcomes[0].shrunk = true;
  outcomes[1].extended = true;
  std::vector<TrackedCentre> survivors;
  find_survivors(patches, outcomes, config, survivors);
  for (const TrackedCentre& survivor : survivors) EXPECT_FALSE(survivor.kept.has_value());
  config.refresh = Refresh::keep;
  find_survivors(patches, outcomes, config, survivors);
  ASSERT_EQ(survivors.size(), 3U);
  EXPECT_FALSE(survivors[0].kept.has_value());
  EXPECT_FALSE(survivors[1].kept.has_value());
  EXPECT_EQ(survivors[2].kept, 2U);
}

TEST(UpdateAcceptance, WhatStaysBeforeTheSceneForASecondIsFused) {
  const HealthConfig config;
  OcclusionGate gate;
  FrameReport report;
  report.status = FrameStatus::tracked;
  EXPECT_TRUE(gate.admits(report, config));
  report.health = FrameHealth::occluded;
  for (int frame = 1; frame <= 30; ++frame) EXPECT_FALSE(gate.admits(report, config)) << frame;
  EXPECT_TRUE(gate.admits(report, config));
  report.health = FrameHealth::good;
  EXPECT_TRUE(gate.admits(report, config));
  report.health = FrameHealth::occluded;
  EXPECT_FALSE(gate.admits(report, config)) << "counted from the beginning again";
  report.health = FrameHealth::good;
  report.status = FrameStatus::lost;
  EXPECT_FALSE(gate.admits(report, config));
}

}  // namespace
}  // namespace fusebench
