#include "core/acceptance/surviving_patches.hpp"

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

TEST(SurvivingPatches, OnlyPatchesThatKeepTheirShapeAreKept) {
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

}  // namespace
}  // namespace fusebench
