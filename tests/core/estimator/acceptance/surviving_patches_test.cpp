#include "core/estimator/acceptance/surviving_patches.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/patches_config.hpp"

namespace fusebench {

using namespace config;
using namespace patches;
using namespace measurement;
using namespace acceptance;

namespace {

TEST(SurvivingPatches, OnlyAcceptedPatchesOfSmallErrorSurvive) {
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

std::vector<PatchOutcome> outcomes_of(int count, double correlation) {
  PatchOutcome outcome;
  outcome.accepted = true;
  outcome.correlation = correlation;
  return std::vector<PatchOutcome>(static_cast<std::size_t>(count), outcome);
}

TEST(SurvivingPatches, PatchesAreCutAnewWhenTheImageNoLongerAgreesWithThem) {
  PatchConfig config;
  config.anchor_share = 0.75;
  EXPECT_FALSE(needs_new_anchor(outcomes_of(20, 0.8), config));
  EXPECT_TRUE(needs_new_anchor(outcomes_of(20, 0.7), config));  // a blurred image
  std::vector<PatchOutcome> leaving = outcomes_of(20, 1.0);
  for (std::size_t i = 0; i < 4; ++i) leaving[i].accepted = false;
  EXPECT_FALSE(needs_new_anchor(leaving, config));
  leaving[4].mean_error_grey = config.max_mean_error + 1;
  EXPECT_TRUE(needs_new_anchor(leaving, config));
  EXPECT_TRUE(needs_new_anchor({}, config));
}

TEST(SurvivingPatches, AShareOfOneCutsThemFromEachFrame) {
  PatchConfig config;
  config.anchor_share = 1;
  EXPECT_TRUE(needs_new_anchor(outcomes_of(20, 1.0), config));
}

}  // namespace
}  // namespace fusebench
