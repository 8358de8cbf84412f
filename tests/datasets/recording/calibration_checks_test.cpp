#include "datasets/recording/calibration_checks.hpp"

#include <gtest/gtest.h>

#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace recording;
using namespace calibration;

namespace {

using testing::any_contains;
using testing::expect_contains;

/// Five frames at 25 Hz.
Recording frames_at_25_hz() {
  Recording recording = named_recording("room", "made");
  for (std::int64_t k = 0; k < 5; ++k) {
    const std::int64_t time_ns = 40'000'000 * k;
    recording.frames.push_back({time_ns, time_ns, time_ns, time_ns, {}, {}});
  }
  return recording;
}

RigCalibration sound_calibration() {
  RigCalibration calibration;
  calibration.color.pinhole = {640, 480, 525, 525, 319.5, 239.5};
  calibration.color.timing = {0.03, 0.04, -0.02, 0, 0, 0};
  return calibration;
}

std::string refusal(const RigCalibration& calibration) {
  Recording recording = frames_at_25_hz();
  const auto checked = check_calibration(calibration, recording);
  EXPECT_FALSE(checked);
  if (checked) return {};
  EXPECT_EQ(checked.error().code, ErrorCode::data_corrupt);
  EXPECT_FALSE(checked.error().hint.empty());
  return checked.error().message;
}

std::vector<std::string> warnings(const RigCalibration& calibration) {
  Recording recording = frames_at_25_hz();
  const auto checked = check_calibration(calibration, recording);
  EXPECT_TRUE(checked) << checked.error().message;
  return recording.warnings;
}

TEST(CalibrationChecks, ASoundCalibrationHasNoWarning) { EXPECT_TRUE(warnings(sound_calibration()).empty()); }

TEST(CalibrationChecks, PrincipalPointMustBeInTheImage) {
  RigCalibration c = sound_calibration();
  c.color.pinhole.cx_px = 639.5;
  EXPECT_TRUE(warnings(c).empty()) << "the border of the last pixel";
  c.color.pinhole.cx_px = 640;
  expect_contains(refusal(c), "camera of colour: cx_px = 640 is outside of the image (allowed -0.5 to 639.5");
  c.color.pinhole = {160, 120, 525, 525, 100, 239.5};
  expect_contains(refusal(c), "cy_px = 239.5 is outside of the image");
  c = sound_calibration();
  c.depth = DepthCamera{{320, 240, 300, 300, -1, 100}, {}};
  expect_contains(refusal(c), "camera of depth: cx_px = -1");
}

TEST(CalibrationChecks, FocalLengthOfAnotherSizeIsNamed) {
  RigCalibration c = sound_calibration();
  for (const double fx_px : {100.0, 5000.0}) {
    c.color.pinhole.fx_px = fx_px;
    EXPECT_TRUE(any_contains(warnings(c), "the width of 640 pixels (usual are 0.3 to 5)"));
  }
}

TEST(CalibrationChecks, ReadOutMustNotBeLongerThanTheIntervalOfImages) {
  RigCalibration c = sound_calibration();
  c.color.timing.color_readout_s = 1;
  expect_contains(refusal(c),
                  "readout_s = 1 in [color] is longer than the interval of the images (allowed 0 to 0.04 s)");
  c = sound_calibration();
  c.color.timing.depth_readout_s = 0.05;
  expect_contains(refusal(c), "readout_s = 0.05 in [depth]");
}

TEST(CalibrationChecks, ReadOutThatIsNotGivenIsNotChecked) {
  Recording recording = frames_at_25_hz();
  for (std::size_t k = 0; k < recording.frames.size(); ++k)
    recording.frames[k].timestamp_ns = recording.frames[k].depth_timestamp_ns =
        static_cast<std::int64_t>(k) * 8'000'000;
  RigCalibration c = sound_calibration();
  c.color.timing = kUnknownTiming;
  EXPECT_TRUE(check_calibration(c, recording));
}

TEST(CalibrationChecks, ALongDelayIsNamed) {
  RigCalibration c = sound_calibration();
  c.color.timing.depth_delay_s = 0.5;
  EXPECT_TRUE(any_contains(warnings(c), "delay_s = 0.5 in [depth]: depth is usually taken within 0.1 s"));
}

}  // namespace
}  // namespace fusebench
