#include "datasets/calibration/frame_cameras.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/expect_text.hpp"

namespace fusebench {

using namespace calibration;

namespace {

TEST(FrameCameras, MedianIsTakenAndAChangeIsNamed) {
  const std::vector<FrameCamera> frames = {{4, {640, 480, 500, 510, 320, 240}},
                                           {5, {640, 480, 520, 530, 321, 241}},
                                           {7, {640, 480, 550, 560, 322, 242}}};
  const CommonCamera common = common_camera(frames);
  EXPECT_EQ(common.camera.fx_px, 520);
  EXPECT_EQ(common.camera.fy_px, 530);
  EXPECT_EQ(common.camera.cx_px, 321);
  EXPECT_EQ(common.camera.cy_px, 241);
  EXPECT_EQ(common.camera.width_px, 640);
  testing::expect_contains(common.change,
                           "focal length changes by 9.6 % (from 500.0 px in frame 4 to 550.0 px in frame 7)");
}

TEST(FrameCameras, FocalLengthsThatAgreeAreNoChange) {
  const std::vector<FrameCamera> frames = {{0, {640, 480, 500, 510, 320, 240}},
                                           {1, {640, 480, 501, 511, 320, 240}}};
  EXPECT_EQ(common_camera(frames).change, "");
  EXPECT_EQ(common_camera({frames.data(), 1}).camera.fx_px, 500);
}

}  // namespace
}  // namespace fusebench
