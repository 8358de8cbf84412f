#include "core/estimator/acceptance/update_tests.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench {

using namespace config;
using namespace health;
using namespace acceptance;

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

TEST(UpdateTests, TooFewPatchesAreNeverAccepted) {
  const AcceptanceOptions config;
  const std::string reason =
      rejection_reason(report_with(config.iekf.min_patches - 1, 1), config.terms, config.iekf, config.health);
  EXPECT_NE(reason.find("good: usable patches: 4, allowed at least 5 (iekf.min_patches)"), std::string::npos)
      << reason;
  EXPECT_EQ(
      rejection_reason(report_with(config.iekf.min_patches, 1), config.terms, config.iekf, config.health),
      "");
}

TEST(UpdateTests, PatchesThatAreNotRecognisedAreNotAccepted) {
  AcceptanceOptions config;
  FrameReport report = report_with(30, 1);
  report.correlation = 0.29;
  EXPECT_NE(rejection_reason(report, config.terms, config.iekf, config.health)
                .find("tracked patches: 0.29, allowed at least 0.3"),
            std::string::npos);
  report.correlation = 0.31;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
  config.health.min_correlation = 0.4;
  EXPECT_NE(rejection_reason(report, config.terms, config.iekf, config.health), "");
  config.terms.photometric_weight = 0;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
}

TEST(UpdateTests, APoseThatMostIntensitiesContradictIsNotAccepted) {
  const AcceptanceOptions config;
  FrameReport report = report_with(30, 1);
  report.patches_tracked = 36;
  report.patches_contradicting = 18;
  EXPECT_EQ(rejection_reason(report, config.terms, config.iekf, config.health), "");
  report.patches_contradicting = 19;
  EXPECT_NE(rejection_reason(report, config.terms, config.iekf, config.health)
                .find("do not fit: 0.528, allowed at most 0.5"),
            std::string::npos);
}

TEST(UpdateTests, DoesNotDependOnRelocalisation) {
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

}  // namespace
}  // namespace fusebench
