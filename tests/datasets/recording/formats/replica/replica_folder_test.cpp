#include "datasets/recording/formats/replica/replica_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace datasets;

namespace {

using testing::any_contains;
using testing::expect_contains;

constexpr std::string_view kCamera =
    R"({"camera": {"w": 8, "h": 6, "fx": 4.0, "fy": 4.5, "cx": 3.5, "cy": 2.5, "scale": 6553.5}})";

/// Three frames of 8x6 pixels at 2 m.
class ReplicaFolder : public testing::InTemporaryFolder {
 protected:
  ReplicaFolder() {
    std::string poses;
    for (int k = 0; k < 3; ++k) {
      const auto jpeg = encode_jpeg(ColorImage(8, 6, Rgb{200, 100, 50}), 95);
      EXPECT_TRUE(jpeg);
      write(fmt::format("room0/results/frame{:06}.jpg", k),
            {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
      write(fmt::format("room0/results/depth{:06}.png", k), "");
      EXPECT_TRUE(write_png(place_ / "results" / fmt::format("depth{:06}.png", k),
                            Image<std::uint16_t>(8, 6, 13107)));
      poses += fmt::format("1 0 0 {} 0 0 -1 0.5 0 1 0 -2 0 0 0 1\n", k);
    }
    write("room0/traj.txt", poses);
    write("cam_params.json", kCamera);
  }
  const std::filesystem::path place_ = folder_ / "room0";
  [[nodiscard]] std::string refusal() const {
    const auto opened = open_recording(place_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  }
};

TEST_F(ReplicaFolder, FramesCameraOfTheFolderAboveAndPoses) {
  EXPECT_EQ(recognise_format(place_), "replica");
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 3);
  EXPECT_EQ(recording->rig.camera.fy_px, 4.5);
  EXPECT_EQ(recording->rig.timing.color_readout_s, 0) << "rendered";
  EXPECT_EQ(recording->load_frame(1)->depth_m(3, 3), 2);
  ASSERT_EQ(recording->ground_truth.size(), 3);
  EXPECT_EQ(recording->ground_truth[2].timestamp_ns, recording->frames[2].timestamp_ns);
  EXPECT_EQ(recording->ground_truth[2].T_world_camera.translation, Vector3d(2, 0.5, -2));
  EXPECT_LT(
      (recording->ground_truth[2].T_world_camera.rotation * Vector3d(0, 0, 1) - Vector3d(0, -1, 0)).norm(),
      1e-9);
  EXPECT_TRUE(recording->truth_label.empty());
}

TEST_F(ReplicaFolder, CameraInTheFolderItselfComesFirst) {
  write("room0/cam_params.json",
        R"({"camera": {"w": 8, "h": 6, "fx": 5, "fy": 5, "cx": 3, "cy": 2, "scale": 1000, )"
        R"("near": 0.1}})");
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rig.camera.fx_px, 5);
  EXPECT_EQ(recording->calibration->depth_units_per_metre, 1000);
  EXPECT_TRUE(any_contains(recording->warnings, "cam_params.json: not used: near"));
}

TEST_F(ReplicaFolder, WhatIsWrongIsNamed) {
  write("room0/traj.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  expect_contains(refusal(), "traj.txt:1: expected 16 columns");
  write("room0/traj.txt", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1\n");
  expect_contains(refusal(), "traj.txt:1: the pose is no rigid transform");
  write("room0/traj.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0.5 0 2 1\n");
  expect_contains(refusal(), "so transpose a matrix with its translation there");
  write("cam_params.json", R"({"camera": {"w": 8, "h": 6}})");
  expect_contains(refusal(), "cam_params.json: needs the key fx, a finite number");
  write("cam_params.json",
        R"({"camera": {"w": 8.5, "h": 6, "fx": 4, "fy": 4, "cx": 3, "cy": 2, "scale": 1}})");
  expect_contains(refusal(), "w = 8.5, h = 6 (allowed: whole numbers from 1 to 16384)");
}

}  // namespace
}  // namespace fusebench
