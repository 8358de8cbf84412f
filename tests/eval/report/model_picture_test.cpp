#include "eval/report/model_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "eval/report/model_view.hpp"

namespace fusebench {

using namespace report;

namespace {

constexpr Rgb kBackground{227, 232, 236};
constexpr Rgb kPath{0, 0, 255};

/// A red wall of 4 m x 3 m, 3 m ahead of a camera at the origin.
PreciseMesh wall() {
  PreciseMesh mesh;
  for (int row = 0; row <= 30; ++row) {
    for (int column = 0; column <= 40; ++column)
      mesh.vertices.emplace_back(0.1 * column - 2, 0.1 * row - 1.5, 3);
  }
  mesh.colors.assign(mesh.vertices.size(), Rgb{200, 0, 0});
  for (std::uint32_t row = 0; row < 30; ++row) {
    for (std::uint32_t column = 0; column < 40; ++column) {
      const std::uint32_t at = 41 * row + column;
      mesh.triangles.push_back({at, at + 41, at + 1});
      mesh.triangles.push_back({at + 1, at + 41, at + 42});
    }
  }
  return mesh;
}

std::vector<SE3> sidestep() {
  std::vector<SE3> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back({Quaterniond::Identity(), {0.05 * i - 0.5, 0, 0}});
  return poses;
}

/// The edge of a line is blended with what is behind it.
bool is_near(const Rgb& a, const Rgb& b) {
  constexpr int kMostApart = 40;
  return std::abs(a[0] - b[0]) < kMostApart && std::abs(a[1] - b[1]) < kMostApart &&
         std::abs(a[2] - b[2]) < kMostApart;
}

TEST(ModelPicture, FillsItsFrameWithModelAndPath) {
  const ColorImage image = model_picture(wall(), sidestep(), kPath);
  EXPECT_EQ(image.width, 800);
  int left = image.width, right = 0, top = image.height, bottom = 0;
  int red = 0, path = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Rgb& pixel = image(x, y);
      if (pixel == kBackground) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
      red += pixel[0] > 60 && pixel[1] < 10 && pixel[2] < 10 ? 1 : 0;
      path += is_near(pixel, kPath) ? 1 : 0;
    }
  }
  EXPECT_GT(red, 0.15 * image.width * image.height);
  EXPECT_GT(path, 200);
  EXPECT_LT(std::min(left, image.width - 1 - right), 40);
  EXPECT_LT(std::min(top, image.height - 1 - bottom), 40);
  EXPECT_GT(right - left, 0.6 * image.width);
  EXPECT_GT(bottom - top, 0.8 * image.height);
}

TEST(ModelPicture, IsTheSameTwice) {
  EXPECT_EQ(model_picture(wall(), sidestep(), kPath).data, model_picture(wall(), sidestep(), kPath).data);
}

TEST(ModelPicture, IsNotMadeSmallByAPathThatLeavesTheModel) {
  std::vector<SE3> poses = sidestep();
  const ColorImage near = model_picture(wall(), poses, kPath);
  poses.push_back({Quaterniond::Identity(), {1000, 0, 0}});
  const ColorImage image = model_picture(wall(), poses, kPath);
  EXPECT_EQ(image.data, near.data);
}

TEST(CameraAround, HasTheBoxInTheMiddle) {
  const std::vector<Vector3d> points = {{0, 0, 2}, {2, 1, 2}, {9, 9, -1}};
  const Eigen::AlignedBox2d box = seen_box(points, SE3{}, 0);
  EXPECT_TRUE(box.min().isZero());
  EXPECT_TRUE(box.max().isApprox(Vector2d(1, 0.5)));
  const PinholeCamera camera = camera_around(box, 200, 100);
  EXPECT_NEAR(camera.fx_px, 0.94 * 200, 1e-9);
  EXPECT_TRUE(camera.project({1, 0.5, 2}).isApprox(Vector2d(99.5, 49.5), 1e-9));
}

}  // namespace
}  // namespace fusebench
