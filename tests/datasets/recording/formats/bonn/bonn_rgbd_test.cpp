#include "datasets/recording/formats/bonn/bonn_rgbd.hpp"

#include <gtest/gtest.h>

#include "datasets/images/image_files.hpp"
#include "datasets/open_recording.hpp"
#include "tests/support/expect_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace images;
using namespace recording;
using namespace formats::bonn;
using namespace datasets;

namespace {

class Bonn : public testing::InTemporaryFolder {
 protected:
  Bonn() {
    write("rgbd_bonn_tiny/rgb/1.png", "");
    write("rgbd_bonn_tiny/depth/1.png", "");
    EXPECT_TRUE(write_png(place_ / "rgb" / "1.png", ColorImage(640, 480, Rgb{9, 8, 7})));
    EXPECT_TRUE(write_png(place_ / "depth" / "1.png", Image<std::uint16_t>(640, 480, 10000)));
    write("rgbd_bonn_tiny/rgb.txt", "# color\n10.0 rgb/1.png\n");
    write("rgbd_bonn_tiny/depth.txt", "10.01 depth/1.png\n");
    write("rgbd_bonn_tiny/groundtruth.txt", "9.9 0 0 0 0 0 0 1\n10.1 1 2 3 0 0 0.70710678 0.70710678\n");
  }
  const std::filesystem::path place_ = folder_ / "rgbd_bonn_tiny";
};

TEST_F(Bonn, CameraAndScaleAreThePages) {
  EXPECT_EQ(recognise_format(place_), "bonn");
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->rig.camera.fx_px, 542.822841);
  EXPECT_EQ(recording->calibration->color.distortion.k2, -0.099343);
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->depth_m(320, 240), 2);
  EXPECT_TRUE(recording->truth_label.empty()) << "motion capture";
}

/// The page's own formula on a point, T_ros^-1 T_g T_ros T_m p, up to the scale that T_m has.
TEST_F(Bonn, PosesAreTakenFromTheMarkersToTheCamera) {
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  Matrix3d ros;
  ros << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  Matrix3d m;
  m << 1.0157, 0.1828, -0.2389, 0.0009, -0.8431, -0.6413, -0.3009, 0.6147, -0.8085;
  const Vector3d t_m(0.0113, -0.0098, 0.0111);
  Matrix3d g;
  g << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Vector3d point_camera(0.3, -0.2, 1.5);
  const Vector3d in_markers = m * point_camera / 1.0593 + t_m;
  const Vector3d expected = ros.transpose() * (g * (ros * in_markers) + Vector3d(1, 2, 3));
  const Vector3d mapped = recording->ground_truth[1].T_world_camera * point_camera;
  EXPECT_LT((mapped - expected).norm(), 1e-3);
}

TEST_F(Bonn, AConvertedRecordingOfThatNameIsOneOfTum) {
  write("rgbd_bonn_tiny/calibration.toml", "[color]\nfx_px = 500\nfy_px = 500\ncx_px = 320\ncy_px = 240\n");
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "tum");
  EXPECT_EQ(recording->ground_truth[1].T_world_camera.translation, Vector3d(1, 2, 3));
}

TEST_F(Bonn, PosesFromTheImagesStayAsTheyAre) {
  write("rgbd_bonn_tiny/groundtruth.txt",
        "# pseudo ground truth: somebody's estimate\n9.9 0 0 0 0 0 0 1\n10.1 1 2 3 0 0 0 1\n");
  const auto recording = open_recording(place_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->truth_label, "pseudo ground truth: somebody's estimate");
  EXPECT_EQ(recording->ground_truth[1].T_world_camera.translation, Vector3d(1, 2, 3));
}

TEST_F(Bonn, ListsAreCheckedAsTums) {
  write("rgbd_bonn_tiny/depth.txt", "10.01 depth/2.png\n");
  const auto refused = open_recording(place_);
  ASSERT_FALSE(refused);
  testing::expect_contains(refused.error().message, "depth.txt:1: image depth/2.png does not exist");
}

}  // namespace
}  // namespace fusebench
