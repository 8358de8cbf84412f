#include "eval/run/preparation/preparation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "datasets/calibration/camera_model.hpp"
#include "eval/run/preparation/preparation_report.hpp"
#include "eval/run/preparation/prepared_recording.hpp"
#include "tests/support/simulated_frames.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace preparation;

namespace {

constexpr SensorTiming kSensors{0.026, 0.02, 0.01};

/// A short recording of these sensors, with a calibration that says this of them.
recording::Recording recording_with(const SensorTiming& told, int frames) {
  const testing::SimulatedRun run = testing::simulate(frames, kSensors);
  recording::Recording recording;
  recording.name = "short";
  recording.fingerprint = "content";
  recording.rig = run.rig;
  recording.rig.timing = told;
  recording.calibration = calibration::RigCalibration{};
  recording.calibration->color.pinhole = run.rig.camera;
  recording.calibration->color.timing = told;
  for (const RgbdFrame& frame : run.frames)
    recording.frames.push_back(
        {frame.timestamp_ns, frame.timestamp_ns, frame.timestamp_ns, frame.timestamp_ns, {}, {}});
  recording.load_frame = [images = run.frames](std::size_t k) -> Result<RgbdFrame> {
    RgbdFrame frame = images[k];
    frame.depth_offset_ns = 0;
    return frame;
  };
  return recording;
}

TEST(Preparation, ACalibrationWithoutUncertaintyIsHeld) {
  const recording::Recording recording = recording_with({0.01, 0.01, 0}, 3);
  EXPECT_FALSE(can_be_prepared(recording));
  const Workers workers(1);
  const auto prepared = prepare(recording, workers, nullptr);
  ASSERT_TRUE(prepared.has_value());
  EXPECT_EQ(prepared->frames, 0U);
  for (const PreparedConstant& constant : prepared->constants) EXPECT_EQ(constant.verdict, Verdict::held);
}

TEST(Preparation, ARecordingThatIsTooShortKeepsItsCalibration) {
  const recording::Recording recording = recording_with(calibration::kUnknownTiming, 6);
  const Workers workers(2);
  const auto prepared = prepare(recording, workers, nullptr);
  ASSERT_TRUE(prepared.has_value());
  for (const PreparedConstant& constant : prepared->constants) EXPECT_EQ(constant.after_s, constant.before_s);
  EXPECT_EQ(timing_after(*prepared).color_readout_s, calibration::kUnknownReadout_s);
  EXPECT_NE(to_text(*prepared, {}, recording).find("calibration"), std::string::npos);
}

TEST(Preparation, WhatIsPublishedIsKeptUnlessTheImagesContradictIt) {
  const SensorTiming told{0, 0.022, 0.008, 0.002, 0.002, 0.002};
  const Workers workers(2);
  const auto prepared = prepare(recording_with(told, 40), workers, nullptr);
  ASSERT_TRUE(prepared.has_value());
  const auto& [color, depth, delay] = prepared->constants;
  EXPECT_EQ(color.verdict, Verdict::measured) << "26 ms are no global shutter";
  EXPECT_NEAR(color.after_s, kSensors.color_readout_s, 3e-3);
  EXPECT_EQ(depth.verdict, Verdict::agrees);
  EXPECT_EQ(depth.after_s, told.depth_readout_s);
  EXPECT_EQ(delay.after_sigma_s, told.depth_delay_sigma_s);
}

TEST(Preparation, AFrameThatCannotBeReadIsNamed) {
  recording::Recording recording = recording_with(calibration::kUnknownTiming, 30);
  recording.load_frame = [load = recording.load_frame](std::size_t k) -> Result<RgbdFrame> {
    if (k == 4) return fail(ErrorCode::data_corrupt, "damaged");
    return load(k);
  };
  const Workers workers(2);
  const auto prepared = prepare(recording, workers, nullptr);
  ASSERT_FALSE(prepared.has_value());
  EXPECT_EQ(prepared.error().message, "frame 4: damaged");
}

TEST(Preparation, AnotherDelayMovesTheDepthImages) {
  recording::Recording recording = recording_with(calibration::kUnknownTiming, 3);
  SensorTiming timing = recording.rig.timing;
  timing.depth_delay_s = 0.01;
  const recording::Recording moved = with_timing(recording, timing);
  EXPECT_EQ(moved.load_frame(1)->depth_offset_ns, 10'000'000);
  EXPECT_EQ(moved.frames[1].depth_capture_ns - moved.frames[1].capture_ns, 10'000'000);
  ASSERT_EQ(moved.notes.size(), 1U);
  EXPECT_EQ(moved.notes[0],
            "prepared: delay of depth 10.0 +- 10.0 ms, measured in the recording (before: 0.0 +- 10.0 ms)");
}

TEST(PreparedRecording, IsMeasuredOnceAndThenReadBack) {
  const testing::TemporaryFolder folder;
  const recording::Recording recording = recording_with(calibration::kUnknownTiming, 40);
  const Workers workers(2);
  EXPECT_FALSE(is_kept(folder.path(), recording));
  const auto first = prepared_recording(recording, folder.path(), workers, nullptr);
  ASSERT_TRUE(first.has_value());
  ASSERT_TRUE(is_kept(folder.path(), recording));
  EXPECT_NEAR(first->rig.timing.color_readout_s, kSensors.color_readout_s, 3e-3);
  EXPECT_FALSE(first->notes.empty());
  recording::Recording unreadable = recording;
  unreadable.load_frame = [](std::size_t) -> Result<RgbdFrame> {
    return fail(ErrorCode::data_missing, "gone");
  };
  const auto second = prepared_recording(unreadable, folder.path(), workers, nullptr);
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->rig.timing.color_readout_s, first->rig.timing.color_readout_s);
  EXPECT_EQ(second->rig.timing.depth_delay_sigma_s, first->rig.timing.depth_delay_sigma_s);
  EXPECT_EQ(second->notes, first->notes);
}

}  // namespace
}  // namespace fusebench
