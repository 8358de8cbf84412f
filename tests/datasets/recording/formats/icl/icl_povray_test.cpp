#include "datasets/recording/formats/icl/icl_povray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/trajectory/trajectory.hpp"
#include "datasets/recording/formats/icl/icl_conventions.hpp"
#include "datasets/recording/formats/icl/icl_povray_files.hpp"
#include "tests/datasets/recording/formats/icl/icl_folder.hpp"

namespace fusebench {

using namespace trajectory;
using namespace images;
using namespace recording;
using namespace formats::icl;
using namespace datasets;

namespace {

using testing::expect_part;
using testing::icl_small_camera;
using testing::refusal_message;

/// A camera file in the renderer's spelling. axes: right, up, direction (columns) and position.
std::string camera_text(const Matrix3d& axes, const Vector3d& position, double right_length = 640.0 / 481.2) {
  const auto row = [](const char* name, const Vector3d& v) {
    return fmt::format("{:<12} = [{:.17g}, {:.17g}, {:.17g}]';\n", name, v.x(), v.y(), v.z());
  };
  return row("cam_pos", position) + row("cam_dir", axes.col(2)) + row("cam_up", axes.col(1)) +
         "cam_lookat   = [0, 0, 1]';\ncam_sky      = [0, 1, 0]';\n" +
         row("cam_right", right_length * axes.col(0)) + "cam_fpoint   = [0, 0, 10]';\ncam_angle    = 90;\n";
}

std::string ray_lengths(std::size_t count, const std::string& value = "2.5") {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += value + (i % 7 == 6 ? "\n" : " ");
  return text;
}

/// Frames 0 to 2 of 8x6 pixels in the renderer's own packing.
class PovrayFolder {
 public:
  PovrayFolder() {
    for (int k = 0; k < 3; ++k) {
      write(stem(k) + ".png", "");
      EXPECT_TRUE(write_png(path() / (stem(k) + ".png"), ColorImage(8, 6, Rgb{1, 2, 3})));
      write(stem(k) + ".depth", ray_lengths(48));
      write(stem(k) + ".txt", camera_text(Matrix3d::Identity(), {0.1 * k, 1.5, 2}));
    }
  }
  static std::string stem(int k) { return fmt::format("scene_00_{:04}", k); }
  void write(const std::string& name, std::string_view content) const { folder_.write(name, content); }
  void remove(const std::string& name) const { std::filesystem::remove(path() / name); }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
  [[nodiscard]] Result<Recording> open(const ReadOptions& options = icl_small_camera()) const {
    return open_recording(path(), {"", options});
  }
  /// Reads one camera file with this text.
  [[nodiscard]] std::string camera_refusal(std::string_view text) const {
    write("camera.txt", text);
    const auto camera = read_povray_camera(path() / "camera.txt");
    EXPECT_FALSE(camera) << text;
    return camera ? "" : camera.error().message;
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST(IclPovray, Opens) {
  const PovrayFolder folder;
  EXPECT_EQ(recognise_format(folder.path()), "icl");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->format, "icl");
  ASSERT_EQ(recording->frames.size(), 3U);
  EXPECT_EQ(recording->frames[2].timestamp_ns, 66'666'667);
  ASSERT_EQ(recording->ground_truth.size(), 3U);
  EXPECT_EQ(recording->ground_truth[1].T_world_camera.translation, Vector3d(0.1, -1.5, 2));
  EXPECT_TRUE(recording->ground_truth[1].T_world_camera.rotation.isApprox(Quaterniond::Identity(), 1e-15));
  const auto frame = recording->load_frame(0);
  ASSERT_TRUE(frame) << frame.error().message;
  const double x = (7 - 3.5) / 10;
  const double y = (5 - 2.5) / 11;
  EXPECT_FLOAT_EQ(frame->depth_m(7, 5), static_cast<float>(2.5 / std::sqrt(1 + x * x + y * y)));
}

/// A wall: rays to z = 2 are longer towards the corners, their depth is the same everywhere.
TEST(IclPovray, RayLengthsOfAWallBecomeOneDepth) {
  const PovrayFolder folder;
  const PinholeCamera camera{8, 6, 5, 6, 3.5, 2.5};
  std::string text;
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 8; ++u) text += fmt::format("{:.9g} ", camera.back_project(u, v, 2).norm());
  }
  folder.write("wall.depth", text);
  const auto depth = read_povray_depth(folder.path() / "wall.depth", camera, 1);
  ASSERT_TRUE(depth) << depth.error().message;
  for (const float z : depth->data) EXPECT_NEAR(z, 2, 1e-6);
  EXPECT_NEAR(read_povray_depth(folder.path() / "wall.depth", camera, 100).value().data[0], 0.02, 1e-8);
}

TEST(IclPovray, RaysIntoTheOpenAreNoMeasurement) {
  const PovrayFolder folder;
  folder.write("open.depth", "1e+10 " + ray_lengths(47, "0"));
  const auto depth = read_povray_depth(folder.path() / "open.depth", {8, 6, 10, 10, 3.5, 2.5}, 1);
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->data[0], 0);
}

TEST(IclPovray, RefusesDepthThatIsNoTableOfNumbers) {
  const PovrayFolder folder;
  const auto refusal = [&](const std::string& text) {
    folder.write(PovrayFolder::stem(1) + ".depth", text);
    const auto recording = folder.open();
    if (!recording) return recording.error().message;
    const auto frame = recording->load_frame(1);
    EXPECT_FALSE(frame);
    return frame ? std::string() : frame.error().message;
  };
  expect_part(refusal(ray_lengths(47)), "47 numbers, expected 48");
  expect_part(refusal(ray_lengths(49)), "more than the 48 numbers of the image");
  expect_part(refusal(""), "0 numbers, expected 48");
  expect_part(refusal("1\n2\nx " + ray_lengths(45)),
              "scene_00_0001.depth:3: pixel 2: expected the length of a ray, got 'x'");
  for (const char* bad : {"nan", "inf", "-1", "1.5m", "1,2", "0x10", "1e999"})
    expect_part(refusal(std::string(bad) + " " + ray_lengths(47)), fmt::format("got '{}'", bad));
  expect_part(refusal(std::string(48 * 40, ' ')), "at most");
}

TEST(IclPovray, RefusesBadCameraFiles) {
  const PovrayFolder folder;
  const std::string good = camera_text(Matrix3d::Identity(), {1, 2, 3});
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  expect_part(folder.camera_refusal(""), "has no cam_pos");
  expect_part(folder.camera_refusal(with("cam_up ", "cam_xx ")), "has no cam_up");
  expect_part(folder.camera_refusal(good + good), "camera.txt:9: cam_pos is given twice");
  expect_part(folder.camera_refusal(with("[1, 2, 3]", "[1, 2]")),
              "camera.txt:1: expected cam_pos = [x, y, z]");
  expect_part(folder.camera_refusal(with("[1, 2, 3]", "[1, nan, 3]")), "camera.txt:1: expected cam_pos");
  expect_part(folder.camera_refusal(with("[1, 2, 3]';", "[1, 2, 3]'; x")), "camera.txt:1: expected cam_pos");
  Matrix3d mirrored = Matrix3d::Identity();
  mirrored(0, 0) = -1;
  expect_part(folder.camera_refusal(camera_text(mirrored, {1, 2, 3})), "no left-handed orthogonal axes");
  Matrix3d skewed = Matrix3d::Identity();
  skewed(0, 1) = 0.1;
  expect_part(folder.camera_refusal(camera_text(skewed, {1, 2, 3})), "no left-handed orthogonal axes");
  Matrix3d flat = Matrix3d::Identity();
  flat.col(1).setZero();
  expect_part(folder.camera_refusal(camera_text(flat, {1, 2, 3})), "no left-handed orthogonal axes");
}

/// A line of the 2012 desk scene, as published: axes of a hand-held camera to six digits.
TEST(IclPovray, ReadsAPublishedCameraFile) {
  const PovrayFolder folder;
  folder.write(
      "camera.txt",
      "cam_pos      = [149.376, 451.41, -285.9]';\r\ncam_dir      = [0.421738, -0.409407, 0.809026]';\r\n"
      "cam_up       = [-0.0482194, 0.880868, 0.470899]';\r\ncam_lookat   = [0, 0, 1]';\r\n"
      "cam_sky      = [0, 1, 0]';\r\ncam_right    = [1.20423, 0.316017, -0.467833]';\r\n"
      "cam_fpoint   = [0, 0, 10]';\r\ncam_angle    = 90;\r\n");
  const auto camera = read_povray_camera(folder.path() / "camera.txt");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_NEAR(640 * camera->direction.norm() / camera->right.norm(), 481.2, 0.02);
  const SE3 pose = pose_of(*camera, 100);
  EXPECT_TRUE(pose.translation.isApprox(Vector3d(1.49376, -4.5141, -2.859), 1e-12));
  const Matrix3d R = pose.rotation_matrix();
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
  EXPECT_LT((R.col(2) - Vector3d(0.421738, 0.409407, 0.809026)).norm(), 1e-5);
  EXPECT_LT((R.col(1) - Vector3d(0.0482194, 0.880868, -0.470899)).norm(), 1e-5) << "down, with y turned down";
}

TEST(IclPovray, TellsOfAnotherCameraAndAnotherUnit) {
  const PovrayFolder folder;
  ReadOptions options = icl_small_camera();
  options.camera->pinhole = {8, 6, 8 * 481.2 / 640, 6, 3.5, 2.5};
  EXPECT_TRUE(folder.open(options).value().warnings.empty());
  folder.write(PovrayFolder::stem(0) + ".txt", camera_text(Matrix3d::Identity(), {91, 465, -292}));
  EXPECT_NE(folder.open(options).value().warnings.at(0).find(
                "units_per_metre in [depth] of calibration.toml) is 100"),
            std::string::npos);
  folder.write(PovrayFolder::stem(0) + ".txt", camera_text(Matrix3d::Identity(), {0, 0, 0}, 2.0));
  EXPECT_NE(folder.open(options).value().warnings.at(0).find("focal lengths of 4.0 and 6.0 px"),
            std::string::npos);
}

TEST(IclPovray, FramesWithoutPartnerOrCamera) {
  const PovrayFolder folder;
  folder.remove("scene_00_0001.png");
  folder.remove("scene_00_0002.txt");
  folder.write("scene_00_0007.png", "");
  folder.write("scene_00_0000_noisy.png", "");
  const auto recording = folder.open();
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->frames.size(), 2U);
  EXPECT_EQ(recording->frames[1].timestamp_ns, 66'666'667);
  EXPECT_EQ(recording->ground_truth.size(), 2U);
  const auto told = [&](const std::string& warning) {
    return warning.find("1 of 3 colour and 1 of 3 depth images have no partner") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(recording->warnings.begin(), recording->warnings.end(), told), 1);
  folder.remove("scene_00_0000.png");
  folder.remove("scene_00_0002.png");
  expect_part(refusal_message(folder.open(), ErrorCode::data_missing), "no frame has both");
}

TEST(IclPovray, RefusesTwoScenes) {
  const PovrayFolder folder;
  folder.write("scene_01_0000.depth", "");
  expect_part(refusal_message(folder.open(), ErrorCode::data_corrupt), "two .depth files of frame 0");
}

/// The published trajectory, from the cameras that rendered it: row i of the TUM-compatible packing is
/// inv(P_1) P_i, so relative poses of both packings agree.
TEST(IclPovray, AgreesWithTheTumCompatiblePosesOfTheSameFrames) {
  const auto cameras = testing::shared_recording("icl_nuim_trajectories");
  const auto frames = testing::shared_recording("icl_nuim_lr_kt2_frames1-3");
  if (!cameras || !frames) GTEST_SKIP() << "FUSEBENCH_DATA does not hold the ICL-NUIM kt2 excerpt";
  std::map<int, SE3> povray;
  std::ifstream file(*cameras / "povray_camera_kt2.txt");
  for (std::string line; std::getline(file, line) && povray.size() < 5;) {
    if (line.starts_with('#')) continue;
    std::istringstream row(line);
    int index = 0;
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> P;
    row >> index;
    for (int i = 0; i < 12; ++i) row >> P.data()[i];
    const testing::TemporaryFolder folder;
    const auto text = camera_text(P.leftCols<3>(), P.col(3));
    const auto camera = read_povray_camera(folder.write("camera.txt", text));
    ASSERT_TRUE(camera) << camera.error().message;
    povray[index] = pose_of(*camera, 1);
  }
  const auto recording = open_recording(*frames);
  ASSERT_TRUE(recording) << recording.error().message;
  for (int i = 0; i < 3; ++i) {
    const auto& truth = recording->ground_truth;
    const auto at = static_cast<std::size_t>(i);
    const SE3 published = truth[0].T_world_camera.inverse() * truth[at].T_world_camera;
    const SE3 rendered = povray.at(1).inverse() * povray.at(i + 1);
    EXPECT_LT((published.translation - rendered.translation).norm(), 1e-5) << i << ": z has five decimals";
    EXPECT_LT(rotation_angle_rad(published.rotation, rendered.rotation), 5e-6) << i;
  }
}

}  // namespace
}  // namespace fusebench
