#include "core/baselines/bundlefusion/keyframe_graph.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/core/baselines/bundlefusion/made_views.hpp"

namespace fusebench {

using namespace baselines::bundlefusion;

namespace {

constexpr double kWall_m = 2.0;
constexpr double kStep_m = 0.5;  // between keyframes, along the wall

/// A wall with marks; keyframes are next to each other, and each shows the marks in front of it.
class Wall {
 public:
  Wall() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 240; ++i) marks_.emplace_back(2.0 + 3.5 * uniform(random), 0.7 * uniform(random));
  }

  /// The view from x_m along the wall.
  [[nodiscard]] View view(double x_m) const {
    const PinholeCamera camera = testing::vga_camera();
    View view{{}, testing::wall_cloud(kWall_m)};
    for (std::size_t i = 0; i < marks_.size(); ++i) {
      const Vector3d point_camera(marks_[i].x() - x_m, marks_[i].y(), kWall_m);
      if (std::abs(point_camera.x()) < 0.8)
        view.keypoints.push_back(testing::made_keypoint(camera, point_camera, i));
    }
    return view;
  }

 private:
  std::vector<Vector2d> marks_;
};

/// Marks that are on no wall: the same ones at a place of the image.
void add_sticker(View& view, double x_m) {
  for (std::size_t i = 0; i < 8; ++i) {
    const Vector3d point_camera(x_m + 0.1 * static_cast<double>(i % 4), i < 4 ? -0.3 : 0.2, kWall_m);
    view.keypoints.push_back(testing::made_keypoint(testing::vga_camera(), point_camera, 1000 + i));
  }
}

bool are_connected(const KeyframeGraph& graph, std::size_t a, std::size_t b) {
  return std::ranges::any_of(graph.pairs(), [&](const FramePair& pair) {
    return std::minmax({pair.a, pair.b}) == std::minmax({a, b});
  });
}

TEST(BundlefusionKeyframeGraph, PlacesKeyframesAndDropsAFalsePair) {
  const Workers workers(2);
  const Wall wall;
  KeyframeGraph graph({}, workers);
  config::BundlefusionConfig tolerant;
  tolerant.max_residual_m = 10;
  KeyframeGraph keeps_all(tolerant, workers);
  for (int k = 0; k < 5; ++k) {
    View view = wall.view(kStep_m * k);
    // The first and the last keyframe show the same stickers, and nothing else that is the same.
    if (k == 0 || k == 4) add_sticker(view, -0.2);
    keeps_all.add(view, std::nullopt);
    graph.add(std::move(view), std::nullopt);
  }
  EXPECT_TRUE(are_connected(keeps_all, 0, 4)) << "the false pair passes the filters of pairs";
  EXPECT_TRUE(are_connected(graph, 0, 1));
  EXPECT_TRUE(are_connected(graph, 3, 4));
  EXPECT_FALSE(are_connected(graph, 0, 4));
  graph.finish();
  for (std::size_t k = 0; k < 5; ++k) {
    ASSERT_TRUE(graph.T_world_keyframe()[k].has_value()) << k;
    const Vector3d truth(kStep_m * static_cast<double>(k), 0, 0);
    EXPECT_LT((graph.T_world_keyframe()[k]->translation - truth).norm(), 1e-6) << k;
  }
}

TEST(BundlefusionKeyframeGraph, RetriesUnmatchedKeyframes) {
  const Workers workers(1);
  const Wall wall;
  KeyframeGraph graph({}, workers);
  const std::size_t first = graph.add(wall.view(0), std::nullopt);
  const std::size_t far = graph.add(wall.view(2.0), SE3{});
  EXPECT_TRUE(graph.T_world_keyframe()[first].has_value());
  EXPECT_FALSE(graph.T_world_keyframe()[far].has_value());
  graph.add(wall.view(1.0), std::nullopt);  // shows some of both
  ASSERT_TRUE(graph.T_world_keyframe()[far].has_value());
  EXPECT_NEAR(graph.T_world_keyframe()[far]->translation.x(), 2.0, 1e-6);
}

}  // namespace
}  // namespace fusebench
