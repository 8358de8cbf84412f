#include "core/estimator/health/frame_diagnosis.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/config/groups/filter_config.hpp"
#include "core/config/groups/health_config.hpp"

namespace fusebench {

using namespace config;
using namespace health;
using namespace measurement;

namespace {

constexpr int kPatchSize_px = 10;

/// An image of stripes of two grey levels, with depth in its upper part.
struct Scene {
  int grey = 100;
  int contrast_grey = 20;
  int rows_with_depth = 48;

  [[nodiscard]] FrameHealth judged(const HealthConfig& health,
                                   const std::vector<PatchOutcome>& outcomes = {}) const {
    GreyImage image(64, 48);
    DepthImage depth_m(64, 48);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        image(x, y) = static_cast<std::uint8_t>(grey + (x % 2 == 0 ? contrast_grey : 0));
        depth_m(x, y) = y < rows_with_depth ? 2.0F : 0.0F;
      }
    }
    const std::vector<GreyImage> pyramid{image};
    return judge_health({pyramid, depth_m}, outcomes, 0.0, health, IekfConfig{}, kPatchSize_px);
  }
};

TEST(FrameHealth, AFrameIsDarkBelowItsGreyLevel) {
  HealthConfig health;
  const Scene dim{.grey = 8, .contrast_grey = 6};  // 11 in the mean
  EXPECT_EQ(dim.judged(health), FrameHealth::good);
  health.dark_grey = 12;
  EXPECT_EQ(dim.judged(health), FrameHealth::dark);
}

TEST(FrameHealth, HowMuchDepthIsEnough) {
  HealthConfig health;
  EXPECT_EQ((Scene{.rows_with_depth = 12}).judged(health), FrameHealth::good);
  EXPECT_EQ((Scene{.rows_with_depth = 4}).judged(health), FrameHealth::short_of_depth);
  health.min_depth_share = 0.5;
  EXPECT_EQ((Scene{.rows_with_depth = 12}).judged(health), FrameHealth::short_of_depth);
}

TEST(FrameHealth, WhatCountsAsTexture) {
  const HealthConfig health;
  EXPECT_EQ((Scene{.contrast_grey = 5}).judged(health), FrameHealth::good);
  EXPECT_EQ((Scene{.contrast_grey = 4}).judged(health), FrameHealth::short_of_texture)
      << "a gradient has to exceed 4 grey levels";
}

TEST(FrameHealth, HowManyCoveredPatchesAreAnOcclusion) {
  HealthConfig health;
  std::vector<PatchOutcome> outcomes(10);
  for (std::size_t p = 0; p < outcomes.size(); ++p) {
    outcomes[p].in_view = outcomes[p].tracked = outcomes[p].accepted = true;
    outcomes[p].usable_pixels = 100;
    if (p < 2) outcomes[p].covered_pixels = 200;
  }
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::good);
  health.covered_share = 0.19;
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::occluded);
}

TEST(FrameHealth, APatchIsCoveredIfMoreThanHalfOfItsPixelsAre) {
  const HealthConfig health;
  std::vector<PatchOutcome> outcomes(10);
  for (PatchOutcome& outcome : outcomes) {
    outcome.in_view = outcome.tracked = outcome.accepted = true;
    outcome.usable_pixels = 50;
    outcome.covered_pixels = 50;
  }
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::good);
  for (PatchOutcome& outcome : outcomes) ++outcome.covered_pixels;
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::occluded);
}

TEST(FrameHealth, AFrameIsInconsistentIfLessThanHalfOfTheTrackedPatchesAreAccepted) {
  const HealthConfig health;
  std::vector<PatchOutcome> outcomes(20);
  for (std::size_t p = 0; p < outcomes.size(); ++p) {
    outcomes[p].in_view = outcomes[p].tracked = true;
    outcomes[p].usable_pixels = 100;
    outcomes[p].accepted = p < 10;
  }
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::good);
  outcomes[0].accepted = false;
  EXPECT_EQ(Scene{}.judged(health, outcomes), FrameHealth::inconsistent);
}

}  // namespace
}  // namespace fusebench
