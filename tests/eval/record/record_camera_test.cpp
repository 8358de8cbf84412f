#include "eval/record/record_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/calibration/rig_calibration.hpp"
#include "datasets/recording/recording.hpp"
#include "eval/record/record_origin.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace record;

namespace {

/// A camera in which every number is different.
RecordedCamera awkward_camera() {
  RecordedCamera camera;
  camera.color.pinhole = {640, 480, 525.1, 1000.0 / 3, 319.5, -2.25};
  camera.color.distortion = {0.1, -0.2, 1e-3, -2e-3, 0.3};
  camera.color.timing = {0.015, 0.016, -0.002, 0.01, 0.011, 0.012};
  camera.color.ground_truth_offset_m = {0.1, -0.2, 1.0 / 7};
  camera.depth_units_per_metre = 5000;
  return camera;
}

TEST(RecordCamera, ComesBackToTheBit) {
  RunRecord record;
  record.recording.camera = awkward_camera();
  const std::string text = to_json(record);
  const auto back = parse_record(text, "record.json");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(to_json(*back), text);
  const auto& camera = back->recording.camera;
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->color.pinhole.fy_px, 1000.0 / 3);
  EXPECT_EQ(camera->color.distortion.k3, 0.3);
  EXPECT_EQ(camera->color.timing.depth_delay_sigma_s, 0.012);
  EXPECT_EQ(camera->color.timing.depth_readout_s, 0.016);
  EXPECT_EQ(camera->color.ground_truth_offset_m.z(), 1.0 / 7);
  EXPECT_EQ(camera->depth_units_per_metre, 5000);
  record.recording.camera->depth_units_per_metre.reset();
  EXPECT_FALSE(parse_record(to_json(record), "record.json")->recording.camera->depth_units_per_metre);
}

TEST(RecordCamera, AnOlderRecordHasNone) {
  EXPECT_EQ(to_json(RunRecord{}).find("\"camera\""), std::string::npos);
  EXPECT_FALSE(parse_record(to_json(RunRecord{}), "record.json")->recording.camera);
}

TEST(RecordCamera, IsThatOfTheRecordingAsItWasRead) {
  recording::Recording recording;
  recording.frames.resize(2);
  EXPECT_FALSE(recorded_recording(recording, "walk", 0).camera) << "nobody read images";
  recording.calibration.emplace();
  recording.calibration->color = awkward_camera().color;
  recording.calibration->depth_units_per_metre = 1000;
  const auto recorded = recorded_recording(recording, "walk", 0);
  ASSERT_TRUE(recorded.camera);
  EXPECT_EQ(recorded.camera->color.pinhole.fx_px, 525.1);
  EXPECT_EQ(recorded.camera->depth_units_per_metre, 1000);
}

TEST(RecordCamera, WhatACalibrationMayAtMostSayComesBack) {
  const auto document = config::parse_toml(
      fmt::format("[color]\nwidth_px = {0}\nheight_px = {0}\nfx_px = 500\nfy_px = 500\ncx_px = 320\n"
                  "cy_px = 240\nreadout_s = {1}\n[depth]\nreadout_s = {1}\ndelay_s = -{2}\n",
                  calibration::kMostSize_px, calibration::kMostReadout_s, calibration::kMostDelay_s),
      "c.toml");
  ASSERT_TRUE(document) << document.error().message;
  const auto widest = calibration::rig_calibration(*document, "c.toml");
  ASSERT_TRUE(widest) << widest.error().message;
  RunRecord record;
  record.recording.camera = RecordedCamera{widest->color, {}};
  const auto back = parse_record(to_json(record), "record.json");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->recording.camera->color.pinhole.width_px, calibration::kMostSize_px);
  EXPECT_EQ(back->recording.camera->color.timing.depth_delay_s, -calibration::kMostDelay_s);
}

TEST(RecordCamera, NumbersThatNoCameraHasAreDamage) {
  RunRecord record;
  record.recording.camera = awkward_camera();
  const auto message_with = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json changed = nlohmann::json::parse(to_json(record));
    changed[nlohmann::json::json_pointer(pointer)] = value;
    const auto result = parse_record(changed.dump(), "record.json");
    EXPECT_FALSE(result.has_value()) << pointer;
    return result ? std::string() : result.error().message;
  };
  EXPECT_EQ(message_with("/recording/camera/color/fx_px", 0),
            "record.json: fx_px of the camera = 0 (allowed: above 0)");
  EXPECT_EQ(message_with("/recording/camera/depth/delay_s", -1e9),
            "record.json: delay_s of the camera = -1000000000 (allowed: -10 to 10)");
  testing::expect_contains(message_with("/recording/camera/color/width_px", calibration::kMostSize_px + 1),
                           "width_px");
  testing::expect_contains(message_with("/recording/camera/color/distortion", nlohmann::json::array({1})),
                           "index");
  testing::expect_contains(message_with("/recording/camera/depth/units_per_metre", -1), "units_per_metre");
  testing::expect_contains(message_with("/recording/camera", nlohmann::json::object()), "color");
}

}  // namespace
}  // namespace fusebench
