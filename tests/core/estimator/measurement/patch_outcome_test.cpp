#include "core/estimator/measurement/patch_outcome.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench {

using namespace measurement;
using config::IekfConfig;

namespace {

PatchOutcome fitting() {
  PatchOutcome outcome;
  outcome.gain = 1.0;
  outcome.photometric_residuals = 100;
  outcome.geometric_residuals = 100;
  return outcome;
}

TEST(PatchOutcome, GainsBetweenAHalfAndTwoFit) {
  PatchOutcome outcome = fitting();
  for (const double gain : {0.51, 1.0, 1.99}) {
    outcome.gain = gain;
    EXPECT_TRUE(fits_color(outcome, IekfConfig{}, {})) << gain;
  }
  for (const double gain : {-1.0, 0.0, 0.1, 0.49, 2.01, 10.0}) {
    outcome.gain = gain;
    EXPECT_FALSE(fits_color(outcome, IekfConfig{}, {})) << gain;
  }
}

TEST(PatchOutcome, Chi2OfEachKindIsLimitedByItsNumberOfResiduals) {
  IekfConfig config;
  config.max_chi2_per_measurement = 3.0;
  PatchOutcome outcome = fitting();
  outcome.chi2_photometric = 299;
  outcome.chi2_geometric = 299;
  EXPECT_TRUE(is_consistent(outcome, config, {}));
  outcome.chi2_photometric = 301;
  EXPECT_FALSE(fits_color(outcome, config, {}));
  EXPECT_FALSE(is_consistent(outcome, config, {}));
  EXPECT_TRUE(fits_color(outcome, config, {.photometric = 0, .geometric = 1})) << "colour is not used";
  outcome.chi2_photometric = 299;
  outcome.chi2_geometric = 301;
  EXPECT_TRUE(fits_color(outcome, config, {}));
  EXPECT_FALSE(is_consistent(outcome, config, {}));
}

}  // namespace
}  // namespace fusebench
