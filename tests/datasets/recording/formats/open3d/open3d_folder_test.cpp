#include "datasets/recording/formats/open3d/open3d_folder.hpp"

#include <gtest/gtest.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording/exports/export_recording.hpp"
#include "tests/datasets/recording/exports/made_recording.hpp"
#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace recording;
using namespace exports;
using namespace datasets;

namespace {

using testing::expect_contains;

class Open3dFolder : public testing::InTemporaryFolder {
 protected:
  const std::filesystem::path place_ = folder_ / "room";
  void export_made() const {
    const auto done = export_recording(testing::made_recording(16, 12, 3), ExportFormat::open3d, place_);
    ASSERT_TRUE(done) << done.error().message;
  }
  [[nodiscard]] std::string refusal() const {
    const auto opened = open_recording(place_);
    EXPECT_FALSE(opened);
    return opened ? std::string() : opened.error().message;
  }
};

TEST_F(Open3dFolder, WhatIsExportedIsReadBack) {
  export_made();
  EXPECT_EQ(recognise_format(place_), "open3d");
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rig.camera.fy_px, 524.5);
  EXPECT_EQ(read->rig.camera.cx_px, 3.5) << "the matrix goes column by column";
  ASSERT_EQ(read->frames.size(), 3);
  const Recording made = testing::made_recording(16, 12, 3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read->frames[k].timestamp_ns, made.frames[k].timestamp_ns) << "of frame_times.txt";
    const auto frame = read->load_frame(k);
    ASSERT_TRUE(frame) << frame.error().message;
    EXPECT_EQ(frame->color.data, testing::made_frame(16, 12, static_cast<int>(k)).color.data);
    EXPECT_EQ(frame->depth_m(5, 5), testing::made_frame(16, 12, static_cast<int>(k)).depth_m(5, 5));
  }
}

/// As Open3D's recorders for Azure Kinect write it: JPEG, five digits, no stamps, no configuration.
TEST_F(Open3dFolder, AnAzureKinectsFolderCounts) {
  write(
      "room/intrinsic.json",
      R"({"color_mode": "MJPG_720P", "width": 16, "height": 12, "intrinsic_matrix": [20, 0, 0, 0, 21, 0, 7.5, 5.5, 1]})");
  for (const char* name : {"00000", "00001"}) {
    const auto jpeg = images::encode_jpeg(ColorImage(16, 12, Rgb{200, 100, 50}), 95);
    ASSERT_TRUE(jpeg);
    write(std::string("room/color/") + name + ".jpg",
          {reinterpret_cast<const char*>(jpeg->data()), jpeg->size()});
    write(std::string("room/depth/") + name + ".png", "");
    ASSERT_TRUE(images::write_png(place_ / "depth" / (std::string(name) + ".png"),
                                  Image<std::uint16_t>(16, 12, 750)));
  }
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames[1].timestamp_ns, 33'333'333);
  EXPECT_EQ(read->load_frame(1)->depth_m(2, 2), 0.75F);
}

/// As RSBagReader writes it: an L515 has a depth unit of 0.25 mm.
TEST_F(Open3dFolder, DepthScaleAndRateOfTheRecorderAreUsed) {
  export_made();
  std::filesystem::remove(place_ / "config.json");
  std::filesystem::remove(place_ / "frame_times.txt");
  const auto write_recorder = [&](std::string_view more) {
    write("room/intrinsic.json",
          R"({"width": 16, "height": 12, "intrinsic_matrix": [20, 0, 0, 0, 21, 0, 7.5, )"
          R"(5.5, 1], "device_name": "L515", "stream_length_usec": 400000)" +
              std::string(more) + "}");
  };
  write_recorder(R"(, "depth_scale": 3999.999755859375, "fps": 15.0, "exposure": 3)");
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->frames[1].timestamp_ns, 66'666'667);
  EXPECT_NEAR(read->load_frame(1)->depth_m(5, 5), testing::made_frame(16, 12, 1).depth_m(5, 5) / 4, 1e-3);
  EXPECT_TRUE(testing::any_contains(read->warnings, "intrinsic.json: not used: exposure"));
  ReadOptions options;
  options.frame_rate_hz = 25;
  options.depth_units_per_metre = 1000;
  const auto given = open_recording(place_, {"", options});
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->frames[1].timestamp_ns, 40'000'000);
  EXPECT_EQ(given->load_frame(1)->depth_m(5, 5), testing::made_frame(16, 12, 1).depth_m(5, 5));
  write_recorder(R"(, "fps": 0)");
  const auto unknown = open_recording(place_);
  ASSERT_TRUE(unknown) << unknown.error().message;
  EXPECT_EQ(unknown->frames[1].timestamp_ns, 33'333'333) << "as without fps";
  EXPECT_TRUE(testing::any_contains(unknown->warnings, "intrinsic.json: fps = 0 is not used"));
  write_recorder(R"(, "depth_scale": 0.00025)");
  expect_contains(refusal(),
                  "intrinsic.json: depth_scale = 0.00025 (allowed: 0.1 to 1000000 units per metre)");
  EXPECT_EQ(open_recording(place_).error().hint, "0.00025 metres per unit are 4000 units per metre");
}

TEST_F(Open3dFolder, DepthScaleOfTheRecorderIsPreferredToThatOfTheReconstruction) {
  export_made();
  write(
      "room/intrinsic.json",
      R"({"width": 16, "height": 12, "intrinsic_matrix": [20, 0, 0, 0, 21, 0, 7.5, 5.5, 1], "depth_scale": 4000})");
  write("room/config.json", R"({"depth_scale": 1000})");
  const auto read = open_recording(place_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->calibration->depth_units_per_metre, 4000);
  EXPECT_TRUE(
      testing::any_contains(read->warnings, "depth_scale is 4000 in intrinsic.json and 1000 in config.json"));
  write("room/config.json", R"({"depth_scale": 4000})");
  EXPECT_TRUE(open_recording(place_)->warnings.empty());
}

TEST_F(Open3dFolder, WhatIsWrongIsNamed) {
  export_made();
  write("room/frame_times.txt", "0 1000.0\n1 999.0\n");
  expect_contains(refusal(), "frame_times.txt:2: numbers and times must both rise");
  write("room/frame_times.txt", "0 1000.0\n1 1001.0\n");
  expect_contains(refusal(), "frame_times.txt: has no time of frame 2");
  std::filesystem::remove(place_ / "frame_times.txt");
  write("room/config.json", "{\"depth_scale\": 0}");
  expect_contains(refusal(), "config.json: depth_scale = 0 (allowed: 0.1 to 1000000 units per metre)");
  write("room/config.json", "{}");
  write("room/intrinsic.json", "{\"width\": 16, \"height\": 12");
  expect_contains(refusal(), "intrinsic.json: is not JSON, or not all of it is there");
  write("room/intrinsic.json", "{\"width\": 16.5, \"height\": 12, \"intrinsic_matrix\": []}");
  expect_contains(refusal(), "intrinsic.json: width = 16.5 (allowed: whole numbers");
  write("room/intrinsic.json", "{\"width\": 16, \"height\": 12, \"intrinsic_matrix\": [1, 2]}");
  expect_contains(refusal(), "intrinsic.json: needs the key intrinsic_matrix, a list of 9 finite numbers");
  write("room/intrinsic.json",
        "{\"width\": 16, \"height\": 12, \"intrinsic_matrix\": [1, 0, 5, 0, 1, 5, 0, 0, 1]}");
  expect_contains(refusal(), "intrinsic.json: intrinsic_matrix: the camera's matrix is not");
}

}  // namespace
}  // namespace fusebench
