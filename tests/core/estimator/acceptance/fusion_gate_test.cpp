#include "core/estimator/acceptance/fusion_gate.hpp"

#include <gtest/gtest.h>

#include "core/config/groups/health_config.hpp"
#include "core/config/groups/relocalisation_config.hpp"
#include "core/config/groups/terms_config.hpp"

namespace fusebench {

using namespace config;
using namespace health;
using namespace acceptance;

namespace {

TEST(FusionGate, HowLongAnOcclusionIsKeptOutIsAnOption) {
  FrameReport report;
  report.status = FrameStatus::tracked;
  report.health = FrameHealth::occluded;
  for (const int frames : {0, 3}) {
    const HealthConfig config{.max_occluded_frames = frames};
    FusionGate gate;
    for (int frame = 1; frame <= frames; ++frame) EXPECT_FALSE(gate.admits(report, true, config)) << frame;
    EXPECT_TRUE(gate.admits(report, true, config)) << frames;
  }
}

TEST(FusionGate, WhatStaysBeforeTheSceneForASecondIsFused) {
  const HealthConfig config;
  FusionGate gate;
  FrameReport report;
  report.status = FrameStatus::tracked;
  EXPECT_TRUE(gate.admits(report, true, config));
  report.health = FrameHealth::occluded;
  for (int frame = 1; frame <= 30; ++frame) EXPECT_FALSE(gate.admits(report, true, config)) << frame;
  EXPECT_TRUE(gate.admits(report, true, config));
  report.health = FrameHealth::good;
  EXPECT_TRUE(gate.admits(report, true, config));
  report.health = FrameHealth::occluded;
  EXPECT_FALSE(gate.admits(report, true, config)) << "counted from the beginning again";
  report.health = FrameHealth::good;
  report.status = FrameStatus::lost;
  EXPECT_FALSE(gate.admits(report, true, config));
}

TEST(FusionGate, AFrameWhoseColourIsRepeatedIsNotFused) {
  FusionGate gate;
  FrameReport report;
  report.status = FrameStatus::tracked;
  EXPECT_FALSE(gate.admits(report, false, {}));
  EXPECT_TRUE(gate.admits(report, true, {}));
}

TEST(MayBeginSegment, OnlyALostFrameWithSoundImagesAfterTheTime) {
  FrameReport report;
  report.status = FrameStatus::lost;
  const SegmentsConfig config;
  EXPECT_TRUE(may_begin_segment(report, config.begin_after_s, true, {}, config));
  EXPECT_FALSE(may_begin_segment(report, 0.9 * config.begin_after_s, true, {}, config));
  EXPECT_FALSE(may_begin_segment(report, 1, false, {}, config));
  EXPECT_FALSE(may_begin_segment(report, 1, true, {.relocalisation = false}, config));
  EXPECT_FALSE(may_begin_segment(report, 1, true, {}, {.begin_after_s = 0}));
  report.health = FrameHealth::dark;
  EXPECT_FALSE(may_begin_segment(report, 1, true, {}, config));
  report.health = FrameHealth::good;
  report.status = FrameStatus::tracked;
  EXPECT_FALSE(may_begin_segment(report, 1, true, {}, config));
}

}  // namespace
}  // namespace fusebench
